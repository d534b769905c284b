"""A browser for tests of pages: opened without a network, with what it asked for and complained of."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from typing import Any

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
FLAGS = ["--no-sandbox", "--disable-background-networking"]
PATIENCE = 120_000  # milliseconds: a machine that is busy with other things is no mistake of the page
DESKTOP = {"width": 1280, "height": 900}
PHONE = {"width": 390, "height": 844}


def browser_of() -> Iterator[Any]:
    """Yield a browser, and close it."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=FLAGS, timeout=PATIENCE)
        yield browser
        browser.close()


def opened(browser: Any, url: str, viewport: dict[str, int], scheme: str = "light") -> Iterator[Any]:
    """Yield the page; what it asked for and complained of is kept in `page.heard`."""
    context = browser.new_context(viewport=viewport, offline=True, reduced_motion="reduce", color_scheme=scheme)
    context.set_default_timeout(PATIENCE)
    page = context.new_page()
    page.heard = []
    page.on("console", lambda message: page.heard.append(message.text))
    page.on("pageerror", lambda error: page.heard.append(str(error)))
    page.on("request", lambda asked: page.heard.append(asked.url))
    page.goto(url)
    yield page
    context.close()
