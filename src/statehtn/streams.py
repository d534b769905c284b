"""Names of files that stand for streams which this process has open already."""

from __future__ import annotations

import os
from pathlib import Path

MOST_LINKS = 40


def own_descriptor(name: str | os.PathLike[str]) -> int | None:
    """Return N where a name stands for descriptor N of this process: `/dev/stdin`, `/dev/fd/N`, or a link to one.

    Use the descriptor itself then: to open such a name anew fails for sockets, and begins a file at its start again,
    or empties it. None for all other names.
    """
    path = Path(name)
    for _ in range(MOST_LINKS):
        try:
            folder = path.parent.resolve()
            if str(folder) in ("/dev/fd", f"/proc/{os.getpid()}/fd") and path.name.isdecimal():
                return int(path.name)
            path = folder / (folder / path.name).readlink()
        except (OSError, RuntimeError, ValueError):  # no link, a cycle of links, or a name that no file can have
            return None
    return None
