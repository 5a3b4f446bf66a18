"""The log-in page in a browser: a refused password, the wait after several, the panel."""

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, expect
from tests.panel.bench import Served
from tests.panel.browser.conftest import LONGEST_MS, READY, give, picture

from openacr.panel.roles import Role
from openacr.sysvar import password


@pytest.fixture(scope="module")
def page(browser: Browser, served: Served) -> Iterator[Page]:
    """The page that `/` of a panel with passwords leads to."""
    served.panel.accounts.set_password(Role.OPERATE, "long enough")
    password.change(served.panel.installation.store, "deep secret")
    context = browser.new_context(viewport={"width": 800, "height": 600})
    page = context.new_page()
    page.set_default_timeout(LONGEST_MS)
    page.goto(served.url)
    yield page
    context.close()


def attempt(page: Page, password: str) -> None:
    page.get_by_label("Password").fill(password)
    page.get_by_role("button", name="Log in").click()


def test_a_panel_with_a_password_is_entered_by_its_log_in_page(
    page: Page, served: Served, pictures: Path
) -> None:
    assert page.url == f"{served.url}/login"
    alert = page.get_by_role("alert")
    expect(alert).to_be_hidden()
    for _ in range(3):
        attempt(page, "wrong password")
        expect(alert).to_have_text("that is not the password of the role operate")
        expect(page.get_by_label("Password")).to_be_focused()
    picture(page, pictures / "login.png")
    served.panel.accounts.delays._failed["127.0.0.1"] = (9, float("1e12"))
    attempt(page, "long enough")
    expect(alert).to_have_text(re.compile(r"too many wrong passwords: wait \d+ s"))
    served.panel.accounts.delays._failed.clear()
    attempt(page, "long enough")
    page.wait_for_url(f"{served.url}/")
    page.wait_for_function(READY)


GUARDED = {
    "diagnostics": {2: "terminal", 4: "gain", 5: "board", 9: "memory"}, "diag": {1: "parameters"}
}  # fmt: skip
COMMANDS: list[tuple[str, dict[str, object]]] = [
    ("term.open", {}), ("term.line", {"text": "?P3"}), ("card.write", {"parameter": 0, "value": 1}),
    ("gain.set", {"axis": "X", "gain": "P Gain", "value": 0.001}),
]  # fmt: skip
SHOW = "(name) => import('/js/frame/menu_bar.js').then(({ openMenu }) => openMenu(name))"


@pytest.mark.req("MILL-DIAG-TERM-LOCK")
def test_screens_of_the_service_ask_for_its_password(page: Page, served: Served) -> None:
    """Of an operator who is logged in."""
    store = served.panel.installation.store
    before = store.read(150_000)
    dialog = page.get_by_role("dialog", name="Log in")
    for menu, keys in GUARDED.items():
        page.evaluate(SHOW, menu)
        for key in keys:
            page.keyboard.press(f"F{key}")
            expect(dialog.get_by_label("Role")).to_have_value("service")
            page.keyboard.press("Escape")
            expect(dialog).to_have_count(0)
            expect(page.locator("#screen")).to_be_hidden()
    for command, args in COMMANDS:
        assert give(page, command, **args) is None
        expect(page.locator("#prompt")).to_have_text("⚠ this needs the role service")
    answer = page.request.put(
        f"{served.url}/api/forms/SERVO", data={"values": {"150000": "1"}},
        headers={"Origin": served.url},
    )  # fmt: skip
    assert (answer.status, store.read(150_000)) == (403, before)
    page.evaluate(SHOW, "diagnostics")
    page.keyboard.press("F2")
    dialog.get_by_label("Password").fill("guessed")
    page.keyboard.press("Enter")
    expect(dialog.locator(".refusal")).to_have_text("that is not the password of the role service")
    dialog.get_by_label("Password").fill("deep secret")
    page.keyboard.press("Enter")
    page.wait_for_selector("#screen[data-screen=terminal]:not([hidden]) .xterm")
    for menu, keys in GUARDED.items():
        for key, screen in keys.items():
            page.keyboard.press("Escape")
            expect(page.locator("#screen")).to_be_hidden()
            page.evaluate(SHOW, menu)
            page.keyboard.press(f"F{key}")
            page.wait_for_selector(f"#screen[data-screen={screen}]:not([hidden])")
