"""The log-in page in a browser: a refused password, the wait after several, the panel."""

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, expect
from tests.panel.bench import Served

from openacr.panel.roles import Role


@pytest.fixture
def login(browser: Browser, tmp_path: Path) -> Iterator[tuple[Page, Served]]:
    """The page that `/` of a panel with a password leads to."""
    served = Served(tmp_path)
    served.panel.accounts.set_password(Role.OPERATE, "long enough")
    context = browser.new_context(viewport={"width": 800, "height": 600})
    page = context.new_page()
    page.goto(served.url)
    yield page, served
    context.close()
    served.close()


def attempt(page: Page, password: str) -> None:
    page.get_by_label("Password").fill(password)
    page.get_by_role("button", name="Log in").click()


def test_a_panel_with_a_password_is_entered_by_its_log_in_page(
    login: tuple[Page, Served], pictures: Path
) -> None:
    page, served = login
    assert page.url == f"{served.url}/login"
    alert = page.get_by_role("alert")
    expect(alert).to_be_hidden()
    for _ in range(3):
        attempt(page, "wrong password")
        expect(alert).to_have_text("that is not the password of the role operate")
        expect(page.get_by_label("Password")).to_be_focused()
    page.screenshot(path=str(pictures / "login.png"))
    served.panel.accounts._failed["127.0.0.1"] = (9, float("1e12"))
    attempt(page, "long enough")
    expect(alert).to_have_text(re.compile(r"too many wrong passwords: wait \d+ s"))
    served.panel.accounts._failed.clear()
    attempt(page, "long enough")
    page.wait_for_url(f"{served.url}/")
    page.wait_for_selector("body:not(.is-stale) #menu .menu-key")
