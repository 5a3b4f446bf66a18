"""The STOP key and what follows it: what was held, what still moves, the lamp of the card."""

from collections.abc import Iterator

import pytest
from playwright.sync_api import Page, expect
from tests.panel.bench import Served

from openacr.client import Card, Level

LOOP = ("PROGRAM", "_again", "X2", "X0", "GOTO again", "ENDP")


def typed(served: Served, level: Level, *lines: str) -> None:
    """Type lines as another host does."""

    def type_lines(station: object) -> None:
        controller = served.panel.installation.controller
        assert controller is not None
        card = Card.open(controller)
        card.go(level)
        for line in lines:
            card.command(line)
        card.close()

    served.call(type_lines)


@pytest.fixture
def moved(page: Page, served: Served) -> Iterator[Page]:
    """A page while another host runs a program that moves X."""
    typed(served, Level.program(0), "ACC 20 DEC 20 STP 20 VEL 0.5", *LOOP, "RUN")
    yield page
    typed(served, Level.program(0), "HALT", "NEW")


def test_stop_holds_what_another_host_moves_and_resume_goes_on(moved: Page) -> None:
    lamp, prompt = moved.locator("#state"), moved.locator("#prompt")
    expect(lamp).to_contain_text("CARD MOVES")
    expect(lamp).to_contain_text("X PROG0")
    moved.locator("#stop button").click()
    expect(prompt).to_contain_text("STOP holds PROG0 paused, MASTER0 held")
    expect(lamp).to_contain_text("CARD RUNS")
    prompt.get_by_role("button", name="RESUME").click()
    expect(prompt).not_to_contain_text("STOP holds")
    expect(lamp).to_contain_text("CARD MOVES")
    moved.keyboard.press("Pause")
    expect(prompt).to_contain_text("STOP holds PROG0 paused, MASTER0 held")


def test_what_moves_in_spite_of_stop_is_red_with_the_next_stronger_stop(
    page: Page, served: Served
) -> None:
    typed(served, Level.program(0), "JOG VEL Y0.5", "JOG ACC Y20", "JOG DEC Y20")
    typed(served, Level(), "DIM PLC0(2000)")
    typed(served, Level.plc(0), "10 LDN 128", "20 OUT 828", "RUN")
    prompt = page.locator("#prompt")
    expect(page.locator("#state")).to_contain_text("CARD MOVES")
    page.locator("#stop button").click()
    expect(prompt).to_contain_text("In spite of STOP moves: Y")
    expect(prompt).to_have_attribute("data-kind", "error")
    prompt.get_by_role("button", name="END EVERYTHING").click()
    key = prompt.get_by_role("button", name="KILL, DRIVES OFF")
    expect(key).to_be_visible()
    key.click()
    expect(prompt).not_to_contain_text("In spite of STOP")
    typed(served, Level.plc(0), "HALT")
