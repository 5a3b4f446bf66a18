"""The pieces of docs/adding-a-screen.md make a screen with its key and its page of HELP."""

import re
from pathlib import Path

from playwright.sync_api import Page, expect

TEXT = (Path(__file__).parents[3] / "docs" / "adding-a-screen.md").read_text(encoding="utf-8")
FILE, ROW = re.findall(r"```js\n(.*?)```", TEXT, re.DOTALL)
ADD = "import('/js/frame/menus.js').then(({ MENUS }) => { MENUS.diagnostics[0] = ROW; })"


def test_the_screen_of_the_page_has_a_key_shows_its_value_and_is_explained(page: Page) -> None:
    page.route("**/js/screens/uptime.js", lambda route: route.fulfill(
        content_type="text/javascript", body=FILE,
    ))  # fmt: skip
    page.evaluate(ADD.replace("ROW", ROW))
    page.keyboard.press("F8")
    page.keyboard.press("F5")
    page.get_by_role("button", name=re.compile("^F1\\s*UPTIME")).click()
    expect(page.locator("#screen h2")).to_have_text("Uptime")
    expect(page.locator("#screen [role=status]")).to_have_text(
        re.compile(r"^The card has been running for \d+:\d\d$")
    )
    page.keyboard.press("Escape")
    page.keyboard.press("F10")
    page.keyboard.press("F9")
    page.locator("#screen .item").filter(has_text="UPTIME").click()
    expect(page.locator(".help-text h2")).to_have_text("UPTIME")
    expect(page.locator(".help-text p")).to_have_text("How long the card has been running.")
    assert page.complaints == []  # type: ignore[attr-defined]
