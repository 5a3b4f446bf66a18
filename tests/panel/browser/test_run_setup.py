"""RUN SETUP: what is set there reaches a program that does not say it itself, and no other."""

from collections.abc import Iterator
from itertools import pairwise

import pytest
from playwright.sync_api import Locator, Page, expect
from tests.mill.sender import Sender
from tests.panel.bench import Served
from tests.panel.browser.conftest import begin_run, give, load_file, to_main_menu, until_model

from openacr.sysvar.tabs import GENERAL

# Radius, feed and P150 are those of RUN SETUP.
PLAIN = "G21 G90 G54 G17 G40\nG1 X0 Y0 Z60\nG41\nG1 X2 Y2\nX(P150)\nM0\nG40 X2 Y0\nM2\n"
OWN = (
    "G21 G90 G54 G17 G40\nP150=4\nG10 L12 P1 R0.5\nG1 X0 Y0 Z60 F900\nG41 D1\nG1 X2 Y2\nX(P150)\n"
    "M0\nG40 X2 Y0\nM2\n"
)
MODALS = "M0\nM2\n"  # nothing but the codes that a program begins with
CORNERS = ((0, 0), (20, 0), (20, 10), (0, 10), (0, 0))
DRAWING = (
    "0\nSECTION\n2\nENTITIES\n"
    + "".join(
        f"0\nLINE\n8\nCUT\n10\n{a}\n20\n{b}\n11\n{c}\n21\n{d}\n"
        for (a, b), (c, d) in pairwise(CORNERS)
    )
    + "0\nENDSEC\n0\nEOF\n"
)
WORK = "G21 G90 G54 G0 X0 Y0 Z60"


@pytest.fixture
def ready(page: Page, served: Served) -> Iterator[Page]:
    """The machine at zero of G54 with programs in the part folder; nothing runs afterwards."""
    for name, text in (("PLAIN.TXT", PLAIN), ("OWN.TXT", OWN), ("MODALS.TXT", MODALS)):
        (served.programs / name).write_text(text)
    assert give(page, "mdi.execute", line=WORK) is not None
    zero = "model.status.value.work.every((each, n) => Math.abs(each - [0, 0, 60][n]) < 0.01)"
    until_model(page, zero)
    until_model(page, "!model.state.value.busy")
    yield page
    give(page, "stop.all")
    until_model(page, "!model.state.value.busy")
    to_main_menu(page)


def setup(page: Page, key: str, title: str) -> Locator:
    """A form of RUN SETUP by its key; the first field has the focus."""
    to_main_menu(page)
    page.keyboard.press("F5")
    page.keyboard.press(key)
    expect(page.locator("#screen-title")).to_have_text(title)
    focused = page.locator("#screen :focus")
    expect(focused).to_have_count(1)
    return page.locator("#screen")


def typed(page: Page, cell: int, text: str) -> None:
    """Type a value into the field that has the focus; Enter saves it."""
    expect(page.locator(f"#cell-{cell}")).to_be_focused()
    page.keyboard.type(text)
    page.keyboard.press("Enter")


def saved(page: Page, count: int) -> None:
    expect(page.locator("#prompt")).to_have_text(f"Saved: {count}")


def ran(page: Page, name: str) -> list[float]:
    """Where the program has led X and Y of its coordinates at M0, and at which feed."""
    load_file(page, name)
    begin_run(page)
    expect(page.locator("#state")).to_contain_text("HOLD")
    until_model(page, "!(model.status.value.bits & 2)")
    found: list[float] = page.evaluate(
        "() => import('/js/core/app.js').then(({ model: { status: { value } } }) => "
        "[value.work[0], value.work[1], value.feedSet].map((each) => Math.round(100 * each) / 100))"
    )
    give(page, "run.start")
    until_model(page, "!model.state.value.busy")
    return found


