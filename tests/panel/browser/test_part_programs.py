"""EDIT and LOAD PROG with .TXT programs and what is wrong with them, OFFSETS with SAVE PAGE."""

from pathlib import Path

import pytest
from playwright.sync_api import Page, Route, expect
from tests.panel.bench import Served
from tests.panel.browser.conftest import (
    at_rest,
    load_file,
    picture,
    to_main_menu,
    until,
    until_model,
)

from openacr.sysvar import Store
from openacr.sysvar.tabs import CELLS, OFFSETS

SQUARE = "F100 G91\nG1X1\nG1Y1\nG1X-1\nG1Y-1\n"


def in_editor(page: Page, name: str) -> None:
    """EDIT a file by its name."""
    page.keyboard.press("F4")
    dialog = page.get_by_role("dialog", name="OPEN")
    dialog.get_by_role("textbox", name="File name (.TXT)").fill(name)
    dialog.get_by_role("button", name="OPEN").click()
    expect(page.locator("#screen-title")).to_have_text(f"Edit: {name}")


def typed(page: Page, text: str) -> None:
    page.locator(".cm-content").click()
    page.keyboard.press("Control+a")
    page.keyboard.insert_text(text)


@pytest.mark.req("MILL-EDIT-OPEN")
def test_edit_opens_a_file_dialog_and_shows_the_chosen_text(page: Page, served: Served) -> None:
    (served.programs / "SQUARE.TXT").write_text(SQUARE)
    page.keyboard.press("F4")
    dialog = page.get_by_role("dialog", name="OPEN")
    dialog.get_by_role("option", name="SQUARE.TXT").click()
    expect(dialog.get_by_role("textbox", name="File name (.TXT)")).to_have_value("SQUARE.TXT")
    dialog.get_by_role("button", name="OPEN").click()
    expect(page.locator("#screen-title")).to_have_text("Edit: SQUARE.TXT")
    expect(page.locator(".cm-line")).to_have_text(SQUARE.split("\n"))


@pytest.mark.req("MILL-EDIT-NEW")
def test_a_name_that_does_not_exist_begins_a_new_program(page: Page, served: Served) -> None:
    in_editor(page, "1111.txt")
    expect(page.locator(".cm-line")).to_have_text([""])
    page.locator(".cm-content").click()
    page.keyboard.type(SQUARE)
    page.get_by_role("button", name="SAVE", exact=True).click()
    expect(page.locator("#prompt")).to_have_text("1111.txt is saved")
    assert (served.programs / "1111.txt").read_text() == SQUARE


def test_a_file_that_is_begun_while_another_is_saved_is_a_new_one(
    page: Page, served: Served
) -> None:
    """What was saved is neither its text nor its version."""
    in_editor(page, "SLOW.TXT")
    typed(page, "G0 X1\n")
    held: list[Route] = []
    page.route("**/programs/file?path=SLOW.TXT*", lambda route: held.append(route))
    with page.expect_request("**/programs/file?path=SLOW.TXT*"):
        page.get_by_role("button", name="SAVE", exact=True).click()
    page.get_by_role("button", name="NEW", exact=True).click()
    page.get_by_role("dialog", name="Not saved").get_by_role("button", name="DROP").click()
    expect(page.locator("#screen-title")).to_have_text("Edit: new file")
    until(page, lambda: held)
    held[0].continue_()
    expect(page.locator("#prompt")).to_have_text("SLOW.TXT is saved")
    assert (served.programs / "SLOW.TXT").read_text() == "G0 X1\n"
    expect(page.locator("#screen-title")).to_have_text("Edit: new file")  # nothing to be saved
    expect(page.get_by_role("button", name="SAVE", exact=True)).to_be_disabled()
    page.unroute_all()


@pytest.mark.req("MILL-LOAD-USER")
def test_a_user_file_is_shown_loaded_and_leads_to_run_prog(page: Page, served: Served) -> None:
    (served.programs / "USER.TXT").write_text(SQUARE)
    page.keyboard.press("F5")
    page.keyboard.press("F3")
    page.get_by_role("radio", name="USER FILE").click()
    page.get_by_role("option", name="USER.TXT").click()
    expect(page.get_by_role("region", name="Text of the file")).to_have_text(SQUARE.rstrip("\n"))
    page.get_by_role("button", name="LOAD FILE").click()
    expect(page.locator("#menu")).to_have_attribute("data-shown", "run")
    expect(page.locator("#alarms .none")).to_have_text("USER.TXT")
    assert served.call(lambda station: station.part.data()["loaded"]["name"]) == "USER.TXT"


