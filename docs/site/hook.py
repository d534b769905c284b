"""Makes the site of files from all over the repository, at the paths that they have there.

So a link such as `../domains/av/README.md` holds on the site as in the repository, and MkDocs checks it.
"""

from __future__ import annotations

from pathlib import Path

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files

PUBLISHED = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "LICENSE", "docs", "domains", "examples")


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Put what is published in the place of what MkDocs has found in `docs_dir`; the theme's files stay."""
    root = Path(config.config_file_path).parent
    site = Files([file for file in files if file.src_dir != config.docs_dir])
    for path in _published(root):
        site.append(File(path.relative_to(root).as_posix(), str(root), config.site_dir, config.use_directory_urls))
    return site


def _published(root: Path) -> list[Path]:
    """Return the files to publish, in the order of their names."""
    found = [path for name in PUBLISHED for path in (root / name, *sorted((root / name).rglob("*")))]
    return [path for path in found if path.is_file() and path.suffix != ".pyc" and path != Path(__file__).resolve()]
