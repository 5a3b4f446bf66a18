"""EDIT and LOAD PROG with .TXT programs, OFFSETS with SAVE PAGE."""

import pytest
from playwright.sync_api import Page, Route, expect
from tests.panel.bench import Served
from tests.panel.browser.conftest import load_file, to_main_menu, until

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
        served.call(lambda station: station.machine.runner.bring_to_rest())
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
    "Backlash": OFFSETS.backlash[1],
    "Reference points": CELLS.reference_point_2[0],
}  # fmt: skip


@pytest.mark.req("MILL-OFS-MENU")
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


def test_the_browser_has_nothing_to_complain_about(page: Page) -> None:
    complaints: list[str] = page.complaints  # type: ignore[attr-defined]
    # A new name, the running program, and Chromium itself, which would keep the looks of coloured
    # text that is typed over by an inline style: the policy blocks that, and the editor needs none.
    known = ("404", "409", "Applying inline style")
    assert [each for each in complaints if not any(n in each for n in known)] == []


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
