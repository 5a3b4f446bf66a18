"""SYS PARAM and OFFSETS, BALLSCREW as a technician uses them."""

import re
from pathlib import Path

import pytest
from playwright.sync_api import Page, expect
from tests.panel.bench import Served
from tests.panel.browser.conftest import until

from openacr.sysvar.tabs import CONTROL, GENERAL, IO, OFFSETS

TABS = {
    "SERVO": "Servo", "AXES": "Axes", "CONTROL": "Control, page 1", "CONTROL2": "Control, page 2",
    "POLARITY": "Control, page 3: polarity", "HOME": "Home", "JOG": "Jog", "IO": "I/O",
    "FOV": "Feed override", "ROV": "Rapid override", "SOV": "Spindle override", "PROBE": "Probe",
    "SPEEDS": "Speeds", "COMPATIBILITY": "Compatibility", "COMMUNICATIONS": "Communications",
    "SPINDLE": "Spindle", "DISPLAY": "Display", "TOOL": "Tool",
}  # fmt: skip
# One field of each page: its cell and what is entered.
ENTERED: dict[str, tuple[int, str | bool]] = {
    "SERVO": (150_003, "2"), "AXES": (200_003, "0.03"), "CONTROL": (250_007, "250"),
    "CONTROL2": (250_117, "41"), "POLARITY": (251_003, True), "HOME": (300_003, "901"),
    "JOG": (350_006, "0.02"), "IO": (400_012, "9"), "FOV": (450_000, "1"), "ROV": (500_000, "1"),
    "SOV": (550_000, "49"), "PROBE": (600_005, "4"), "SPEEDS": (650_002, "401"),
    "COMPATIBILITY": (700_000, True), "COMMUNICATIONS": (750_001, "19200"),
    "SPINDLE": (800_001, "301"), "DISPLAY": (850_021, True), "TOOL": (900_003, "31"),
}  # fmt: skip
BITS = "(rows) => rows.map((row) => Number(row.dataset.bit))"
DROPPED = (
    "SERVO",
    "POLARITY",
    "COMMUNICATIONS",
)  # a number, a box, a choice


def enter(page: Page, cell: int, value: str | bool) -> None:
    field = page.locator(f"#cell-{cell}")
    if isinstance(value, bool):
        field.set_checked(value)
    elif field.evaluate("(each) => each.tagName") == "SELECT":
        field.select_option(value)
    else:
        field.fill(value)


@pytest.mark.req("MILL-MENU-SYSPARAM", "MILL-SYS-SAVE", "MILL-SYS-CLOSE")
def test_every_page_of_sys_param_keeps_changes_by_save_alone_and_close_leaves(
    page: Page, served: Served
) -> None:
    store = served.panel.installation.store
    page.keyboard.press("F8")
    page.keyboard.press("F1")
    shown = page.locator("#screen .form-tabs [role=tab]")
    expect(shown.first).to_have_text("Servo")
    for place, title in enumerate(TABS.values()):
        expect(shown.nth(place)).to_have_text(title)
    before = {cell: float(store.read(cell)) for cell, _ in ENTERED.values()}
    leaving = page.get_by_role("dialog", name="Not saved")
    save = page.get_by_role("button", name="SAVE", exact=True)
    for name, title in TABS.items():
        cell, value = ENTERED[name]
        tab = page.get_by_role("tab", name=title, exact=True)
        tab.click()
        expect(tab).to_have_attribute("aria-selected", "true")
        enter(page, cell, value)
        if name in DROPPED:
            tab.click()  # the page is opened anew
            leaving.get_by_role("button", name="DROP").click()
            expect(page.locator(f"#cell-{cell}")).not_to_have_class(re.compile("is-changed"))
            enter(page, cell, value)
        assert store.read(cell) == before[cell], name
        save.click()
        until(page, lambda cell=cell, value=value: store.read(cell) == float(value))  # type: ignore[misc]
        expect(save).to_be_disabled()
    expect(page.locator("#prompt")).to_have_text("Saved: 1")
    assert {cell: store.read(cell) for cell in before} == {
        cell: float(value) for cell, value in ENTERED.values()
    }
    with store.transaction():
        for cell, former in before.items():
            store.write(cell, former)
    page.get_by_role("button", name="CLOSE").click()
    expect(page.locator("#screen")).to_be_hidden()


def test_the_number_of_an_input_is_typed_or_the_word_that_switches_it_off(
    page: Page, served: Served
) -> None:
    store = served.panel.installation.store
    page.keyboard.press("F8")
    page.keyboard.press("F1")
    page.get_by_role("tab", name="I/O", exact=True).click()
    field = page.locator(f"#cell-{IO.feedhold_input}")
    expect(field).to_have_value("-1")
    expect(page.locator(f"#cell-{IO.feedhold_input}-hint")).to_contain_text("-1: disable")
    for entered, stored in (("12", 12), ("disable", -1)):
        field.fill(entered)
        page.get_by_role("button", name="SAVE", exact=True).click()
        until(page, lambda stored=stored: store.read(IO.feedhold_input) == stored)  # type: ignore[misc]
        expect(field).to_have_value(str(stored))