@pytest.mark.req("MILL-MENU-SETUP-CMPRAD", "MILL-MENU-SETUP-FEED", "MILL-MENU-SETUP-PPARM")
@pytest.mark.req("MILL-MENU-SETUP-SKIP", "MILL-MENU-RUN-FEED", "MILL-OV-DATAENTRY")
def test_radius_feed_and_p_parameters_of_run_setup_reach_programs_without_their_own(
    ready: Page, served: Served
) -> None:
    page, store = ready, served.panel.installation.store
    assert ran(page, "OWN.TXT") == [4.0, 2.5, 900.0]  # straight to LOAD PROG

    setup(page, "F1", "CMP RAD")
    typed(page, GENERAL.cmp_rad, "wide")  # no number
    expect(page.locator(f"#cell-{GENERAL.cmp_rad}-refusal")).to_contain_text("cannot be 'wide'")
    assert store.read(GENERAL.cmp_rad) == 0.0
    page.locator(f"#cell-{GENERAL.cmp_rad}").select_text()
    typed(page, GENERAL.cmp_rad, "1.5")
    saved(page, 1)
    setup(page, "F4", "Feedrate")
    typed(page, GENERAL.run_setup_feedrate, "fast")
    expect(page.locator("#prompt")).to_contain_text("Not saved; refused: 1")
    assert store.read(GENERAL.run_setup_feedrate) == 0.0
    page.locator(f"#cell-{GENERAL.run_setup_feedrate}").select_text()
    typed(page, GENERAL.run_setup_feedrate, "1200")
    saved(page, 1)
    setup(page, "F6", "P parameters")
    key = page.get_by_role("button", name="P150")
    key.click()
    pad = page.get_by_role("dialog", name="P150")
    page.keyboard.type("deep")
    page.keyboard.press("Enter")
    expect(pad.locator(".refusal")).to_contain_text("Not a number")
    assert store.read(150) == 4.0  # as OWN.TXT has left it
    for each in ("clear", "6"):  # by finger
        pad.get_by_role("button", name=each, exact=True).tap()
    pad.get_by_role("button", name="OK").tap()
    expect(key).to_have_text("P1506")
    assert ran(page, "PLAIN.TXT") == [6.0, 3.5, 1200.0]

    page.keyboard.press("F5")  # FEEDRATE of RUN PROG, between two runs
    expect(page.locator("#screen-title")).to_have_text("Feedrate")
    typed(page, GENERAL.run_setup_feedrate, "600")
    saved(page, 1)
    assert ran(page, "PLAIN.TXT") == [6.0, 3.5, 600.0]
    assert ran(page, "OWN.TXT") == [4.0, 2.5, 900.0]  # says all of it itself


GROUPS = {
    GENERAL.start_motion: ["G0", "G1", "G2", "G3"],
    GENERAL.start_plane: ["G17", "G18", "G19"],
    GENERAL.start_distance: ["as CONTROL", "G90", "G91"],
    GENERAL.start_unit: ["as DISPLAY", "G20", "G21"],
    GENERAL.start_work_system: ["G53", "G54", "G55", "G56", "G57", "G58", "G59"],
    GENERAL.start_path_mode: ["G61", "G62", "G63", "G64"],
    GENERAL.start_return_level: ["G98", "G99"],
    GENERAL.start_ij: ["negative", "positive", "absolute", "as CONTROL"],
}
CHOICES = (
    ("G0", "G18", "G91", "G20", "G55", "G61", "G99", "negative"),
    ("G3", "G19", "G90", "G21", "G59", "G63", "G98", "positive"),
)
POWER_UP = ("G1", "G17", "G90", "G21", "G54", "G64", "G98", "absolute")


def in_force(page: Page, served: Served, wanted: tuple[str, ...]) -> None:
    """At the start of a program that says no code these are in force."""
    load_file(page, "MODALS.TXT")
    begin_run(page)
    expect(page.locator("#state")).to_contain_text("HOLD")
    page.click("#status-tab-view3")
    codes = page.locator("#status .codes")
    for code in wanted[:-1]:
        expect(codes.get_by_text(code, exact=True)).to_have_count(1)
    centres = served.call(lambda station: station.link.reading.work.run.modal.centres)
    assert ("negative", "positive", "absolute")[centres] == wanted[-1]
    page.click("#status-tab-view1")
    give(page, "run.start")
    until_model(page, "!model.state.value.busy")


