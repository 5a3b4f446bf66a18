"""The display window before, during and after a run: picture, listing, lines and alarms."""

import re
from collections.abc import Iterator
from typing import Any

import pytest
from playwright.sync_api import Page, Route, expect
from tests.panel.bench import Served
from tests.panel.browser.conftest import (
    at_rest,
    begin_run,
    give,
    load_file,
    to_main_menu,
    until_model,
)
from tests.panel.browser.test_files import path_lines

from openacr.sysvar.tabs import CONTROL, IO

SQUARE = "G21 G91 F600\nG1 X20\nY20\nX-20\nY-20\nM2\n"
LEGS = "G21 G91 F900\nG1 X15\nGOSUB 500\nY-2 F900\nM0\nX-15\nM2\n$I SUB.TXT\n"
STOP, DOOR, LAMP = 20, 21, 45  # two inputs and an output
SUB = "; a pocket\nN500 G1 Y6 F180\nRET\n"
TABS = {
    "graphics": "GRAPHICS", "program": "PROGRAM", "io": "I/O STATUS", "plc": "PLC",
    "alarms": "ALARMS",
}  # fmt: skip
DRAWN = """() => {
  const canvas = document.querySelector('#display .picture [data-layer=strokes]');
  const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  let count = 0;
  for (let n = 3; n < data.length; n += 4) if (data[n]) count++;
  return count;
}"""
LINES = "() => import('/js/draw/path.js').then(({ path }) => [...(path.value?.lines ?? [])])"
CHOOSE = "(line) => import('/js/draw/path.js').then((path) => path.chosenLine.set(line))"
# Where the mark of the chosen line ends on the right, in pixels of the window.
MARKED = """() => {
  const canvas = document.querySelector('#display .picture [data-layer=over]');
  const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  let right = -1;
  for (let n = 0; n < data.length / 4; n++) if (data[4 * n + 3] > 250) right = Math.max(right, n % canvas.width);
  return right < 0 ? null : canvas.getBoundingClientRect().x + (right * canvas.clientWidth) / canvas.width;
}"""  # noqa: E501


CURSOR = """() => {
  const box = document.querySelector('#display .tool-cursor').getBoundingClientRect();
  return box.x + box.width / 2;
}"""


def cursor_x(page: Page) -> float:
    return float(page.evaluate(CURSOR))


def tab(page: Page, name: str) -> Any:
    page.get_by_role("tab", name=TABS[name], exact=True).click()
    expect(page.locator(f"#display-tab-{name}")).to_have_attribute("aria-selected", "true")
    return page.locator("#display-panel")


@pytest.fixture
def programs(page: Page, served: Served) -> Iterator[Page]:
    """The workspace with programs in the part folder; nothing runs afterwards."""
    for name, text in (("SQUARE.TXT", SQUARE), ("LEGS.TXT", LEGS), ("SUB.TXT", SUB)):
        (served.programs / name).write_text(text)
    yield page
    give(page, "stop.all")
    until_model(page, "!model.state.value.busy")
    served.panel.installation.store.write(CONTROL.default_graphics, 1)
    page.evaluate(CHOOSE, 0)
    to_main_menu(page)
    tab(page, "graphics")


@pytest.mark.req("MILL-SCR-DISP-GRAPHICS", "MILL-LOAD-GRAPH", "MILL-SYS-CTL-GRAPHICS")
def test_a_part_is_drawn_when_it_is_loaded_unless_default_graphics_is_false(
    programs: Page, served: Served
) -> None:
    page, store = programs, served.panel.installation.store
    assert store.default(CONTROL.default_graphics) == store.read(CONTROL.default_graphics) == 1
    tab(page, "graphics")
    assert len(path_lines(page)) > 20  # of the sample
    tab(page, "alarms")
    held: list[Route] = []
    page.route("**/api/path", lambda route: held.append(route))
    load_file(page, "SQUARE.TXT")  # puts the graphics up
    expect(page.locator("#display-tab-graphics")).to_have_attribute("aria-selected", "true")
    expect(page.locator(".picture-note").first).to_have_text(re.compile(r"^SQUARE\.TXT"))
    assert page.evaluate(LINES) == []  # the path of the program before is gone
    for route in held:
        route.continue_()
    page.unroute("**/api/path")
    assert set(path_lines(page)) == {0, 2, 3, 4, 5}
    page.wait_for_function(f"() => ({DRAWN})() > 100")
    draw = page.get_by_role("button", name="DRAW", exact=True)
    expect(draw).to_be_hidden()

    to_main_menu(page)
    page.keyboard.press("F8")
    page.keyboard.press("F1")
    page.get_by_role("tab", name="Control, page 1", exact=True).click()
    box = page.get_by_role("checkbox", name="Default Graphics")
    expect(box).to_be_checked()
    box.uncheck()
    page.get_by_role("button", name="SAVE", exact=True).click()
    expect(page.locator("#prompt")).to_have_text("Saved: 1")
    assert store.read(CONTROL.default_graphics) == 0
    to_main_menu(page)
    tab(page, "alarms")
    load_file(page, "LEGS.TXT")
    expect(page.locator("#display-tab-alarms")).to_have_attribute("aria-selected", "true")
    tab(page, "graphics")
    expect(page.locator(".picture-note").first).to_have_text(
        "LEGS.TXT \u00b7 not drawn: Default Graphics (P250002) is false"
    )
    page.wait_for_function(f"() => ({DRAWN})() === 0")
    assert page.evaluate(LINES) == []
    draw.click()
    page.wait_for_function(f"() => ({DRAWN})() > 100")
    expect(draw).to_be_hidden()
    tab(page, "alarms")
    tab(page, "graphics")  # stays drawn
    page.wait_for_function(f"() => ({DRAWN})() > 100")


