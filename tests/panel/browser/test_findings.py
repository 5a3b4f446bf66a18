"""What is wrong with a part program is said when it is loaded, with line and column."""

from pathlib import Path

import pytest
from playwright.sync_api import Page, expect
from tests.panel.bench import Served
from tests.panel.browser.conftest import picture, to_main_menu, until_model

OPEN_REMARK = "G21 G90\nG1 X5 F100 (open\nG4 P1\nG83 X1 Q\nM2\n"
NO_CIRCLE = "G21 G90 G17\nG0 X0 Y0\nG2 X10 Y0 I3 J0 F100\nM2\n"
NOTHING_WIRED = "G21 G90\nM8\nG4 P1\nM2\n"
ASKING = '(MSG, Clamp the part)\nM0\nINPUT "Depth in mm", P151\nPRINT "depth=";P151\nM0\n'
SOUND = "G21 G90\nG4 P1\nM2\n"


@pytest.fixture(scope="module", autouse=True)
def written(served: Served) -> None:
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


def test_a_finding_leads_to_its_line_and_column_in_edit(page: Page) -> None:
    load(page, "REMARK.TXT")
    page.get_by_role("dialog").locator(".findings .item", has_text="4:9").click()
    expect(page.locator("#screen-title")).to_contain_text("REMARK.TXT")
    expect(page.get_by_role("dialog")).to_have_count(0)
    expect(page.locator(".cm-content")).to_be_focused()
    page.keyboard.type("!")
    expect(page.locator(".cm-line").nth(3)).to_have_text("G83 X1 Q!")


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
    assert served.call(lambda station: station.machine.runner.is_busy) is False
    dialog.get_by_role("button", name="START ANYWAY").click()
    until_model(page, "model.alarms.value.active.length")
    page.get_by_role("button", name="ACKNOWLEDGE").click()
    until_model(page, "!model.alarms.value.active.length")


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


def test_a_question_of_the_program_is_no_error_where_an_operator_answers_it(page: Page) -> None:
    load(page, "ASKING.TXT")
    expect(page.locator("#prompt")).to_contain_text("ASKING.TXT · 1 warning: 3:1 A61")
    page.keyboard.press("F3")
    dialog = page.get_by_role("dialog", name="RUN")
    expect(dialog.get_by_role("button", name="START", exact=True)).to_be_visible()


def test_of_a_sound_program_nothing_is_said(page: Page) -> None:
    load(page, "SOUND.TXT")
    expect(page.locator("#prompt")).to_have_text("")
    expect(page.locator("#alarms")).to_have_text("SOUND.TXT")
    for key in ("F2", "F3", "F4"):
        assert page.locator(f"[data-fkey={key}]").get_attribute("aria-disabled") is None


def test_the_browser_has_nothing_to_complain_about(page: Page) -> None:
    assert page.complaints == []  # type: ignore[attr-defined]