@pytest.mark.req("MILL-MENU-SETUP-MODALS")
def test_the_code_chosen_for_every_modal_group_is_in_force_at_the_start(
    ready: Page, served: Served
) -> None:
    page = ready
    in_force(page, served, POWER_UP)
    for chosen in CHOICES:
        setup(page, "F7", "Set modals")
        for (cell, codes), code in zip(GROUPS.items(), chosen, strict=True):
            field = page.locator(f"#cell-{cell}")
            assert field.locator("option").all_inner_texts() == codes
            field.select_option(label=code)
        page.get_by_role("button", name="SAVE", exact=True).click()
        saved(page, len(chosen))
        in_force(page, served, chosen)
    setup(page, "F7", "Set modals")
    box = page.get_by_role("checkbox", name="Start set chosen")
    expect(box).to_be_checked()  # by what was saved
    expect(box).to_be_focused()
    page.keyboard.press("Space")
    page.get_by_role("button", name="SAVE", exact=True).click()
    saved(page, 1)
    in_force(page, served, POWER_UP)


SOURCES = {  # the file that each offers, and its key
    "USER FILE": ("PLAIN.TXT", "LOAD"), "LIBRARY PART": ("", "LOAD"),
    "DXF FILE": ("BOX.DXF", "LOAD"),
    "BATCH FILE": ("JOBS.TXT", "LOAD"), "DRIP FEED": ("", "START READING"),
    "RS-232 (LINK)": ("", "RECEIVE"),
}  # fmt: skip


@pytest.mark.req("MILL-MENU-SETUP-LOAD", "MILL-DXF-01", "MILL-DXF-02")
def test_load_prog_offers_every_source_and_drawings_are_found_from_there_and_from_edit(
    ready: Page, served: Served
) -> None:
    page = ready
    (served.programs / "BOX.DXF").write_text(DRAWING)
    (served.programs / "JOBS.TXT").write_text("PLAIN.TXT\n")
    setup(page, "F3", "Load program")
    sources = page.get_by_role("radiogroup", name="Source").get_by_role("radio")
    assert sources.all_inner_texts() == list(SOURCES)
    for name, (file, key) in SOURCES.items():
        page.get_by_role("radio", name=name).click()
        expect(page.get_by_role("radio", name=name)).to_have_attribute("aria-checked", "true")
        expect(page.get_by_role("button", name=key).last).to_be_visible()
        if file:
            expect(page.get_by_role("option", name=file)).to_be_visible()

    page.get_by_role("radio", name="LIBRARY PART").click()
    page.get_by_label("Radius of the middle line").fill("wide")
    page.get_by_role("button", name="LOAD FILE").click()
    expect(page.locator("#prompt")).to_contain_text("Radius of the middle line: Not a number")
    assert served.call(lambda station: station.part.data()["loaded"]["kind"]) == "file"

    for menu in ("load", "edit"):
        to_main_menu(page)
        if menu == "edit":
            page.keyboard.press("F4")
            expect(page.get_by_role("dialog", name="OPEN")).to_be_visible()
            page.keyboard.press("Escape")  # no file yet
            page.get_by_role("button", name="DXF", exact=True).click()
        else:
            setup(page, "F3", "Load program")
            page.get_by_role("radio", name="DXF FILE").click()
        files = page.get_by_role("listbox", name="Part programs").get_by_role("option")
        expect(files).to_have_count(1)  # drawings alone
        expect(files).to_contain_text("BOX.DXF")
    files.click()
    kinds = page.get_by_label("Kind").locator("option")
    assert kinds.all_inner_texts() == ["Continuous path", "Drill pattern"]
    page.get_by_label("Z of the cut").fill("deep")
    page.get_by_role("button", name="CONVERT").click()
    expect(page.locator("#prompt")).to_contain_text("Z of the cut: Not a number")
    page.get_by_label("Z of the cut").fill("-2")
    page.get_by_role("button", name="CONVERT").click()
    expect(page.locator("#prompt")).to_have_text("Conversion was successful: BOX.TXT")
    text = (served.programs / "BOX.TXT").read_text()
    assert "Z-2" in text
    page.get_by_label("Z of the cut").fill("")
    page.get_by_role("button", name="CONVERT").click()
    question = page.get_by_role("dialog", name="CONVERT")
    expect(question).to_contain_text("BOX.TXT is there already")
    question.get_by_role("button", name="OVERWRITE").click()
    expect(page.locator(".dxf-notes")).to_contain_text("the path is cut at Z0: set the depth")
    page.get_by_role("button", name="EDIT", exact=True).last.click()
    expect(page.locator("#screen-title")).to_have_text("Edit: BOX.TXT")
    expect(page.locator(".cm-content")).to_contain_text("M2")


