"""PROGRAM/PLC and the PLC tab: what a person sees and does there."""

import re
from collections.abc import Iterator

import pytest
from playwright.sync_api import BrowserContext, Locator, Page, Route, expect
from tests.panel.bench import Served
from tests.panel.browser.conftest import open_page, to_main_menu, until

from openacr.client import Level
from openacr.panel.control.station import Station
from openacr.panel.roles import Role

LADDER = (
    "10 LD 128\n20 AND NOT 129\n30 LD 130\n40 OR LD\n50 OUT 131\n60 LD 131 TIM 0 600000\n"
    "70 LD 5 LD 6 CNT 1 5\n"
)
COUNTING = "PROGRAM\nDIM LV(1)\n_more\nLV0 = LV0+1\nDWL 0.2\nPRINT LV0\nGOTO more\nENDP\n"


def on_card(served: Served, *lines: str) -> None:
    """Type lines at the card."""

    def do(station: Station) -> None:
        card = station.link.machine.card
        card.go(Level())
        for line in lines:
            card.command(line)

    served.call(do)


def stored(served: Served, level: Level, text: str) -> None:
    served.call(lambda station: station.link.machine.card.download(text, to=level))


def listing_of(served: Served, level: Level) -> str:
    return served.call(lambda station: station.link.machine.card.upload(level))


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    """A panel whose card has a PLC and a program."""
    panel = Served(tmp_path_factory.mktemp("panel"))
    on_card(panel, "DIM PLC0(2000)", "DIM PLC1(1000)")
    stored(panel, Level.plc(0), LADDER)
    stored(panel, Level.plc(1), "10 AND 5\n")
    stored(panel, Level.program(3), COUNTING)
    yield panel
    panel.close()


@pytest.fixture
def programs(page: Page, served: Served) -> Page:
    """The screen PROGRAM/PLC with program 3 halted and chosen."""
    on_card(served, "AUT PROG3", "HALT PROG3")
    stored(served, Level.program(3), COUNTING)
    page.keyboard.press("F8")
    page.keyboard.press("F6")
    item(page, "PROG3").click()
    expect(side(page)).to_contain_text("PROG3 · halted")
    return page


def item(page: Page, name: str) -> Locator:
    return page.locator(f".program-list [data-name={name}]")


def side(page: Page) -> Locator:
    return page.locator(".program-side > strong")


def key(page: Page, name: str) -> Locator:
    return page.locator(".program-keys").get_by_role("button", name=name, exact=True)


def chosen(page: Page, name: str) -> None:
    key(page, name).click()


def confirmed(page: Page, name: str) -> None:
    page.get_by_role("dialog").get_by_role("button", name=name).click()


@pytest.mark.req("MILL-PLC-VIEW")
def test_programs_and_plcs_are_listed_and_their_text_is_shown(programs: Page) -> None:
    page = programs
    names = [f"PROG{n}" for n in range(16)] + [f"PLC{n}" for n in range(8)]
    expect(page.locator(".program-list .name")).to_have_text(names)
    expect(page.locator(".program-text .listing-row")).to_have_count(8)
    expect(page.locator(".listing-row[data-line='5'] .listing-text")).to_have_text(" DWL 0.2")
    expect(page.locator(".listing-row[data-line='5'] .listing-number")).to_have_text("50")
    item(page, "PLC0").click()
    expect(page.locator(".program-text .listing-row")).to_have_count(7)
    expect(page.locator(".listing-row[data-line='2'] .listing-text")).to_have_text("AND NOT 129")
    expect(item(page, "PROG9")).to_contain_text("no memory")
    expect(item(page, "PLC0")).to_contain_text("bytes")


