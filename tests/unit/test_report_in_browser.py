"""The report in a browser: it asks for nothing, complains of nothing, sorts its tables, and fits a phone."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from statehtn.cli import main
from statehtn.experiments.report.svg import COLOURS
from tests.browser import CHROMIUM, DESKTOP, PHONE, browser_of, opened
from tests.regression.paper_tables import problem
from tests.results import invented, planned, write

pytest.importorskip("matplotlib", reason="the report draws")
pytest.importorskip("jinja2", reason="the report needs it")
pytest.importorskip("playwright.sync_api", reason="the browser is driven by playwright")

LONG_NAME = "a-domain/with-a-name-as-long-as-those-of-the-competition-and-no-place-to-break-it-2020-total-order"

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="there is no Chromium (Debian/Ubuntu: apt install chromium)")


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    yield from browser_of()


@pytest.fixture(scope="module")
def url(tmp_path_factory: pytest.TempPathFactory) -> str:
    """A report with every section, long names, and tables wider than a phone."""
    folder = tmp_path_factory.mktemp("browser")
    p1 = problem("av", "p1")
    agents = ["averse 0.9", "neutral", "seeking 0.9"]
    records = [planned(p1, "av", "p1", agent, solver=solver) for agent in agents for solver in ("state", "plan")]
    for index, seconds in enumerate((0.5, 10.25, 2.0)):
        records.append(invented(LONG_NAME, f"p{index + 8}", seconds=seconds, expanded=3000 * (2 - index)))
    records.append(invented(LONG_NAME, "p11", status="time-limit", laws=None))
    output = folder / "report.html"
    assert main(["report", str(write(folder / "results.csv", records)), "--output", str(output)]) == 0
    return output.as_uri()


@pytest.fixture
def page(browser: Any, url: str, request: pytest.FixtureRequest) -> Iterator[Any]:
    """The report, opened without a network; what it asked for and complained of is kept in `page.heard`."""
    yield from opened(browser, url, getattr(request, "param", DESKTOP))


def column(page: Any, number: int) -> list[str]:
    return page.locator(f"#all tbody tr > :nth-child({number})").all_inner_texts()


def test_it_asks_for_nothing_and_complains_of_nothing(page: Any, url: str) -> None:
    page.locator("summary").click()
    page.locator("#all thead button").first.click()
    page.wait_for_load_state("networkidle")
    assert page.heard == [url]
    assert page.locator("svg.plot").count() == 7
    shown = page.evaluate("[...document.querySelectorAll('svg.plot')].every(svg => svg.getBBox().width > 100)")
    assert shown


def test_headings_sort(page: Any) -> None:
    page.locator("summary").click()
    headings = page.locator("#all thead th").all_inner_texts()
    number = headings.index("seconds") + 1
    heading = page.locator(f"#all thead th:nth-child({number})")
    heading.get_by_role("button").click()
    assert heading.get_attribute("aria-sort") == "ascending"
    seconds = [float(value) for value in column(page, number)]
    assert seconds == sorted(seconds)
    assert seconds[-1] == 10.2  # by value: as text it would come before 2.0
    heading.get_by_role("button").click()
    assert heading.get_attribute("aria-sort") == "descending"
    assert [float(value) for value in column(page, number)] == sorted(seconds, reverse=True)


def test_numbers_are_read_as_they_are_typeset_and_what_is_missing_is_last(page: Any) -> None:
    page.locator("summary").click()
    headings = page.locator("#all thead th").all_inner_texts()
    for name, least in (("expanded", "0"), ("value", "3.4")):
        number = headings.index(name) + 1
        button = page.locator(f"#all thead th:nth-child({number}) button")
        button.click()
        assert column(page, number)[0] == least
        button.click()
        values = column(page, number)
    assert values[-1] == "\N{EN DASH}"
    assert values[0] == "19.4"
    utilities = "#paper tbody tr > :nth-child(3)"
    page.locator("#paper thead tr:last-child th:nth-child(3) button").click()
    found = page.locator(utilities).all_inner_texts()
    assert [value.replace("\N{MINUS SIGN}", "-") for value in found] == ["-42514702.52", "-18.35", "0.117905e-3"]


def test_the_keyboard_sorts_and_scrolls(page: Any) -> None:
    page.locator("#coverage .scroll").first.focus()
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.tagName") == "BUTTON"
    page.keyboard.press("Enter")
    assert page.locator("#coverage th[aria-sort=ascending]").count() == 1
    page.keyboard.press("Space")
    assert page.locator("#coverage th[aria-sort=descending]").count() == 1


@pytest.mark.parametrize("page", [PHONE, {"width": 320, "height": 640}, DESKTOP], indirect=True)
def test_the_page_never_scrolls_sideways(page: Any) -> None:
    page.locator("summary").click()
    inner, whole = page.evaluate("[innerWidth, document.documentElement.scrollWidth]")
    assert whole <= inner
    boxes = page.evaluate(
        "[...document.querySelectorAll('.scroll')].map(box => [box.clientWidth, box.scrollWidth, innerWidth])"
    )
    assert all(box <= viewport for box, _, viewport in boxes)
    if inner < 500:
        assert any(content > box for box, content, _ in boxes)  # wide tables scroll inside their boxes


def test_both_colour_schemes_can_be_read(browser: Any, url: str) -> None:
    for scheme in ("light", "dark"):
        context = browser.new_context(color_scheme=scheme)
        page = context.new_page()
        page.goto(url)
        for selector in ("p", "dt", "td", "svg.plot text", "thead th"):
            colours = page.evaluate(COLOURS_OF, selector)
            assert contrast(*colours) >= 4.5, (scheme, selector, colours)
        for name in COLOURS:  # of the page's palette: lines are easier to see than text
            if name != "grid":
                colours = page.evaluate(COLOUR_OF, f"var(--{name})")
                assert contrast(*colours) >= 3, (scheme, name, colours)
        context.close()


COLOURS_OF = """selector => {
  const element = document.querySelector(selector);
  const style = getComputedStyle(element);
  const ink = element.closest("svg") ? style.fill : style.color;
  return [ink, getComputedStyle(document.body).backgroundColor];
}"""


COLOUR_OF = """value => {
  const element = document.body.appendChild(document.createElement("i"));
  element.style.color = value;
  return [getComputedStyle(element).color, getComputedStyle(document.body).backgroundColor];
}"""


def contrast(*colours: str) -> float:
    """Return the contrast of two colours, from 1 to 21 (WCAG 2)."""
    dark, light = sorted(map(luminance, colours))
    return (light + 0.05) / (dark + 0.05)


def luminance(colour: str) -> float:
    channels = [int(value) / 255 for value in colour.removeprefix("rgb(").removesuffix(")").split(",")]
    linear = [value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4 for value in channels]
    return sum(weight * value for weight, value in zip((0.2126, 0.7152, 0.0722), linear, strict=True))
