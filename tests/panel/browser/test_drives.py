"""Panes for any axis of the card, on the gantry: its Z belongs to a program of the card alone."""

import re
import shutil
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import pytest
from playwright.sync_api import BrowserContext, Locator, Page, expect
from tests.panel.bench import Served
from tests.panel.browser.conftest import open_page, picture, until, until_model
from tests.panel.browser.test_bench import open_pane

from openacr.client import Level
from openacr.map.rows import axes
from openacr.panel.control.operator import presses
from openacr.panel.control.station import Station
from openacr.panel.machine.project import of_project

GANTRY = Path(__file__).parents[3] / "examples" / "gantry"
Z = 2


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return shutil.copytree(GANTRY, tmp_path_factory.mktemp("project") / "gantry")


@pytest.fixture(scope="module")
def served(folder: Path) -> Iterator[Served]:
    installation = of_project(folder, store=None, programs=None, otherwise=folder.parent / "parts")
    panel = Served(folder.parent, installation=installation)
    yield panel
    panel.close()


@pytest.fixture(scope="module")
def workspace(context: BrowserContext, served: Served) -> Page:
    page = open_page(context, f"{served.url}/bench")
    page.set_viewport_size({"width": 1366, "height": 768})
    until_model(page, "model.hello.value.client")
    return page


@pytest.fixture
def page(workspace: Page) -> Iterator[Page]:
    yield workspace
    assert workspace.complaints == []  # type: ignore[attr-defined]


def type_line(served: Served, *lines: str) -> None:
    def typed(station: Station) -> None:
        for line in lines:
            station.link.machine.card.command(line, program=1)

    served.call(typed)


def offset(station: Station) -> float:
    """The jog offset of Z while it is jogged, its position at rest; in units."""
    card = station.link.machine.card
    return float(card.read(axes.primary_setpoint[Z])) / float(card.read(axes.ppu[Z]))


def is_jogged(station: Station) -> bool:
    return station.card_jogs.are_active


def row_of_z(page: Page) -> Locator:
    return page.locator("[data-pane=jog] tr[data-axis=AXIS2]")


def test_z_moves_while_its_key_is_held_with_the_speed_of_the_pane(
    page: Page, served: Served, pictures: Path
) -> None:
    type_line(served, "DRIVE ON Z")
    open_pane(page, "Jog")
    row = row_of_z(page)
    plus = row.get_by_role("button", name="Z (AXIS2) plus")
    plus.hover()
    page.mouse.down()
    page.mouse.up()
    expect(page.locator("#prompt")).to_contain_text("Z (AXIS2): give a speed above 0")
    row.get_by_label("Speed").fill("0.5")
    before = served.call(offset)
    plus.hover()
    page.mouse.down()
    until(page, lambda: served.call(offset) > before + 0.1)
    expect(plus).to_have_class("key jog-key hold is-held")
    picture(page, pictures / "jog-of-the-card.png")
    page.mouse.up()
    until(page, lambda: not served.call(is_jogged))
    at = served.call(offset)
    expect(row.locator("[data-position]")).to_have_text(f"{at:.4f}")


def test_a_step_moves_z_by_it_at_each_press(page: Page, served: Served) -> None:
    row = row_of_z(page)
    row.get_by_label("Step").fill("0.05")
    at = served.call(offset)
    row.get_by_role("button", name="Z (AXIS2) minus").click()
    until(page, lambda: abs(served.call(offset) - (at - 0.05)) < 1e-6)
    until(page, lambda: not served.call(is_jogged))
    row.get_by_label("Step").fill("-1")
    row.get_by_role("button", name="Z (AXIS2) minus").click()
    expect(page.locator("#prompt")).to_contain_text("a step is a number above 0, or empty")
    assert served.call(offset) == pytest.approx(at - 0.05, abs=1e-6)
    row.get_by_label("Step").fill("")