@pytest.mark.req("MILL-EDIT-SAVE")
def test_what_was_saved_is_loaded_and_what_was_not_is_dropped_after_a_warning(
    page: Page, served: Served
) -> None:
    (served.programs / "PART.TXT").write_text("G0 X1\nM2\n")
    in_editor(page, "PART.TXT")
    typed(page, "G0 X2\nG0 Y2\nM2\n")
    page.keyboard.press("Escape")
    warning = page.get_by_role("dialog", name="Not saved")
    expect(warning).to_contain_text("PART.TXT has changes that are not saved.")
    warning.get_by_role("button", name="DROP").click()
    assert (served.programs / "PART.TXT").read_text() == "G0 X1\nM2\n"
    to_main_menu(page)
    in_editor(page, "PART.TXT")
    typed(page, "G0 X3\nG0 Y3\nM2\n")
    page.get_by_role("button", name="SAVE", exact=True).click()
    expect(page.locator("#prompt")).to_have_text("PART.TXT is saved")
    load_file(page, "PART.TXT")
    page.click("#display-tab-program")
    rows = page.locator("#display .listing-text")
    expect(rows.nth(0)).to_have_text("G0 X3")
    expect(rows.nth(1)).to_have_text("G0 Y3")
    page.click("#display-tab-graphics")


@pytest.mark.req("MILL-EDIT-RUNLOCK")
@pytest.mark.req("MILL-EDIT-OTHER")
def test_the_running_program_cannot_be_edited_but_others_can(page: Page, served: Served) -> None:
    (served.programs / "LONG.TXT").write_text("G4 P900\nM2\n")
    (served.programs / "OTHER.TXT").write_text("G0 X1\nM2\n")
    load_file(page, "LONG.TXT")
    page.keyboard.press("F3")
    page.get_by_role("dialog").get_by_role("button", name="START").click()
    expect(page.locator("#state")).to_contain_text("WAIT")
    try:
        to_main_menu(page)
        in_editor(page, "LONG.TXT")
        expect(page.locator(".cm-content")).to_have_attribute("aria-readonly", "true")
        expect(page.get_by_role("button", name="SAVE", exact=True)).to_be_disabled()
        expect(page.locator("#screen .hint")).to_contain_text("This program runs")
        answer = page.request.put(
            f"{served.url}/api/programs/file?path=LONG.TXT", data="G0 X9\n",
            headers={"If-Match": "*", "Origin": served.url},
        )  # fmt: skip
        assert answer.status == 409
        to_main_menu(page)
        in_editor(page, "OTHER.TXT")
        typed(page, "G0 X7\nM2\n")
        page.get_by_role("button", name="SAVE", exact=True).click()
        expect(page.locator("#prompt")).to_have_text("OTHER.TXT is saved")
        assert (served.programs / "OTHER.TXT").read_text() == "G0 X7\nM2\n"
    finally:
        served.call(lambda station: station.link.machine.runner.bring_to_rest())
    to_main_menu(page)
    expect(page.locator("#state")).to_contain_text("IDLE")
    in_editor(page, "LONG.TXT")
    typed(page, "G4 P1\nM2\n")
    page.get_by_role("button", name="SAVE", exact=True).click()
    expect(page.locator("#prompt")).to_have_text("LONG.TXT is saved")


# --- offsets --------------------------------------------------------------------------


TABS = {
    "R offsets (geometric)": CELLS.d_radius[2], "R offsets (wear)": CELLS.d_wear[2],
    "H offsets (geometric)": CELLS.h_length[2], "H offsets (wear)": CELLS.h_wear[2],
    "Fixture offsets": OFFSETS.fixtures[1][1],
    "Backlash": OFFSETS.backlash[1],
    "Reference points": CELLS.reference_point_2[0],
}  # fmt: skip


@pytest.mark.req("MILL-OFS-MENU", "MILL-G101-SET")
@pytest.mark.req("MILL-OFS-SAVEPAGE")
def test_every_page_of_offsets_is_on_the_disk_after_save_page_and_unchanged_without(
    page: Page, served: Served
) -> None:
    page.keyboard.press("F8")
    page.keyboard.press("F3")
    save = page.get_by_role("button", name="SAVE PAGE")
    leaving = page.get_by_role("dialog", name="Not saved")
    for name, cell in TABS.items():
        before = on_disk(served, cell)
        tab = page.get_by_role("tab", name=name, exact=True)
        tab.click()
        field = page.locator(f"#cell-{cell}")
        field.fill("0.05")
        tab.click()  # the page is opened anew
        leaving.get_by_role("button", name="DROP").click()
        expect(field).not_to_have_value("0.05")
        assert on_disk(served, cell) == before, name
        field.fill("0.05")
        save.click()
        until(page, lambda cell=cell: on_disk(served, cell) == "0.05")  # type: ignore[misc]
        expect(save).to_be_disabled()
    expect(page.locator("#prompt")).to_have_text("Saved: 1")