@pytest.mark.req("MILL-SCR-RUN", "MILL-SCR-RUN-CURSOR", "MILL-SCR-DISP-PROGRAM")
@pytest.mark.req("MILL-MENU-RUN-START", "MILL-MENU-RUN-MAIN")
def test_every_tab_is_at_hand_while_a_program_runs_with_its_block_and_the_tool(
    programs: Page, served: Served
) -> None:
    page = programs
    load_file(page, "LEGS.TXT")
    panel = tab(page, "program")
    active = panel.locator(".listing-row.is-active")
    phase = panel.locator(".pane-tools [role=status]")
    expect(panel.locator(".listing-text").nth(1)).to_have_text("G1 X15")
    expect(phase).to_have_text("loaded, not running")
    expect(active).to_have_count(0)
    tab(page, "graphics")
    page.wait_for_function(f"() => ({DRAWN})() > 0")
    begin = cursor_x(page)
    begin_run(page)
    page.wait_for_function(f"(x) => ({CURSOR})() > x + 10", arg=begin)  # the tool follows
    panel = tab(page, "program")
    expect(phase).to_have_text("runs")
    inside = panel.locator(".active-block")  # the block of an included text is named
    expect(inside).to_have_text("\u25b6 SUB.TXT 2  N500 G1 Y6 F180")
    expect(active).to_have_count(0)
    page.keyboard.press("F10")  # the main menu; the program keeps running
    expect(page.locator("#menu")).to_have_attribute("data-shown", "main")
    for name in TABS:
        tab(page, name)
        expect(page.locator("#display-panel > *").first).to_be_attached()
    for n in (1, 2, 3):
        page.click(f"#status-tab-view{n}")
        expect(page.locator(f"#status-tab-view{n}")).to_have_attribute("aria-selected", "true")
        expect(page.locator("#status-panel .block").first).to_be_visible()
    page.click("#status-tab-view1")
    assert served.call(lambda station: station.part.executing.is_under_way)

    tab(page, "program")
    expect(page.locator("#state")).to_contain_text("HOLD")
    expect(active).to_have_attribute("data-line", "4")
    expect(active.locator(".listing-mark")).to_have_text("\u25b6")
    expect(inside).to_be_hidden()
    tab(page, "graphics")
    page.evaluate(CHOOSE, 2)
    end = page.wait_for_function(MARKED).json_value()
    assert abs(cursor_x(page) - end) < 5  # where line 2 has led it
    page.keyboard.press("F6")
    page.keyboard.press("F2")  # START goes on
    expect(page.locator("#state")).to_contain_text("IDLE")
    page.wait_for_function(f"(x) => Math.abs(({CURSOR})() - x) < 3", arg=begin)
    panel = tab(page, "program")
    expect(phase).to_have_text("loaded, not running")
    expect(active).to_have_count(0)
    give(page, "mdi.execute", line="G91 G1 X5 F60")  # no block of the program
    until_model(page, "model.mdi.value.running && model.state.value.state === 'RUN'")
    expect(active).to_have_count(0)
    until_model(page, "model.status.value.line === 0")


def state_of(page: Page, bit: int) -> Any:
    return page.locator(f"#display [data-bit='{bit}'] .io-state")


@pytest.mark.req("MILL-SCR-DISP-IO", "MILL-SCR-DISP-ALARMS", "MILL-SCR-VIEW-ESTOP")
def test_lines_alarms_and_emergency_stop_are_live_at_rest_and_during_a_run(
    programs: Page, served: Served
) -> None:
    page, store = programs, served.panel.installation.store

    def write(bit: int, on: bool) -> None:
        served.call(lambda station: station.link.machine.card.write_bit(bit, on))

    for key in ("F8", "F7", "F9"):
        page.keyboard.press(key)
    page.get_by_role("checkbox", name="Emergency stop, VIEW 3", exact=True).check()
    page.get_by_role("button", name="SAVE VIEW").click()
    expect(page.locator("#prompt")).to_have_text("The views are saved")
    to_main_menu(page)
    page.click("#status-tab-view3")
    view = page.locator("#status-panel .estop")
    expect(view).to_contain_text("Emergency stop: not wired")
    store.write(IO.emergency_stop, STOP)
    expect(view).to_contain_text("Emergency stop is off")
    load_file(page, "LEGS.TXT")
    for is_running in (False, True):
        if is_running:
            begin_run(page)
        tab(page, "io")
        for bit in (DOOR, LAMP):
            for on in (True, False):
                write(bit, on)
                expect(state_of(page, bit)).to_have_text("on" if on else "off")
        assert served.call(lambda station: station.part.executing.is_under_way) is is_running
        panel = tab(page, "alarms")
        active = panel.locator("tr.is-alarm")
        expect(active).to_have_count(0)
        write(STOP, True)
        expect(active).to_have_count(1)
        expect(active.locator("td").nth(1)).to_have_text("\u26a0 10")
        expect(view).to_have_text(re.compile("Emergency stop is on"))
        assert served.call(lambda station: station.part.executing.is_under_way) is False
        write(STOP, False)
        expect(view).to_contain_text("Emergency stop is off again")
        expect(active).to_have_count(1)
        at_rest(page, served)
        panel.get_by_role("button", name="ACKNOWLEDGE").click()
        expect(active).to_have_count(0)
        expect(view).to_have_text(re.compile("Emergency stop is off$"))
    store.write(IO.emergency_stop, -1)
    expect(view).to_contain_text("Emergency stop: not wired")
    page.click("#status-tab-view1")