@pytest.mark.req("MILL-PLC-STATUS")
def test_each_program_and_plc_shows_whether_it_runs_and_its_line(
    programs: Page, served: Served
) -> None:
    page = programs
    expect(item(page, "PLC0").locator(".program-state")).to_have_text("")
    expect(item(page, "PROG3").locator(".program-state")).to_have_text("")
    on_card(served, "RUN PLC0", "RUN PROG3")
    expect(item(page, "PLC0").locator(".program-state")).to_have_text("▶ running")
    expect(item(page, "PROG3").locator(".program-state")).to_have_text("▶ dwells")
    expect(side(page)).to_have_text("PROG3 · dwells · line 50")
    marked = page.locator(".program-text .listing-row.is-active .listing-number")
    expect(marked).to_have_text("50")
    on_card(served, "HALT PLC0", "HALT PROG3")
    expect(item(page, "PLC0").locator(".program-state")).to_have_text("")
    expect(side(page)).to_have_text("PROG3 · halted")
    expect(marked).to_have_count(0)


def test_a_program_is_started_held_stepped_and_ended_by_keys(programs: Page) -> None:
    page = programs
    for name in ("PAUSE", "RESUME", "STEP"):
        expect(key(page, name)).to_be_disabled()
    chosen(page, "RUN")
    expect(page.get_by_role("dialog")).to_contain_text("can move axes at once")
    confirmed(page, "RUN")
    expect(side(page)).to_contain_text("PROG3 · dwells")
    for name in ("RUN", "EDIT", "CLEAR"):
        expect(key(page, name)).to_be_disabled()
    chosen(page, "PAUSE")
    expect(side(page)).to_contain_text("PROG3 · paused")
    chosen(page, "RESUME")
    expect(side(page)).to_contain_text("PROG3 · dwells")
    chosen(page, "BLOCK")
    expect(side(page)).to_contain_text("waits for STEP")
    before = side(page).inner_text()
    chosen(page, "STEP")
    expect(side(page)).not_to_have_text(before)
    chosen(page, "BLOCK")
    expect(side(page)).to_contain_text("PROG3 · dwells")
    page.get_by_role("button", name="STOP feed hold").click()
    expect(side(page)).to_contain_text("PROG3 · paused")
    chosen(page, "HALT")
    expect(side(page)).to_have_text("PROG3 · halted")


def test_what_a_program_prints_is_heard(programs: Page) -> None:
    page = programs
    chosen(page, "LISTEN")
    chosen(page, "RUN")
    confirmed(page, "RUN")
    printed = page.locator(".printed")
    expect(printed).to_contain_text(re.compile(r"\d+\n\d+\n\d+\n"))
    chosen(page, "LISTEN")
    expect(printed).to_be_hidden()
    chosen(page, "HALT")


def test_a_text_is_edited_sent_and_cleared(programs: Page, served: Served) -> None:
    page = programs
    chosen(page, "EDIT")
    text = page.locator(".program-side textarea")
    expect(text).to_have_value(listing_of(served, Level.program(3)).rstrip("\n"))
    text.fill("PROGRAM\nPRINT 2 +\nENDP\n")
    chosen(page, "SEND")
    expect(page.locator("#prompt")).to_have_text("⚠ 2: Syntax error (PROG3 has its former text)")
    assert text.input_value() == "PROGRAM\nPRINT 2 +\nENDP\n"  # what was typed stays
    page.keyboard.press("Escape")
    expect(page.get_by_role("dialog", name="Not saved")).to_contain_text("PROG3 has changes")
    page.get_by_role("button", name="CANCEL").click()
    text.fill("PROGRAM\nPRINT 42\nENDP\n")
    chosen(page, "SEND")
    expect(page.locator("#prompt")).to_have_text("PROG3: 3 lines are stored on the card")
    expect(page.locator(".program-text .listing-row")).to_have_count(3)
    assert "PRINT 42" in listing_of(served, Level.program(3))
    chosen(page, "CLEAR")
    confirmed(page, "CLEAR")
    expect(page.locator("#prompt")).to_have_text("PROG3 is empty")
    assert listing_of(served, Level.program(3)) == ""
    item(page, "PLC0").click()
    chosen(page, "EDIT")
    expect(text).to_have_value(LADDER.rstrip("\n"))
    text.fill(LADDER + "80 LD 7 OUT 41\n")
    chosen(page, "SEND")
    expect(page.locator("#prompt")).to_have_text("PLC0: 8 lines are stored on the card")
    stored(served, Level.plc(0), "NEW\n" + LADDER)