def test_a_page_that_is_frozen_lets_z_rest(
    page: Page, served: Served, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A closed lid: the page runs no more, its key is still down."""
    session = page.context.new_cdp_session(page)
    row_of_z(page).get_by_role("button", name="Z (AXIS2) plus").hover()
    before = served.call(offset)
    page.mouse.down()
    until(page, lambda: served.call(offset) > before)
    session.send("Page.setWebLifecycleState", {"state": "frozen"})
    assert served.call(is_jogged)
    monkeypatch.setattr(presses, "DEAD_MAN_S", 0.2)
    until(page, lambda: not served.call(is_jogged))
    session.send("Page.setWebLifecycleState", {"state": "active"})
    at = served.call(offset)
    page.mouse.up()
    assert served.call(offset) == at


def test_a_drive_that_is_off_is_named(page: Page, served: Served) -> None:
    type_line(served, "SET 8532", "DRIVE OFF Z")
    plus = row_of_z(page).get_by_role("button", name="Z (AXIS2) plus")
    plus.hover()
    page.mouse.down()  # until it is answered: a release overtakes a press that waits
    expect(page.locator("#prompt")).to_contain_text("the drive of axis AXIS2 is off")
    page.mouse.up()
    type_line(served, "DRIVE ON Z")


def drive_row(page: Page) -> Locator:
    return page.locator("[data-pane=drives] tr[data-axis=AXIS2]")


def is_enabled(station: Station) -> bool:
    return station.drives.look()[Z].is_enabled


def until_state(row: Locator, state: str) -> None:
    expect(row.locator(".drive-state")).to_have_text(state)


def test_a_drive_is_switched_off_and_on_after_a_question(
    page: Page, served: Served, pictures: Path
) -> None:
    open_pane(page, "Drives")
    row = drive_row(page)
    expect(row.locator(".drive-state")).to_have_text("ON")
    expect(row.get_by_role("meter", name="Output, V")).to_have_attribute("aria-valuemax", "10")
    for word, state, is_on in (("OFF", "OFF", False), ("ON", "ON", True)):
        row.get_by_role("button", name=f"DRIVE {word}").click()
        dialog = page.get_by_role("dialog", name=f"DRIVE {word}")
        expect(dialog).to_contain_text("axis Z (AXIS2)")
        assert served.call(is_enabled) is not is_on
        dialog.get_by_role("button", name=f"DRIVE {word}").click()
        until_state(row, state)
        assert served.call(is_enabled) is is_on
    expect(page.locator("#prompt")).to_contain_text("The drive of axis Z (AXIS2) is on")
    picture(page, pictures / "drives.png")


def test_what_bars_a_drive_is_read_before_it_is_pressed_and_reset_lifts_it(
    page: Page, served: Served
) -> None:
    type_line(served, "DRIVE OFF Z", "SET 5645")
    row = drive_row(page)
    expect(row.locator("[data-wrong='enable.latched']")).to_contain_text("RESET clears its latch")
    row.get_by_role("button", name="DRIVE ON").click()
    expect(page.locator("#prompt")).to_contain_text("Z (AXIS2): the Motion Enable Input was open")
    row.get_by_role("button", name="RESET DRIVE").click()
    expect(row.locator("[data-wrong]")).to_have_count(0)
    row.get_by_role("button", name="DRIVE ON").click()
    page.get_by_role("dialog").get_by_role("button", name="DRIVE ON").click()
    until_state(row, "ON")


def test_all_off_switches_every_drive_off_at_once(page: Page, served: Served) -> None:
    page.get_by_role("button", name="ALL OFF").click()
    expect(page.locator("[data-pane=drives] .drive-state.is-running")).to_have_count(0)
    assert not any(each.is_enabled for each in served.call(lambda s: s.drives.look()))


def test_the_project_is_compared_with_the_card_and_goes_to_both_sides(
    page: Page, served: Served, folder: Path, pictures: Path
) -> None:
    sign = page.get_by_role("button", name="≠ PROJECT")
    expect(sign).to_be_hidden()
    before = (folder / "prog1.8k").read_text()
    text = "PROGRAM\nDWL 7\nENDP\n"

    def change(station: Station) -> None:
        station.link.machine.card.download(text, to=Level.program(1))
        station.on_card.programs.texts_changed("PROG1")

    served.call(change)
    sign.click()
    pane = page.locator("[data-pane=project]")
    row = pane.locator("tr[data-name=PROG1]")
    expect(row.locator("[data-state=differs]")).to_have_text("differs")
    expect(pane.locator("tr[data-name=PROG0] [data-state=equal]")).to_have_text("equal")
    row.get_by_role("button", name="COMPARE PROG1").click()
    expect(pane.locator("table.compared tr.is-different", has_text="DWL 7")).to_have_count(1)
    picture(page, pictures / "project.png")
    row.get_by_role("button", name="UPLOAD PROG1").click()
    dialog = page.get_by_role("dialog", name="UPLOAD")
    expect(dialog).to_contain_text("PROG1: 10 lines")
    dialog.get_by_role("button", name="CANCEL").click()
    assert (folder / "prog1.8k").read_text() == before
    pane.locator("xpath=..").get_by_role("button", name="DOWNLOAD ALL").click()
    dialog = page.get_by_role("dialog", name="DOWNLOAD")
    expect(dialog).to_contain_text("PROG1: 1 line")
    dialog.get_by_role("button", name="DOWNLOAD").click()
    expect(row.locator("[data-state=equal]")).to_have_text("equal")
    expect(sign).to_be_hidden()
    served.call(change)
    row.get_by_role("button", name="UPLOAD PROG1").click()
    page.get_by_role("dialog").get_by_role("button", name="INTO THE FOLDER").click()
    expect(row.locator("[data-state=equal]")).to_have_text("equal")
    assert "DWL 7" in (folder / "prog1.8k").read_text()


def typed(served: Served, line: str) -> None:
    served.call(lambda station: station.link.machine.card.command(line))


def test_the_set_up_is_compared_setting_by_setting_and_goes_into_the_folder_with_one_question(
    page: Page, served: Served, folder: Path, pictures: Path
) -> None:
    page.evaluate("import('/js/bench/workspace.js').then((each) => each.openPane('project'))")
    pane = page.locator("[data-pane=project]")
    head = pane.locator("xpath=..")
    state = pane.locator("[data-part=setup-state]")
    sign = page.get_by_role("button", name="≠ PROJECT")
    head.get_by_role("button", name="READ", exact=True).click()
    expect(state).to_have_text("The set-up is equal")
    expect(pane).to_contain_text("Not compared, as the card does not tell it: network address")
    expect(sign).to_be_hidden()
    typed(served, "AXIS2 DGAIN 3e-5")

    def change(station: Station) -> None:
        station.link.machine.card.download("PROGRAM\nDWL 8\nENDP\n", to=Level.program(1))
        station.on_card.programs.texts_changed("PROG1")

    served.call(change)
    head.get_by_role("button", name="READ", exact=True).click()
    expect(state).to_have_text("1 setting differs")
    expect(sign).to_have_attribute("title", re.compile("PROG1, set-up \\(1 setting\\)"))
    row = pane.locator("[data-setting='AXIS2 DGAIN']")
    expect(row).to_contain_text("3E-05")
    before = (folder / "setup.8k").read_text()
    number = int(row.locator("td").first.inner_text())
    assert before.splitlines()[number - 1].startswith("AXIS2 DGAIN")
    expect(pane.locator("tr[data-name=PROG1] [data-state=differs]")).to_have_text("differs")
    picture(page, pictures / "project-setup.png")
    head.get_by_role("button", name="UPLOAD ALL").click()
    dialog = page.get_by_role("dialog", name="UPLOAD")
    expect(dialog.locator("li")).to_have_text([re.compile("PROG1: "), "setup.8k: 1 line"])
    dialog.get_by_role("button", name="CANCEL").click()
    assert (folder / "setup.8k").read_text() == before
    head.get_by_role("button", name="UPLOAD ALL").click()
    page.get_by_role("dialog").get_by_role("button", name="INTO THE FOLDER").click()
    expect(state).to_have_text("The set-up is equal")
    expect(sign).to_be_hidden()
    after = (folder / "setup.8k").read_text().splitlines()
    assert [
        n for n, (a, b) in enumerate(zip(before.splitlines(), after, strict=True), 1) if a != b
    ] == [number]
    assert "DWL 8" in (folder / "prog1.8k").read_text()


def store(station: Station, lines: str) -> None:
    station.link.machine.card.download(lines, to=Level.program(1))


def test_the_text_of_the_card_goes_into_the_editor_and_the_folder_stays(
    page: Page, served: Served, folder: Path
) -> None:
    before = (folder / "prog1.8k").read_text()
    for text in ("DWL 9", "DWL 4"):
        lines = f"PROGRAM\n{text}\nENDP\n"
        served.call(partial(store, lines=lines))
        page.evaluate("import('/js/bench/workspace.js').then((each) => each.openPane('project'))")
        pane = page.locator("[data-pane=project]")
        pane.locator("xpath=..").get_by_role("button", name="READ", exact=True).click()
        pane.locator("tr[data-name=PROG1]").get_by_role("button", name="UPLOAD PROG1").click()
        dialog = page.get_by_role("dialog", name="UPLOAD")
        expect(dialog).to_contain_text("PROG1: ")
        dialog.get_by_role("button", name="INTO THE EDITOR").click()
        expect(page.locator("[data-pane=editor] .cm-line", has_text=text)).to_have_count(1)
    assert (folder / "prog1.8k").read_text() == before
