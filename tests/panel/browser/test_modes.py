"""What the top of every page says of a machine that is not simply operated, and its key."""

import os
from pathlib import Path

from playwright.sync_api import Page, expect
from tests.panel.bench import Served

LACKS = "PROG0 is an ordinary program of the card now"


def pictured(page: Page, name: str) -> None:
    """Keep a picture where one is asked for."""
    if folder := os.environ.get("OPENACR_PICTURES"):
        page.screenshot(path=Path(folder) / f"{name}.png")


def test_what_acromill_misses_is_at_the_top_with_the_key_that_sets_it_up(
    page: Page, served: Served
) -> None:
    top = page.locator("#alarms")
    served.call(lambda station: station.hand_over(LACKS))
    expect(top).to_contain_text(LACKS)
    pictured(page, "lacks")
    top.get_by_role("button", name="SET UP").click()
    dialog = page.get_by_role("dialog")
    expect(dialog).to_contain_text("what was attached and set there is lost")
    dialog.get_by_role("button", name="SET UP").click()
    expect(top).not_to_contain_text(LACKS)
    expect(page.locator("#prompt")).to_contain_text("AcroMill has set the card up")


def test_a_moment_of_the_past_is_said_at_the_top_without_an_alarm(
    page: Page, served: Served
) -> None:
    top = page.locator("#alarms")
    tick = served.call(lambda station: station.times.history.lived_tk)
    served.call(lambda station: station.times.seek(tick // 2))
    expect(top).to_contain_text("s BEFORE THE END")
    expect(top.get_by_role("button")).to_have_count(0)
    pictured(page, "past")
    served.call(lambda station: station.times.operate(station.now_s))
    expect(top).not_to_contain_text("BEFORE THE END")
    expect(top).not_to_contain_text("Watchdog")