def test_a_text_is_edited_only_once_it_has_been_read(programs: Page) -> None:
    """What is sent under a name is never the text of the program that was chosen before."""
    page = programs
    asked: list[Route] = []
    rows = page.locator(".program-text .listing-row")
    expect(rows).to_have_count(8)
    listing = re.compile(r"/card/listing\?plc=0$")
    page.route(listing, lambda route: asked.append(route))
    with page.expect_request(listing):
        item(page, "PLC0").click()
    expect(side(page)).to_contain_text("PLC0")
    expect(rows).to_have_count(0)
    expect(key(page, "EDIT")).to_be_disabled()
    expect(key(page, "CLEAR")).to_be_disabled()
    until(page, lambda: asked)
    asked[0].continue_()
    expect(rows).to_have_count(7)
    expect(key(page, "CLEAR")).to_be_enabled()
    item(page, "PROG3").click()
    expect(rows).to_have_count(8)
    with page.expect_request(listing):
        item(page, "PLC0").click()
    until(page, lambda: asked[1:])
    asked[1].abort()
    expect(page.locator("#prompt")).to_contain_text("⚠")
    expect(rows).to_have_count(0)
    expect(key(page, "EDIT")).to_be_disabled()
    page.unroute_all()
    item(page, "PLC0").click()
    chosen(page, "EDIT")
    expect(page.locator(".program-side textarea")).to_have_value(LADDER.rstrip("\n"))
    page.complaints.clear()  # type: ignore[attr-defined]  # of the answer that was cut off


def test_programs_of_this_machine_can_only_be_looked_at(programs: Page) -> None:
    page = programs
    item(page, "PROG7").click()
    expect(page.locator(".program-keys .hint")).to_have_text(
        "PROG7 of the card belongs to this machine"
    )
    for name in ("RUN", "HALT", "PAUSE", "RESUME", "BLOCK", "STEP", "EDIT", "CLEAR"):
        expect(key(page, name)).to_be_disabled()
    expect(page.locator(".program-text .listing-row").first).to_contain_text("REM openacr watchdog")


