"""The atlas in a browser: it asks for nothing, complains of nothing, follows keyboard and mouse, and fits a phone."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from statehtn.cli import main
from tests.browser import CHROMIUM, DESKTOP, PHONE, browser_of, opened

pytest.importorskip("matplotlib", reason="the atlas draws")
pytest.importorskip("jinja2", reason="the atlas needs it")
pytest.importorskip("playwright.sync_api", reason="the browser is driven by playwright")
pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="there is no Chromium (Debian/Ubuntu: apt install chromium)")

AV = Path(__file__).parents[2] / "domains" / "av"


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    yield from browser_of()


@pytest.fixture(scope="module")
def url(tmp_path_factory: pytest.TempPathFactory) -> str:
    output = tmp_path_factory.mktemp("atlas") / "atlas.html"
    assert main(["atlas", str(AV / "domain.hddl"), str(AV / "p1.hddl"), "--output", str(output)]) == 0
    return output.as_uri()


@pytest.fixture
def page(browser: Any, url: str, request: pytest.FixtureRequest) -> Iterator[Any]:
    yield from opened(browser, url, *getattr(request, "param", (DESKTOP, "light")))


def shown(page: Any) -> str:
    titles: list[str] = page.locator(".card:visible h3").all_inner_texts()
    (title,) = titles
    return title.split(":")[0]


def test_it_asks_for_nothing_and_complains_of_nothing(page: Any, url: str) -> None:
    for kind in ("deadline", "wealth", "alpha"):
        page.locator(f"#{kind}").focus()
        page.keyboard.press("ArrowRight")
    page.wait_for_load_state("networkidle")
    assert page.heard == [url]


def test_the_keyboard_moves_from_plan_to_plan(page: Any) -> None:
    assert shown(page) == "Plan B"
    page.locator("#alpha").focus()
    page.keyboard.press("Home")
    assert shown(page) == "Plan A"
    assert "certainty equivalent 5.5" in page.locator("#alpha-said").inner_text()
    page.keyboard.press("End")
    assert shown(page) == "Plan D"
    left, right = page.locator(".marker").get_attribute("x1"), page.evaluate("data.frame[1]")
    assert float(left) == pytest.approx(right)
    page.locator("#deadline").focus()
    page.keyboard.press("End")
    assert "value 0" in page.locator("#deadline-said").inner_text()


def test_the_mouse_moves_the_slider(page: Any) -> None:
    page.locator("#alpha").scroll_into_view_if_needed()
    box = page.locator("#alpha").bounding_box()
    page.mouse.click(box["x"] + 0.97 * box["width"], box["y"] + box["height"] / 2)
    assert shown(page) == "Plan D"
    page.locator("a[data-show]").first.click()
    assert shown(page) == "Plan A"


@pytest.mark.parametrize("page", [(PHONE, "dark"), (DESKTOP, "dark"), (PHONE, "light")], indirect=True)
def test_it_fits_the_screen_in_the_dark_too(page: Any) -> None:
    assert page.evaluate("document.documentElement.scrollWidth <= window.innerWidth")
    dark = page.evaluate("getComputedStyle(document.body).backgroundColor")
    assert dark in ("rgb(21, 24, 27)", "rgb(253, 253, 251)")
    drawn = "[...document.querySelectorAll('.card:not([hidden]) svg')].every(svg => svg.getBBox().width > 100)"
    assert page.evaluate(drawn)
