"""Zero, jog keys, MDI, what programs print and ask, editing beside a run."""

import re
from collections.abc import Iterator
from typing import Any

import pytest
from playwright.sync_api import Page, Route, expect
from tests.panel.bench import Served
from tests.panel.browser.conftest import (
    READY,
    begin_run,
    give,
    let_through,
    load_file,
    to_main_menu,
    until,
    until_model,
)

from openacr.sysvar.tabs import AXIS

BOXES = """() => Object.fromEntries([...document.querySelectorAll('#screen .jog-key')].map((key) =>
  [key.ariaLabel, key.getBoundingClientRect().toJSON()]))"""
PLACE = (1.588, -2.12, 60.0)  # the guide's example of CLR ZERO


def at_rest(page: Page, served: Served) -> None:
    until_model(page, "!model.state.value.busy")
    until(page, lambda: not served.call(lambda station: station.link.machine.runner.is_busy))


def reads(page: Page, *wanted: float) -> None:
    """The read-out shows these positions, program coordinates."""
    shown = page.locator("#status .positions .work-value")
    for n, value in enumerate(wanted):
        sign = "\u2212" if value < 0 else "\u2007"
        expect(shown.nth(n)).to_have_text(f"{sign}{abs(value):.3f}")


@pytest.fixture
def placed(page: Page, served: Served) -> Iterator[Page]:
    """The workspace with the machine at a place of G54; nothing runs afterwards."""
    page.click("#status-tab-view1")
    give(page, "zero.clear")
    x, y, z = PLACE
    assert give(page, "mdi.execute", line=f"G21 G90 G54 G0 X{x} Y{y} Z{z}") is not None
    reads(page, *PLACE)
    at_rest(page, served)
    yield page
    give(page, "stop.all")
    at_rest(page, served)
    give(page, "zero.clear")
    to_main_menu(page)


@pytest.mark.req("MILL-MENU-MAIN-SETZERO", "MILL-MENU-MAIN-CLRZERO", "MILL-MENU-RUN-SETZERO")
def test_set_zero_of_both_menus_and_clr_zero(placed: Page, served: Served) -> None:
    """All axes and single ones, by keyboard and by finger; nothing moves."""
    page = placed
    before = served.call(lambda station: station.snapshot.commanded)
    after = {}
    for menu, keys in (("main", ("F3",)), ("run", ("F6", "F8"))):
        to_main_menu(page)
        for key in keys:
            page.keyboard.press(key)
        expect(page.locator("#screen-title")).to_have_text("Set zero")
        page.get_by_role("checkbox", name="Y").check()
        page.locator("#screen").get_by_role("button", name="SET ZERO").click()
        expect(page.locator("#prompt")).to_have_text("Y read 0 now")
        reads(page, PLACE[0], 0.0, PLACE[2])
        every = page.get_by_role("checkbox", name="All axes")
        every.focus()
        page.keyboard.press("Space")
        page.locator("#screen").get_by_role("button", name="SET ZERO").tap()
        expect(page.locator("#prompt")).to_have_text("X Y Z read 0 now")
        reads(page, 0.0, 0.0, 0.0)
        cells = served.panel.installation.store
        after[menu] = [cells.read(n) for n in range(800, 833)]
        to_main_menu(page)
        page.keyboard.press("F2")
        page.keyboard.press("Enter")
        expect(page.locator("#prompt")).to_have_text("The floating zero is cleared")
        reads(page, *PLACE)
    assert after["main"] == after["run"]
    assert served.call(lambda station: station.snapshot.commanded) == before


