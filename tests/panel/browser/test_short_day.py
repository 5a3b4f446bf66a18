"""A short day at the machine by mouse alone, and by touch alone: home, zero, run, hold, jog."""

from collections.abc import Callable

import pytest
from playwright.sync_api import BrowserContext, CDPSession, Locator, Page, expect
from tests.panel.bench import Served
from tests.panel.browser.conftest import open_page, until_model

PROGRAM = "G21 G90 G54\nG0 Z-1\nG1 X40 F120\nG0 X0\nM2\n"


class Pointer:
    """What an operator has in hand: a mouse."""

    def __init__(self, page: Page) -> None:
        self.page = page

    def down(self, place: Locator) -> None:
        place.hover()
        self.page.mouse.down()

    def up(self) -> None:
        self.page.mouse.up()

    def press(self, place: Locator) -> None:
        """Press what can be pressed."""
        expect(place).to_be_enabled()
        self.down(place)
        self.up()


class Finger(Pointer):
    """One finger on the glass."""

    def __init__(self, page: Page) -> None:
        super().__init__(page)
        self._glass: CDPSession = page.context.new_cdp_session(page)

    def down(self, place: Locator) -> None:
        box = place.bounding_box()
        assert box is not None
        point = {"x": box["x"] + box["width"] / 2, "y": box["y"] + box["height"] / 2}
        self._touch("touchStart", [point])

    def up(self) -> None:
        self._touch("touchEnd", [])

    def _touch(self, kind: str, points: list[dict[str, float]]) -> None:
        self._glass.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})


@pytest.mark.req("MILL-RUN-STOP")
@pytest.mark.parametrize("kind", [Pointer, Finger])
def test_a_short_day_needs_no_keyboard(
    panel: Served, context: BrowserContext, kind: Callable[[Page], Pointer]
) -> None:
    page = open_page(context, panel.url)  # of a machine that is not homed
    (panel.programs / "DAY.TXT").write_text(PROGRAM)
    hand = kind(page)
    menu, screen = page.locator("#menu"), page.locator("#screen")

    def key(name: str, shown: str = "") -> None:
        hand.press(menu.get_by_role("button", name=name))
        if shown:
            expect(menu).to_have_attribute("data-shown", shown)

    key("HOME")
    with panel.swift():
        hand.press(screen.get_by_role("button", name="START HOME"))
        until_model(page, "['X', 'Y', 'Z'].every((each) => model.state.value.homed.includes(each))")
        until_model(page, "!model.state.value.busy")
    key("SET ZERO")
    expect(page.locator("#screen-title")).to_have_text("Set zero")  # HOME has these boxes, too
    hand.press(screen.get_by_role("checkbox", name="All axes"))
    hand.press(screen.get_by_role("button", name="SET ZERO"))
    expect(page.locator("#prompt")).to_have_text("X Y Z read 0 now")
    key("RUN SETUP", "setup")
    key("LOAD PROG")
    hand.press(screen.get_by_role("option", name="DAY.TXT"))
    hand.press(screen.get_by_role("button", name="LOAD FILE"))
    expect(menu).to_have_attribute("data-shown", "run")
    expect(screen).to_be_hidden()
    menu_start = menu.locator("[data-fkey=F2]")
    hand.press(menu_start)
    hand.press(page.get_by_role("dialog", name="RUN").get_by_role("button", name="START"))
    until_model(page, "model.status.value.work[0] > 1")
    hand.press(page.locator("#stop").get_by_role("button"))
    expect(menu).to_have_attribute("data-shown", "stop")
    until_model(page, "model.state.value.state === 'PAUSED'")
    expect(page.locator("#state")).to_contain_text("----PAUSE----")
    key("RESUME")
    until_model(page, "model.state.value.running")
    hand.press(page.locator("#stop").get_by_role("button"))
    until_model(page, "model.state.value.state === 'PAUSED'")
    key("ABORT", "run")
    until_model(page, "!model.state.value.busy")
    key("MAIN MENU", "main")
    key("MANUAL", "manual")
    key("JOG")
    before = panel.call(lambda station: station.snapshot.commanded[0])
    plus = screen.get_by_role("button", name="X plus")
    expect(plus).to_be_enabled()
    hand.down(plus)
    until_model(page, "model.state.value.jogging")
    hand.up()
    until_model(page, "!model.state.value.jogging")
    until_model(page, "!model.state.value.busy")
    assert panel.call(lambda station: station.snapshot.commanded[0]) > before
    hand.press(screen.get_by_role("button", name="CLOSE"))
    key("MAIN MENU", "main")
    expect(screen).to_be_hidden()
    page.close()
