"""The documentation's site in a browser, opened as a file without a network: it asks for nothing, its search finds, and
it fits a phone."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.pages import ROOT

pytest.importorskip("material", reason="the site is built by the dependency group docs")
pytest.importorskip("mkdocstrings", reason="the site is built by the dependency group docs")
playwright = pytest.importorskip("playwright.sync_api", reason="the browser is driven by playwright")

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
PATIENCE = 60_000  # milliseconds: a busy machine is no mistake of the site
PAGES = (
    "index.html",
    "docs/tutorial.html",
    "docs/costs.html",
    "docs/reference/planning.html",
    "docs/reference/problems.html",
    "domains/satellite/index.html",
)

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="there is no Chromium (Debian/Ubuntu: apt install chromium)")


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The site in STATEHTN_SITE where somebody has just built it, else one that is built here."""
    if "STATEHTN_SITE" in os.environ:
        return Path(os.environ["STATEHTN_SITE"])
    folder = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--quiet", "--site-dir", str(folder)]
    subprocess.run(command, cwd=ROOT, check=True, timeout=300)
    return folder


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with playwright.sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"], timeout=PATIENCE)
        yield browser
        browser.close()


@pytest.fixture
def page(browser: Any, request: pytest.FixtureRequest) -> Iterator[Any]:
    """A page without a network; what it asks for from afar and complains of is kept in `page.heard`."""
    context = browser.new_context(viewport={"width": getattr(request, "param", 1280), "height": 800}, offline=True)
    context.set_default_timeout(PATIENCE)
    page = context.new_page()
    page.heard = []
    page.on("console", lambda message: page.heard.append(message.text))
    page.on("pageerror", lambda error: page.heard.append(str(error)))
    page.on("request", lambda asked: asked.url.startswith(("file:", "data:")) or page.heard.append(asked.url))
    # Going to the next page may end the request for an icon of this one.
    page.on("requestfailed", lambda asked: "ERR_ABORTED" in (asked.failure or "") or page.heard.append(asked.url))
    yield page
    context.close()


@pytest.mark.parametrize("page", [390, 1280], indirect=True)
def test_pages_ask_for_nothing_and_fit(page: Any, site: Path) -> None:
    for name in PAGES:
        page.goto((site / name).as_uri())
        assert page.heard == [], name
        inner, whole = page.evaluate("[innerWidth, document.documentElement.scrollWidth]")
        assert whole <= inner, name
        pictures = "[...document.images].filter(image => !image.naturalWidth).map(image => image.src)"
        assert page.evaluate(pictures) == [], name


def test_search_finds(page: Any, site: Path) -> None:
    page.goto((site / "docs" / "tutorial.html").as_uri())
    page.locator("input.md-search__input").click()
    page.keyboard.type("gambler")
    page.locator(".md-search-result__item a").first.wait_for()
    found = page.locator(".md-search-result__item > a").evaluate_all("links => links.map(link => link.pathname)")
    assert any(name.endswith("docs/tutorial.html") for name in found)
    assert all(Path(name).exists() for name in found)
    assert page.heard == []


def test_everything_public_is_in_the_reference(site: Path) -> None:
    import statehtn

    pages = "".join(path.read_text(encoding="utf-8") for path in (site / "docs" / "reference").glob("*.html"))
    missing = [name for name in statehtn.__all__ if name != "__version__" and f'id="statehtn.{name}"' not in pages]
    assert missing == []