def test_a_viewer_sees_everything_and_commands_nothing(
    context: BrowserContext, served: Served, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(served.panel.accounts, "role_of", lambda *_session: Role.VIEW)
    page = open_page(context, served.url)
    page.keyboard.press("F8")
    page.keyboard.press("F6")
    item(page, "PLC0").click()
    expect(page.locator(".program-text .listing-row")).to_have_count(7)
    for name in ("RUN", "HALT", "EDIT", "CLEAR"):
        expect(key(page, name)).to_be_disabled()
    expect(page.locator(".program-keys .hint")).to_contain_text("service")
    page.close()


# --- ladder ---------------------------------------------------------------------------


def set_bit(served: Served, bit: int, on: bool) -> None:
    served.call(lambda station: station.link.machine.card.write_bit(bit, on))


def symbol(page: Page, rung: int, n: int) -> Locator:
    return page.locator(".rung").nth(rung).locator(".symbol").nth(n)


@pytest.mark.req("MILL-SCR-DISP-PLC")
def test_the_ladder_shows_contacts_coils_and_the_flow_of_power_live(
    page: Page, served: Served
) -> None:
    for bit in (128, 129, 130):
        set_bit(served, bit, False)
    on_card(served, "HALT PLC0")
    page.click("#display-tab-plc")
    page.get_by_role("combobox", name="PLC").select_option("PLC0")
    state = page.locator("#display .pane-tools [role=status]")
    expect(state).to_have_text("halted")
    expect(page.locator(".rung")).to_have_count(3)
    live = page.locator(".rung").nth(0).locator(".wire.is-live")
    expect(live).to_have_count(0)
    on_card(served, "RUN PLC0")
    expect(state).to_have_text("running")
    expect(live).not_to_have_count(0)
    coil, contact = symbol(page, 0, 3), symbol(page, 0, 0)
    on = re.compile("is-on")
    expect(coil).not_to_have_class(on)
    set_bit(served, 128, True)
    expect(contact).to_have_class(on)
    expect(coil).to_have_class(on)
    set_bit(served, 129, True)  # the inverted contact opens
    expect(symbol(page, 0, 1)).not_to_have_class(on)
    expect(coil).not_to_have_class(on)
    set_bit(served, 130, True)  # the branch below carries power
    expect(coil).to_have_class(on)
    expect(coil.locator("title")).to_have_text("BIT 131: on")
    box = symbol(page, 1, 1)
    expect(box.locator(".count")).to_have_text(re.compile(r"^5\d{5}/600000$"))
    expect(symbol(page, 2, 2).locator(".mark")).to_have_text("CNT 1")
    expect(page.locator(".rung svg").first).to_have_attribute("aria-label", "Rung 10, BIT 131: on")
    on_card(served, "HALT PLC0")
    expect(live).to_have_count(0)


def test_what_a_flag_of_the_card_means_is_written_under_its_contact(
    page: Page, served: Served
) -> None:
    stored(served, Level.plc(0), "NEW\n10 LD NOT 769\n20 OUT 131\n")
    page.click("#display-tab-plc")
    page.get_by_role("combobox", name="PLC").select_option("PLC0")
    page.get_by_role("button", name="READ").click()
    expect(page.locator(".rung")).to_have_count(1)
    under = symbol(page, 0, 0).locator("text.small")
    expect(under).to_have_text(["AXIS0 Not Excess", "Error"])
    expect(symbol(page, 0, 1).locator("text.small")).to_have_count(0)
    stored(served, Level.plc(0), "NEW\n" + LADDER)


def test_an_alias_names_its_flag_and_the_keyboard_reaches_every_contact(
    page: Page, served: Served
) -> None:
    for line in ("DIM DEF(10)", "#DEFINE gripper BIT131", "#DEFINE count 128"):
        on_card(served, line)
    text = "NEW\n10 LD 128\n20 AND 769\n30 OUT 131\n40 LD gripper\n50 OUT 132\n"
    stored(served, Level.plc(0), text)
    page.click("#display-tab-plc")
    for plc in ("PLC2", "PLC0"):  # read anew
        page.get_by_role("combobox", name="PLC").select_option(plc)
        expect(page.locator(".rung")).to_have_count(2 if plc == "PLC0" else 0)
    expect(symbol(page, 0, 2).locator("text.small")).to_have_text("gripper")
    expect(symbol(page, 1, 0).locator("text")).to_have_text(["gripper", "BIT 131"])
    expect(symbol(page, 0, 0).locator("text.small")).to_have_count(0)  # count is no flag
    about = page.locator(".ladder-about")
    expect(about).to_be_hidden()
    page.locator(".ladder").focus()
    page.keyboard.press("Tab")
    expect(symbol(page, 0, 0)).to_be_focused()
    set_bit(served, 128, True)
    expect(about).to_have_text("BIT 128: on")
    for key, rung, n in (
        ("ArrowLeft", 0, 0), ("ArrowRight", 0, 1), ("ArrowRight", 0, 2), ("ArrowRight", 0, 2),
        ("ArrowLeft", 0, 1), ("ArrowLeft", 0, 0), ("ArrowDown", 1, 0), ("ArrowRight", 1, 1),
        ("ArrowLeft", 1, 0), ("ArrowUp", 0, 0),
    ):  # fmt: skip
        page.keyboard.press(key)
        expect(symbol(page, rung, n), key).to_be_focused()
    page.keyboard.press("ArrowRight")
    page.get_by_role("button", name="READ").dispatch_event("click")  # redrawn, the focus stays
    expect(symbol(page, 0, 1)).to_be_focused()
    expect(about).to_have_text(re.compile("^BIT 769 AXIS0 Not Excess Error: "))
    set_bit(served, 128, False)
    stored(served, Level.plc(0), "NEW\n" + LADDER)


def test_a_plc_that_is_no_ladder_is_shown_as_text_with_the_reason(page: Page) -> None:
    page.click("#display-tab-plc")
    page.get_by_role("combobox", name="PLC").select_option("PLC1")
    expect(page.locator(".ladder")).to_have_text(
        "Not drawn as a ladder: PLC error line 10: LD expected"
    )
    expect(page.get_by_role("region", name="LIST")).to_have_text("   10 AND 5")
    page.get_by_role("combobox", name="PLC").select_option("PLC5")
    expect(page.locator(".ladder")).to_have_text("This PLC has no text.")


CARRIED = """async ([rung, on, isRunning]) => {
  const { carried } = await import('/js/draw/ladder.js');
  return carried(rung, (flag) => (flag === 99 ? undefined : on.includes(flag)), isRunning);
}"""


def contact(flag: int, source: int, sink: int, *, inverted: bool = False) -> dict[str, object]:
    return {"kind": "contact", "flag": flag, "is_negated": inverted, "source": source,
            "sink": sink, "reset": None}  # fmt: skip


def test_power_flows_through_closed_contacts_only(page: Page) -> None:
    inverter = {"kind": "not", "source": 0, "sink": 1, "reset": None, "flag": None}
    counter = {"kind": "counter", "source": 1, "reset": 0, "sink": 2, "flag": 3}
    for symbols, on, expected in (
        ([contact(1, 0, 1), contact(2, 1, 2)], [1, 2], [True, True, True]),
        ([contact(1, 0, 1), contact(2, 1, 2)], [2], [True, False, False]),
        ([contact(1, 0, 1, inverted=True), contact(2, 0, 1)], [], [True, True, False]),
        ([contact(1, 0, 1), contact(2, 0, 1)], [2], [True, True, False]),
        ([contact(99, 0, 1, inverted=True)], [], [True, False, False]),  # not known yet
        ([inverter], [], [True, False, False]),
        ([contact(1, 0, 1), counter], [], [True, False, True]),
    ):
        rung = {"nets": 3, "symbols": symbols}
        assert page.evaluate(CARRIED, [rung, on, True]) == expected
        assert page.evaluate(CARRIED, [rung, on, False]) == [False, False, False]


# --- values ---------------------------------------------------------------------------


def test_two_screens_share_one_subscription_of_values(page: Page, served: Served) -> None:
    """The PLC tab goes on counting after a screen over it has watched other parameters."""
    set_bit(served, 130, True)
    on_card(served, "RUN PLC0")
    page.click("#display-tab-plc")
    page.get_by_role("combobox", name="PLC").select_option("PLC0")
    count = symbol(page, 1, 1).locator(".count")
    expect(count).to_have_text(re.compile(r"^5\d{5}/600000$"))
    for press in ("F8", "F5", "F6"):
        page.keyboard.press(press)
    page.wait_for_selector("#screen[data-screen=servo]")
    expect(page.locator("[data-box=p] .gain").nth(1)).to_have_text("0.002441")
    to_main_menu(page)
    before = count.text_content() or ""
    expect(count).not_to_have_text(before)
    on_card(served, "HALT PLC0")


def test_the_browser_has_nothing_to_complain_about(page: Page) -> None:
    complaints: list[str] = page.complaints  # type: ignore[attr-defined]
    assert [each for each in complaints if "422" not in each] == []
