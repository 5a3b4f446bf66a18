"""The picture of the panel in the documentation: `python -m tests.panel.browser.picture`.

A virtual mill is homed and cuts the sample part for some seconds; the screen is kept as
docs/images/panel.png.
"""

import argparse
import sys
import tempfile
from pathlib import Path

from playwright.sync_api import Page, sync_playwright
from tests.panel.bench import Served
from tests.panel.browser.chromium import MISSING, OPTIONS, found
from tests.panel.browser.conftest import open_page

PLACE = Path(__file__).parents[3] / "docs" / "images" / "panel.png"
CUTS_MS = 45_000
LIMIT_MS = 90_000


def cuts(page: Page) -> None:
    """Home the machine and start the loaded program."""
    page.keyboard.press("F1")
    page.get_by_role("button", name="START HOME").click()
    chip = page.locator("#state[data-state=HOMING]")
    chip.wait_for()
    chip.wait_for(state="detached", timeout=LIMIT_MS)
    page.keyboard.press("Escape")
    page.keyboard.press("F6")
    page.keyboard.press("F3")
    page.get_by_role("dialog").get_by_role("button", name="START").click()
    page.get_by_role("button", name="TOOL CHANGED").click(timeout=LIMIT_MS)


def main() -> int:
    """Make the picture; 1 without a browser."""
    argparse.ArgumentParser(
        prog="python -m tests.panel.browser.picture", description=__doc__
    ).parse_args()
    path = found()
    if path is None:
        print(MISSING, file=sys.stderr)
        return 1
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        panel = Served(Path(folder))
        browser = playwright.chromium.launch(executable_path=path, args=OPTIONS)
        context = browser.new_context(viewport={"width": 1024, "height": 768}, color_scheme="light")
        page = open_page(context, panel.url)
        cuts(page)
        page.wait_for_timeout(CUTS_MS)
        page.screenshot(path=PLACE)
        browser.close()
        panel.close()
    print(PLACE)
    return 0


if __name__ == "__main__":
    sys.exit(main())