def on_disk(served: Served, cell: int) -> str:
    """A cell as another process reads it from the file of the store."""
    with Store(served.store) as disk:
        return f"{disk.read(cell):g}"


def test_save_as_gives_a_name_without_an_ending_that_of_part_programs(
    page: Page, served: Served
) -> None:
    in_editor(page, "FIRST.TXT")
    typed(page, "G0 X1\nM2\n")
    page.get_by_role("button", name="SAVE AS").click()
    dialog = page.get_by_role("dialog", name="SAVE AS")
    dialog.get_by_role("textbox").fill("JOB")
    page.keyboard.press("Enter")
    expect(page.locator("#prompt")).to_have_text("JOB.TXT is saved")
    assert (served.programs / "JOB.TXT").read_text() == "G0 X1\nM2\n"
    page.get_by_role("button", name="SAVE AS").click()
    page.keyboard.press("Escape")
    expect(page.locator("#screen-title")).to_have_text("Edit: JOB.TXT")


# --- what is wrong is said when a program is loaded, with line and column ------------------

OPEN_REMARK = "G21 G90\nG1 X5 F100 (open\nG4 P1\nG83 X1 Q\nM2\n"
NO_CIRCLE = "G21 G90 G17\nG0 X0 Y0\nG2 X10 Y0 I3 J0 F100\nM2\n"
NOTHING_WIRED = "G21 G90\nM8\nG4 P1\nM2\n"
ASKING = '(MSG, Clamp the part)\nM0\nINPUT "Depth in mm", P151\nPRINT "depth=";P151\nM0\n'
SOUND = "G21 G90\nG4 P1\nM2\n"


@pytest.fixture(scope="module")
def faulty(served: Served) -> None:
    """Programs with something to say about them."""
    for name, text in {
        "REMARK.TXT": OPEN_REMARK,
        "ARC.TXT": NO_CIRCLE,
        "COOLANT.TXT": NOTHING_WIRED,
        "ASKING.TXT": ASKING,
        "SOUND.TXT": SOUND,
    }.items():
        (served.programs / name).write_text(text)


def load(page: Page, name: str) -> None:
    """LOAD FILE of a program, until all of it has been read."""
    page.keyboard.press("F5")
    page.keyboard.press("F3")
    page.get_by_role("option", name=name).click()
    page.get_by_role("button", name="LOAD FILE").click()
    until_model(page, f"model.program.value.loaded?.name === '{name}'")
    until_model(page, "model.program.value.loaded.checked")


@pytest.mark.usefixtures("faulty")
def test_a_program_that_cannot_be_read_is_shown_with_its_errors_and_not_offered_to_be_run(
    page: Page, served: Served, pictures: Path
) -> None:
    load(page, "REMARK.TXT")
    dialog = page.get_by_role("dialog")
    expect(dialog.get_by_role("heading")).to_contain_text("REMARK.TXT · 2 errors")
    expect(dialog.locator(".findings .error .number")).to_have_text(["2:12", "4:9"])
    expect(dialog.locator(".findings .error .name").first).to_have_text("E103 comment not closed")
    picture(page, pictures / "findings.png")
    expect(page.locator("#menu")).to_have_attribute("data-shown", "setup")
    page.keyboard.press("Escape")
    expect(page.locator("#screen")).to_be_visible()  # LOAD PROG, for another one
    to_main_menu(page)
    page.keyboard.press("F6")
    why = served.call(lambda station: station.part.bar)
    assert why.startswith("REMARK.TXT cannot be started: REMARK.TXT:2:12: E103 comment not closed")
    assert why.endswith(" and 1 more error")
    for key in ("F2", "F3", "F4"):
        entry = page.locator(f"[data-fkey={key}]")
        expect(entry).to_have_attribute("aria-disabled", "true")
        expect(entry).to_have_attribute("title", why)
        page.keyboard.press(key)
        expect(page.locator("#prompt")).to_have_text(f"⚠ {why}")
        expect(page.get_by_role("dialog")).to_have_count(0)
    page.click("#display-tab-program")
    page.locator("#display .listing-row[data-line='3']").click()
    page.get_by_role("button", name="RUN FROM 3").click()
    expect(page.get_by_role("dialog")).to_have_count(0)
    page.click("#display-tab-graphics")