@pytest.mark.req("MILL-SCR-PRINT", "MILL-SCR-PROMPT", "MILL-MENU-RUN-EDIT")
def test_what_a_program_prints_and_asks_is_in_one_line_and_another_is_edited_meanwhile(
    placed: Page, served: Served
) -> None:
    page = placed
    (served.programs / "ASK.TXT").write_text(
        '(MSG, Clamp the part)\nM0\nINPUT "Depth in mm", P151\nPRINT "depth=";P151\nM0\n'
        "G91 G1 X(P151) F600\nM2\n"
    )
    (served.programs / "OTHER.TXT").write_text("G0 X1\nM2\n")
    line = page.locator("#prompt")
    late: list[Route] = []  # what reading the program found, which arrives after the start
    page.route("**/api/program", lambda route: late.append(route))
    with page.expect_request("**/api/program"):
        load_file(page, "ASK.TXT")
    begin_run(page)
    expect(line).to_have_text("Clamp the part")
    with page.expect_response("**/api/program"):
        until(page, lambda: late)
        late[0].continue_()
    page.unroute_all()
    page.evaluate("() => new Promise(requestAnimationFrame)")
    expect(line).to_have_text("Clamp the part")
    expect(page.locator("#state")).to_contain_text("HOLD")
    page.keyboard.press("F2")
    expect(line).to_contain_text("Depth in mm")
    answer = line.get_by_role("button", name="ANSWER")
    expect(answer).to_be_focused()
    page.keyboard.press("Enter")
    pad = page.get_by_role("dialog", name="Depth in mm")
    page.keyboard.type("deep")
    page.keyboard.press("Enter")
    expect(pad.locator(".refusal")).to_contain_text("Not a number")
    pad.get_by_role("textbox").fill("2*1.5")
    page.keyboard.press("Enter")
    expect(line).to_have_text("depth=3")
    assert served.panel.installation.store.read(151) == 3.0

    page.keyboard.press("F9")
    dialog = page.get_by_role("dialog", name="OPEN")
    name = dialog.get_by_role("textbox", name="File name (.TXT)")
    expect(name).to_have_value("")  # not that of the loaded one
    dialog.get_by_role("option", name="OTHER.TXT").click()
    dialog.get_by_role("button", name="OPEN").click()
    expect(page.locator("#screen-title")).to_have_text("Edit: OTHER.TXT")
    page.locator(".cm-content").click()
    page.keyboard.press("Control+a")
    page.keyboard.type("G0 X4\n")
    page.get_by_role("button", name="SAVE", exact=True).click()
    expect(line).to_have_text("OTHER.TXT is saved")
    assert (served.programs / "OTHER.TXT").read_text() == "G0 X4\n"
    assert served.call(lambda station: station.part.data()["loaded"]["name"]) == "ASK.TXT"
    page.keyboard.press("Escape")
    expect(page.locator("#state")).to_contain_text("HOLD")
    page.keyboard.press("F2")
    reads(page, PLACE[0] + 3.0, PLACE[1], PLACE[2])


def test_a_tool_that_is_asked_for_is_confirmed_by_its_key_or_by_start(
    placed: Page, served: Served
) -> None:
    page = placed
    (served.programs / "TOOLS.TXT").write_text("G21 G91 T1 M6\nG0 X3\nT2 M6\nG0 X-3\nM2\n")
    load_file(page, "TOOLS.TXT")
    begin_run(page)
    changed = page.get_by_role("button", name="TOOL CHANGED")
    expect(page.locator("#prompt")).to_contain_text("load tool 1")
    changed.click()
    reads(page, PLACE[0] + 3.0)
    expect(page.locator("#prompt")).to_contain_text("load tool 2")
    page.keyboard.press("F2")  # START
    reads(page, PLACE[0])
    expect(changed).to_be_hidden()
    at_rest(page, served)


def test_a_start_where_no_line_frees_the_tool_takes_a_safe_z(placed: Page, served: Served) -> None:
    page = placed
    (served.programs / "DEEP.TXT").write_text("G21 G90 G54\nG1 X3 F600\nX7\nM2\n")
    late: list[Route] = []  # what reading the program found, which arrives after the refusal
    page.route("**/api/program", lambda route: late.append(route))
    with page.expect_request("**/api/program"):
        load_file(page, "DEEP.TXT")
    page.keyboard.press("F3")
    dialog = page.get_by_role("dialog", name="RUN")
    line = dialog.get_by_role("textbox", name="Start line")
    level = dialog.get_by_role("textbox", name="Safe Z (machine)")
    expect(level).to_be_hidden()
    line.fill("3")
    page.keyboard.press("Enter")
    refused = "its machine position has to be given (Safe Z"
    expect(page.locator("#prompt")).to_contain_text(refused)
    let_through(page, late[0])
    page.unroute_all()
    expect(page.locator("#prompt")).to_contain_text(refused)
    page.keyboard.press("F3")
    line.fill("3")
    level.fill("high")
    page.keyboard.press("Enter")
    expect(dialog.locator(".refusal")).to_contain_text("Safe Z (machine)")
    level.fill("0")
    page.keyboard.press("Enter")
    page.get_by_role("button", name="MOVE AND START").click()
    reads(page, 7.0)
    at_rest(page, served)