def test_the_browser_has_nothing_to_complain_about(page: Page) -> None:
    complaints: list[str] = page.complaints  # type: ignore[attr-defined]
    known = ("422", "409", "Applying inline style")  # refused values, a file that is there; CSP
    assert [each for each in complaints if not any(n in each for n in known)] == []


@pytest.mark.req("MILL-LOAD-LINK")
def test_a_program_received_by_link_is_shown_as_it_arrives_and_loaded(
    page: Page, served: Served
) -> None:
    sender = Sender()
    file = served.programs / "LINKED.TXT"
    file.write_text("OLD\n")
    page.keyboard.press("F5")
    page.keyboard.press("F3")
    page.get_by_role("radio", name="RS-232 (LINK)").click()
    screen = page.locator("#screen")
    expect(screen.get_by_role("button", name="RECEIVE")).to_be_disabled()
    screen.get_by_label("Port").fill(sender.port)
    screen.get_by_label("Keep as").fill("LINKED.TXT")

    def receive() -> None:
        screen.get_by_role("button", name="RECEIVE").click()
        page.get_by_role("dialog", name="RECEIVE").get_by_role("button", name="OVERWRITE").click()
        expect(screen.get_by_role("status")).to_contain_text(f"LINKED.TXT from {sender.port}")
        sender.send(b"%\nG0 X1\nM2\n")
        expect(screen.get_by_role("status")).to_contain_text("3 lines")

    receive()
    screen.get_by_role("button", name="CANCEL").click()
    expect(screen.get_by_role("status")).to_have_text("LINKED.TXT was cancelled: nothing was kept")
    assert file.read_text() == "OLD\n"
    receive()
    sender.send(b"%")
    expect(screen.get_by_role("status")).to_contain_text("LINKED.TXT is kept: 3 lines")
    assert file.read_text() == "%\nG0 X1\nM2\n%\n"
    screen.get_by_role("button", name="LOAD FILE").click()
    expect(page.locator("#alarms .none")).to_have_text("LINKED.TXT")
    expect(page.locator("#menu")).to_have_attribute("data-shown", "run")
    sender.close()


def test_sizes_of_a_library_part_are_in_the_unit_of_the_machine_and_its_conditions_in_words(
    page: Page, served: Served
) -> None:
    to_main_menu(page)
    page.keyboard.press("F5")
    page.keyboard.press("F3")
    page.get_by_role("radio", name="LIBRARY PART").click()
    page.locator("[data-part=ARCSLOT]").click()
    radius = page.get_by_label("Radius of the middle line", exact=True)
    expect(radius).to_have_value("50.8")
    row = page.locator(".part-form .form-row").first
    expect(row.locator(".unit")).to_have_text("mm")
    expect(row.locator(".hint")).to_have_text("P200 \u00b7 2.54 to 5080")
    angle = page.locator(".part-form .form-row", has=page.get_by_label("Angle it spans"))
    expect(angle.locator(".unit")).to_have_text("deg")
    expect(page.get_by_label("Angle it spans", exact=True)).to_have_value("90")
    for words in (
        "\u201cWidth\u201d < \u201cRadius of the middle line\u201d",
        "\u201cWidth\u201d > 2 \u00d7 the tool radius",
        "\u201cAngle it spans\u201d in radians \u00d7 \u201cRadius of the middle line\u201d \u2265",
        "the tool radius = 0 or \u201cStep over\u201d \u2264 2 \u00d7 the tool radius",
    ):
        expect(page.locator(".load-side .hint")).to_contain_text(words)
    radius.fill("76.2")
    with page.expect_request("**/api/parts/ARCSLOT/path") as drawn:
        radius.press("End")
    sent = drawn.value.post_data_json or {}
    assert sent["values"]["P200"] == pytest.approx(3.0)
    assert sent["values"]["P204"] == 90.0