@pytest.mark.req("MILL-DIAG-IO-COUNT")
def test_io_status_has_the_lines_of_the_card_model_and_of_its_modules(
    page: Page, served: Served
) -> None:
    store = served.panel.installation.store
    for press in ("F8", "F5", "F1"):
        page.keyboard.press(press)
    rows = page.locator("#screen .io-row")
    model = store.read_text(GENERAL.card_model)
    for name, modules, inputs, outputs in (
        (model, 0, [*range(32)], [*range(32, 64)]),
        ("ACR2000", 0, [*range(16)], [*range(32, 48)]),
        ("ACR2000", 1, [*range(16), *range(256, 288)], [*range(32, 48), *range(288, 320)]),
        (model, 0, [*range(32)], [*range(32, 64)]),
    ):
        with store.transaction():
            store.write_text(GENERAL.card_model, name)
            store.write(CONTROL.io_expansion_modules, modules)
        expect(rows).to_have_count(len(inputs) + len(outputs))
        assert rows.evaluate_all(BITS) == [*inputs, *outputs]


@pytest.mark.req("MILL-BEY-BSC-SCREEN", "MILL-OFS-MENU", "MILL-OFS-SAVEPAGE")
def test_the_ballscrew_screen_lists_edits_imports_exports_and_switches_a_table(
    page: Page, served: Served, tmp_path: Path
) -> None:
    store = served.panel.installation.store
    file = tmp_path / "measured.txt"
    file.write_text("Y1E.00175\nY0E.00325\nY2E-.00250\n")
    page.keyboard.press("F8")
    page.keyboard.press("F3")
    page.get_by_role("tab", name="Ballscrew", exact=True).click()
    chosen = page.locator("#screen").get_by_role("radio", name="Y", exact=True)
    chosen.click()
    expect(chosen).to_be_checked()
    with page.expect_file_chooser() as chooser:
        page.get_by_role("button", name="IMPORT").click()
    chooser.value.set_files(file)
    expect(page.locator("#prompt")).to_have_text("measured.txt is read; SAVE stores it")
    rows = page.locator("#screen table.ballscrew tbody tr")
    expect(rows).to_have_count(3)
    values = rows.locator("input").evaluate_all("(all) => all.map((each) => each.value)")
    assert values == ["0", "0.00325", "1", "0.00175", "2", "-0.0025"]
    page.get_by_label("Error 2", exact=True).fill("0.002")
    page.get_by_role("button", name="ADD ROW").click()
    page.get_by_label("Position 4", exact=True).fill("2")
    page.get_by_label("Error 4", exact=True).fill("0,001")
    page.get_by_role("button", name="SAVE", exact=True).click()
    expect(page.locator("#prompt")).to_contain_text("position 2 occurs twice")
    assert store.read_text(OFFSETS.ballscrew_file[1]) == ""
    page.get_by_label("Position 4", exact=True).fill("3")
    rows.nth(0).get_by_role("button").click()
    page.get_by_role("button", name="SAVE", exact=True).click()
    expect(page.locator("#prompt")).to_have_text("The ballscrew table of Y is stored")
    with page.expect_download() as download:
        page.get_by_role("button", name="EXPORT").click()
    exported = download.value.path().read_text()
    assert exported == "Y1E.00200\nY2E-.00250\nY3E.00100\n"
    assert download.value.suggested_filename == "ballscrew_Y.txt"

    def on_card() -> list[int]:
        return served.call(lambda station: sorted(station.link.machine.runner._compensation._axes))

    assert (store.read(OFFSETS.ballscrew_on[1]), on_card()) == (0, [])
    for is_on, axes in ((True, [1]), (False, [])):
        page.get_by_label("Table on").set_checked(is_on)
        page.get_by_role("button", name="SAVE", exact=True).click()
        expect(page.get_by_role("button", name="SAVE", exact=True)).to_be_disabled()
        until(page, lambda axes=axes: on_card() == axes)  # type: ignore[misc]
        until(page, lambda is_on=is_on: store.read(OFFSETS.ballscrew_on[1]) == int(is_on))  # type: ignore[misc]
    page.get_by_role("button", name="ADD ROW").click()
    page.get_by_label("Position 4", exact=True).fill("9")
    page.keyboard.press("Escape")
    question = page.get_by_role("dialog", name="Not saved")
    question.get_by_role("button", name="DROP").click()
    expect(page.locator("#screen")).to_be_hidden()