def test_no_enter_meant_for_the_start_line_moves_the_machine(placed: Page, served: Served) -> None:
    page = placed
    (served.programs / "LATER.TXT").write_text("G21 G90 G54\nG0 Z58\nG0 X7\nM2\n")
    load_file(page, "LATER.TXT")
    page.keyboard.press("F3")
    page.get_by_role("dialog", name="RUN").get_by_role("textbox", name="Start line").fill("3")
    page.keyboard.down("Enter")
    question = page.get_by_role("dialog", name="Start at line 3")
    cancel = question.get_by_role("button", name="CANCEL")
    expect(cancel).to_be_focused()
    page.keyboard.down("Enter")  # held: the key repeats
    expect(question).to_be_visible()
    page.keyboard.up("Enter")
    page.keyboard.press("Enter")  # a second press cancels
    expect(question).to_be_hidden()
    assert served.call(lambda station: station.link.machine.runner.is_busy) is False
    reads(page, PLACE[0])
    page.keyboard.press("F3")
    page.get_by_role("textbox", name="Start line").fill("3")
    page.keyboard.press("Enter")
    expect(cancel).to_be_focused()
    page.keyboard.press("Tab")
    page.keyboard.press("Enter")  # MOVE AND START
    reads(page, 7.0)
    at_rest(page, served)


@pytest.mark.req("MILL-MDI-BUFEDIT")
def test_the_buffer_of_mdi_is_edited_run_and_kept(placed: Page, served: Served) -> None:
    page = placed
    page.keyboard.press("F7")
    page.keyboard.press("F1")
    block = page.get_by_role("textbox", name="Block", exact=True)
    expect(block).to_be_focused()
    buffer = page.get_by_role("textbox", name="Executed blocks")

    def kept() -> list[str]:
        return served.call(lambda station: list(station.typed.text))

    first = kept()
    page.keyboard.type("G91 G0 X5")
    page.keyboard.press("Enter")
    reads(page, PLACE[0] + 5.0)
    at_rest(page, served)
    assert kept() == [*first, "G91 G0 X5"]
    expect(buffer).to_have_value("\n".join(kept()))
    buffer.fill("G91 G0 X-3\nG0 Y1")  # a mistake is mended
    page.get_by_role("button", name="KEEP EDIT").click()
    expect(page.get_by_role("button", name="KEEP EDIT")).to_be_hidden()
    assert kept() == ["G91 G0 X-3", "G0 Y1"]
    page.get_by_role("button", name="RUN ALL").click()
    reads(page, PLACE[0] + 2.0, PLACE[1] + 1.0)
    at_rest(page, served)
    assert kept() == ["G91 G0 X-3", "G0 Y1"]  # not twice
    buffer.fill("G91 G0 X-2\nG0 Y1")
    block.fill("G91 G0 Z0")
    page.keyboard.press("Enter")  # keeps what was edited
    until_model(page, "model.mdi.value.buffer.length === 3")
    assert kept() == ["G91 G0 X-2", "G0 Y1", "G91 G0 Z0"]
    expect(buffer).to_have_value("G91 G0 X-2\nG0 Y1\nG91 G0 Z0")


@pytest.mark.req("MILL-MDI-BUFFER")
def test_the_buffer_of_mdi_is_switched_off_and_on(placed: Page, served: Served) -> None:
    page = placed
    page.keyboard.press("F7")
    page.keyboard.press("F1")
    block = page.get_by_role("textbox", name="Block", exact=True)
    switch = page.get_by_role("checkbox", name="BUFFER")
    expect(switch).to_be_checked()
    first = served.call(lambda station: list(station.typed.text))
    switch.uncheck()
    until_model(page, "!model.mdi.value.on")
    block.fill("G91 G0 X5")
    block.press("Enter")
    reads(page, PLACE[0] + 5.0)
    at_rest(page, served)
    assert served.call(lambda station: list(station.typed.text)) == first
    expect(block).to_have_value("")
    block.press("ArrowUp")  # it can be called back, though it is not kept
    expect(block).to_have_value("G91 G0 X5")
    switch.check()
    until_model(page, "model.mdi.value.on")
    block.fill("G91 G0 X-5")
    block.press("Enter")
    reads(page, PLACE[0])
    at_rest(page, served)
    assert served.call(lambda station: list(station.typed.text)) == [*first, "G91 G0 X-5"]


def name_axes(page: Page, served: Served, names: str) -> None:
    """Three or four axes with these names."""
    store = served.panel.installation.store
    with store.transaction():
        for n, name in enumerate(names):
            store.write_text(AXIS.name[n], name)
        store.write(AXIS.configured[3], float(len(names) == 4))
    until_model(page, f"model.axes.map(({{ name }}) => name).join('') === '{names}'")