@pytest.mark.usefixtures("faulty")
def test_a_finding_leads_to_its_line_and_column_in_edit(page: Page) -> None:
    load(page, "REMARK.TXT")
    page.get_by_role("dialog").locator(".findings .item", has_text="4:9").click()
    expect(page.locator("#screen-title")).to_contain_text("REMARK.TXT")
    expect(page.get_by_role("dialog")).to_have_count(0)
    expect(page.locator(".cm-content")).to_be_focused()
    page.keyboard.type("!")
    expect(page.locator(".cm-line").nth(3)).to_have_text("G83 X1 Q!")


@pytest.mark.usefixtures("faulty")
def test_an_error_found_by_reading_is_said_after_the_load_and_asked_about_at_the_start(
    page: Page, served: Served
) -> None:
    load(page, "ARC.TXT")
    expect(page.locator("#prompt")).to_have_text(
        "⚠ ARC.TXT · 1 error · 1 warning: 3:11 E230 arc radii differ too much: 3 and 7"
    )
    expect(page.locator("#menu")).to_have_attribute("data-shown", "run")
    key = page.locator("#alarms").get_by_role("button", name="1 error")
    key.click()
    expect(page.get_by_role("dialog").locator(".findings .number")).to_have_text(["2:1", "3:11"])
    page.keyboard.press("Escape")
    page.keyboard.press("F3")
    dialog = page.get_by_role("dialog", name="RUN")
    expect(dialog.locator(".findings .name")).to_have_text(
        "E230 arc radii differ too much: 3 and 7"
    )
    expect(dialog.get_by_role("button", name="START", exact=True)).to_have_count(0)
    page.keyboard.press("Enter")
    expect(dialog).to_be_visible()
    assert served.call(lambda station: station.link.machine.runner.is_busy) is False
    dialog.get_by_role("button", name="START ANYWAY").click()
    until_model(page, "model.alarms.value.active.length")
    at_rest(page, served)
    page.get_by_role("button", name="ACKNOWLEDGE").click()
    until_model(page, "!model.alarms.value.active.length")


@pytest.mark.usefixtures("faulty")
def test_a_warning_is_said_after_the_load_and_bars_nothing(page: Page) -> None:
    load(page, "COOLANT.TXT")
    expect(page.locator("#prompt")).to_have_text(
        "COOLANT.TXT · 1 warning: 2:1 W405 nothing is wired to the code: M8 (P800010)"
    )
    expect(page.locator("#alarms").get_by_role("button")).to_have_text("1 warning")
    page.keyboard.press("F3")
    dialog = page.get_by_role("dialog", name="RUN")
    expect(dialog.locator(".findings")).to_have_count(0)
    expect(dialog.get_by_role("button", name="START", exact=True)).to_be_visible()


@pytest.mark.usefixtures("faulty")
def test_a_question_of_the_program_is_no_error_where_an_operator_answers_it(page: Page) -> None:
    load(page, "ASKING.TXT")
    expect(page.locator("#prompt")).to_contain_text("ASKING.TXT · 1 warning: 3:1 A61")
    page.keyboard.press("F3")
    dialog = page.get_by_role("dialog", name="RUN")
    expect(dialog.get_by_role("button", name="START", exact=True)).to_be_visible()


@pytest.mark.usefixtures("faulty")
def test_of_a_sound_program_nothing_is_said(page: Page) -> None:
    load(page, "SOUND.TXT")
    expect(page.locator("#prompt")).to_have_text("")
    expect(page.locator("#alarms")).to_have_text("SOUND.TXT")
    for key in ("F2", "F3", "F4"):
        assert page.locator(f"[data-fkey={key}]").get_attribute("aria-disabled") is None


def test_the_browser_has_nothing_to_complain_about(page: Page) -> None:
    complaints: list[str] = page.complaints  # type: ignore[attr-defined]
    # A new name, the running program, and Chromium itself, which would keep the looks of coloured
    # text that is typed over by an inline style: the policy blocks that, and the editor needs none.
    known = ("404", "409", "Applying inline style")
    assert [each for each in complaints if not any(n in each for n in known)] == []