@pytest.mark.req("MILL-JOG-SCREEN")
def test_every_configured_axis_has_a_plus_and_a_minus_key(page: Page, served: Served) -> None:
    """X and Y as a cross, the others beside it in any order, on a screen of 800 x 600."""
    page.set_viewport_size({"width": 800, "height": 600})
    for names in ("ZYXA", "XYZA", "XYZ"):  # the last is the machine of the other tests
        name_axes(page, served, names)
        to_main_menu(page)
        page.keyboard.press("F7")
        page.keyboard.press("F2")
        keys = page.locator("#screen .jog-key")
        expect(keys).to_have_count(2 * len(names))
        found: dict[str, Any] = page.evaluate(BOXES)  # of one layout
        assert set(found) == {f"{name} {sign}" for name in names for sign in ("plus", "minus")}
        assert len({(round(box["x"]), round(box["y"])) for box in found.values()}) == len(found)
        assert all(box["width"] >= 44 and box["height"] >= 44 for box in found.values())
        assert all(box["x"] + box["width"] <= 800 for box in found.values())
        for name in names:
            plus, minus = found[f"{name} plus"], found[f"{name} minus"]
            along, across = ("x", "y") if name == "X" else ("y", "x")
            assert plus[across] == minus[across]
            assert (plus[along] > minus[along]) is (name == "X")
    page.set_viewport_size({"width": 1024, "height": 768})


def test_the_browser_has_nothing_to_complain_about(page: Page) -> None:
    complaints: list[str] = page.complaints  # type: ignore[attr-defined]
    assert [each for each in complaints if "Applying inline style" not in each] == []


def test_goto_zero_says_where_the_axes_go_and_in_which_order(placed: Page, served: Served) -> None:
    page = placed
    for z, order in ((-5.0, "Z0, then X0 Y0"), (5.0, "X0 Y0, then Z0")):
        give(page, "zero.preset", values={"X": 1.5, "Y": -2.0, "Z": z})
        reads(page, 1.5, -2.0, z)
        to_main_menu(page)
        page.keyboard.press("F7")
        page.keyboard.press("F8")
        dialog = page.get_by_role("dialog", name="Go to zero")
        expect(dialog).to_contain_text(
            f"Rapids to program zero (G54 with the floating zero): {order}. From: X 1.5"
        )
        page.keyboard.press("Escape")
    assert served.call(lambda station: station.link.machine.runner.is_busy) is False


def test_steps_of_a_homing_that_is_over_are_not_shown_after_a_reload_either(
    page: Page, served: Served
) -> None:
    give(page, "home.start", axes="Z")
    until_model(page, "model.state.value.state === 'HOMING'")
    until_model(page, "model.says.value.at(-1)?.homing")
    until_model(page, "model.state.value.state === 'IDLE'")
    expect(page.locator("#prompt")).to_have_text("")
    page.reload()
    page.wait_for_function(READY)
    until_model(page, "model.says.value.at(-1)?.homing")
    expect(page.locator("#prompt")).to_have_text("")
    served.call(lambda station: station.screens.say("printed"))
    expect(page.locator("#prompt")).to_have_text("printed")


@pytest.mark.req("MILL-MDI-TOPROG")
def test_the_mdi_buffer_is_saved_as_a_program_and_run_as_such(page: Page, served: Served) -> None:
    give(page, "mdi.buffer", on=True, lines=[])
    page.keyboard.press("F7")
    page.keyboard.press("F1")
    line = page.get_by_role("textbox", name="Block", exact=True)
    typed = ["G21 G90 G54 G1 X3 Y1 F3000", "G91 Y0.5"]
    for text in typed:
        line.fill(text)
        page.keyboard.press("Enter")
        expect(line).to_have_value("")
        at_rest(page, served)
    page.locator("#screen").get_by_role("button", name="SAVE AS", exact=True).click()
    page.get_by_role("dialog").get_by_role("textbox").fill("TYPED.TXT")
    page.keyboard.press("Enter")
    expect(page.locator("#prompt")).to_have_text("TYPED.TXT is saved")
    assert (served.programs / "TYPED.TXT").read_text() == "\n".join(typed) + "\n"
    give(page, "mdi.execute", line="G90 G54 G0 X0 Y0")
    at_rest(page, served)
    place = lambda station: station.link.machine.runner.stream.host.position()[:2]  # noqa: E731
    zero_x, zero_y = served.call(place)
    load_file(page, "TYPED.TXT")
    begin_run(page)
    at_rest(page, served)
    assert served.call(place) == pytest.approx((zero_x + 3.0, zero_y + 1.5))


def test_the_key_at_the_top_says_that_the_first_key_takes_control_and_it_does(
    page: Page, served: Served
) -> None:
    give(page, "control.release")
    tools = page.locator("#tools .key").first
    expect(tools).to_have_text("\u25cbFree")
    expect(tools).to_have_attribute("title", re.compile("The first key takes control"))
    assert served.call(lambda station: station.people.holder) is None
    assert give(page, "mdi.execute", line="G4 F0.1") is not None
    expect(tools).to_have_text("\u25cfYou operate")
    expect(tools).to_have_attribute("title", "Who operates the machine")
    at_rest(page, served)
