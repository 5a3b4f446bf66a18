"""The editor of the workspace: what a person types, and what the card makes of it."""

import re
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest
from playwright.sync_api import Browser, BrowserContext, Locator, Page, Route, expect
from tests.panel.bench import Served
from tests.panel.browser.conftest import (
    give,
    hold_answers,
    open_page,
    picture,
    release_answers,
    until,
    until_model,
)
from tests.panel.browser.test_bench import show_pane
from tests.panel.browser.test_screens import AXE, AXE_RUN

from openacr.client import Level
from openacr.panel.control.station import Station

COUNTING = "PROGRAM\nDIM LV(1)\n_more\nLV0 = LV0+1\nDWL 0.2\nGOTO more\nENDP\n"


def on_card(served: Served, *lines: str) -> None:
    """Type lines at the card."""

    def do(station: Station) -> None:
        station.link.machine.card.go(Level())
        for line in lines:
            station.link.machine.card.command(line)

    served.call(do)


def stored(served: Served, text: str) -> None:
    served.call(lambda station: station.link.machine.card.download(text, to=Level.program(3)))


def listed(served: Served) -> str:
    return served.call(lambda station: station.link.machine.card.upload(Level.program(3)))


@pytest.fixture(scope="module")
def workspace(context: BrowserContext, served: Served) -> Page:
    stored(served, COUNTING)
    for ask in ("colors", "findings"):  # the processes start; a loaded machine takes long for it
        text = {"mark": "begin-0123", "name": "prog3.8k", "version": 1, "text": "", "ask": ask}
        assert httpx.post(f"{served.url}/api/text", json=text, timeout=None).status_code == 200
    page = open_page(context, f"{served.url}/bench")
    until_model(page, "model.hello.value.client")
    show_pane(page, "editor")
    expect(pane(page).get_by_label("Program or file").get_by_role("option")).not_to_have_count(0)
    return page


@pytest.fixture
def page(workspace: Page, served: Served) -> Iterator[Page]:
    """The editor with program 3, as the card lists it."""
    on_card(served, "HALT PROG3")
    stored(served, COUNTING)
    read(workspace)
    yield workspace
    assert workspace.complaints == []  # type: ignore[attr-defined]


def read(page: Page) -> None:
    """Read program 3 of the card, whatever the text here has become."""
    shown = (
        pane(page).locator(".text-foot .hint").get_by_text("PROG3 · halted · 7 lines", exact=True)
    )
    drop = page.get_by_role("dialog").get_by_role("button", name="DROP")
    pane(page).get_by_label("Program or file").select_option("PROG3")
    expect(drop.or_(shown)).to_be_visible()
    if drop.is_visible():
        drop.click()
    expect(shown).to_be_visible()
    expect(lines(page).nth(3)).to_have_text(" LV0 = LV0+1")


def pane(page: Page) -> Locator:
    return page.locator("[data-pane=editor]")


def key(page: Page, name: str) -> Locator:
    return pane(page).locator(".pane-head").get_by_role("button", name=name, exact=True)


def lines(page: Page) -> Locator:
    return pane(page).locator(".cm-line")


def put(page: Page, line: int, text: str) -> None:
    """Type another text in place of a line, from 1."""
    lines(page).nth(line - 1).click()
    page.keyboard.press("End")
    page.keyboard.press("Shift+Home")
    page.keyboard.press("Shift+Home")
    page.keyboard.insert_text(text)


def test_the_editor_begins_with_the_program_that_the_list_shows(
    browser: Browser, page: Page, served: Served
) -> None:
    context = browser.new_context()
    fresh = open_page(context, f"{served.url}/bench")
    until_model(fresh, "model.hello.value.client")
    show_pane(fresh, "editor")
    expect(pane(fresh).locator(".text-foot .hint")).to_contain_text("PROG0 · halted")
    context.close()


def test_the_first_program_is_the_one_chosen_or_one_with_a_text_or_with_room(page: Page) -> None:
    found = page.evaluate("""() =>
    import('/js/bench/editor/card_text.js').then(({ firstLevel }) => {
      const of = (name, used, bytes, owner = '') => ({ name, used, bytes, owner });
      const machines = of('PROG0', 9, 99, 'mill');
      const some = [machines, of('PROG1', 0, 0), of('PROG2', 0, 99), of('PROG3', 9, 99)];
      return [[some, undefined, ''], [some.slice(0, 3), undefined, ''], [some, undefined, 'PROG2'],
        [some, 'PROG0', 'PROG2'], [some, '', 'PROG2'], [some, 'PROG1', 'PROG2']
      ].map((each) => firstLevel(...each));
    })""")
    assert found == ["PROG3", "PROG2", "PROG2", "PROG0", "", ""]


def test_a_mistake_is_marked_listed_and_mended_while_typing(page: Page) -> None:
    put(page, 4, " LV0 = SQR(LV0)")
    expect(pane(page).locator(".cm-lintRange-error")).to_have_count(1)
    expect(pane(page).locator(".findings .item.error")).to_contain_text("4:8")
    pane(page).locator(".findings").get_by_role("button", name="Write SQRT").click()
    expect(lines(page).nth(3)).to_have_text(" LV0 = SQRT(LV0)")
    expect(pane(page).locator(".findings .item")).to_have_count(0)
    expect(lines(page).nth(4).locator(".tok-command")).to_have_text("DWL")


def test_a_word_is_completed_and_a_label_renamed(page: Page) -> None:
    put(page, 4, " DW")
    page.keyboard.type("L")
    expect(pane(page).locator(".cm-tooltip-autocomplete li").first).to_contain_text("DWL")
    page.keyboard.press("Escape")
    lines(page).nth(5).click()
    page.keyboard.press("End")
    page.keyboard.press("F2")
    dialog = page.get_by_role("dialog", name="RENAME")
    expect(dialog.get_by_role("textbox")).to_have_value("more")
    dialog.get_by_role("textbox").fill("again")
    page.keyboard.press("Enter")
    expect(lines(page).nth(5)).to_have_text(" GOTO again")
    expect(lines(page).nth(2)).to_have_text(" _again")


def test_lines_fold_to_their_first_one_and_a_place_within_shows_them_again(page: Page) -> None:
    put(page, 4, " IF (LV0 > 3)\n LV0 = 0\n ENDIF")
    page.keyboard.press("Escape")  # proposals may lie over the lines
    expect(lines(page)).to_have_count(9)
    keys = pane(page).locator(".cm-foldGutter").get_by_title("Fold these lines")
    expect(keys).to_have_count(2)
    keys.nth(1).click()
    expect(lines(page)).to_have_count(7)
    expect(lines(page).nth(3)).to_have_text(" IF (LV0 > 3)\u2026")
    lines(page).nth(1).click()
    page.keyboard.press("End")
    page.keyboard.insert_text("\n DWL 1")
    expect(lines(page)).to_have_count(8)  # what is folded stays so
    expect(lines(page).nth(4)).to_have_text(" IF (LV0 > 3)\u2026")
    page.keyboard.press("Control+Alt+[")  # all of them
    expect(lines(page)).to_have_count(1)
    expect(lines(page).first).to_have_text(" PROGRAM\u2026")
    key(page, "OUTLINE").click()
    pane(page).locator(".text-beside").get_by_role("button", name="more").click()
    expect(lines(page).nth(3)).to_have_text(" _more")
    expect(lines(page).nth(3)).to_have_class(re.compile("cm-activeLine"))


def test_a_number_of_the_card_is_explained_in_its_line_which_stays_as_it_is(
    page: Page, served: Served
) -> None:
    put(page, 4, " LV0 = P12288")
    hint = lines(page).nth(3).locator(".cm-hint")
    expect(hint).to_have_text("AXIS 0: Current Position")
    page.keyboard.press("End")
    page.keyboard.type("+1")
    expect(lines(page).nth(3)).to_have_text(" LV0 = P12288AXIS 0: Current Position+1")
    page.keyboard.press("Home")
    page.keyboard.press("Shift+End")
    page.keyboard.insert_text(" LV0 = P12544")
    expect(hint).to_have_text("AXIS 1: Current Position")
    key(page, "DOWNLOAD").click()
    expect(page.locator("#prompt")).to_have_text("PROG3: 7 lines were sent")
    assert "LV0 = P12544\n" in listed(served)
    page.evaluate(AXE.read_text())
    assert page.evaluate(AXE_RUN) == []


def test_a_refused_line_is_marked_and_another_text_of_the_card_is_not_lost(
    page: Page, served: Served
) -> None:
    put(page, 4, " NOWORD 5")
    key(page, "DOWNLOAD").click()
    refused = pane(page).locator(".cm-line-refused")
    expect(refused).to_have_text(" NOWORD 5")
    expect(page.locator("#prompt")).to_contain_text("4: Unknown command")
    put(page, 4, " LV0 = LV0+2")
    expect(refused).to_have_count(0)
    stored(served, COUNTING.replace("0.2", "0.3"))  # another browser
    key(page, "DOWNLOAD").click()
    dialog = page.get_by_role("dialog", name="Changed meanwhile")
    dialog.get_by_role("button", name="COMPARE").click()
    expect(pane(page).locator(".compared .is-different")).to_have_count(2)
    assert "0.3" in listed(served)
    key(page, "DOWNLOAD").click()
    dialog.get_by_role("button", name="OVERWRITE").click()
    expect(page.locator("#prompt")).to_have_text("PROG3: 7 lines were sent")
    assert "LV0+2" in listed(served) and "0.2" in listed(served)
    key(page, "COMPARE").click()
    expect(pane(page).locator(".compared caption")).to_have_text("PROG3 · the same on the card")


def test_the_answer_of_a_download_leaves_a_text_that_was_opened_meanwhile(page: Page) -> None:
    """The text of the set-up is not taken for that of the program."""
    hint = pane(page).locator(".text-foot .hint")
    hold_answers(page)
    key(page, "DOWNLOAD").click()
    page.wait_for_function("() => window.heldAnswers.length")
    pane(page).get_by_label("Program or file").select_option("")
    expect(hint).to_have_text("setup.8k · 1 line")
    with page.expect_response(re.compile("/card/")):  # of the version that is stored now
        release_answers(page)
    expect(page.locator("#prompt")).to_have_text("PROG3: 7 lines were sent")
    expect(hint).to_have_text("setup.8k · 1 line")
    put(page, 1, "ATTACH MASTER0")
    expect(hint).to_have_text("setup.8k · 1 line · changed")


def test_the_running_line_is_marked_and_stays_at_its_line(page: Page, served: Served) -> None:
    on_card(served, "RUN PROG3")
    running = pane(page).locator(".cm-line-running")
    expect(running).to_have_text(" DWL 0.2")
    expect(running).to_have_attribute("data-mark", "PROG3")
    expect(key(page, "DOWNLOAD")).to_be_disabled()
    lines(page).nth(1).click()
    page.keyboard.press("End")
    page.keyboard.insert_text("\n' a line of its own")
    expect(lines(page)).to_have_count(8)
    expect(running).to_have_text(" DWL 0.2")
    on_card(served, "HALT PROG3")
    expect(running).to_have_count(0)


def test_variables_and_the_flow_stack_of_a_program_are_seen_and_changed(
    page: Page, served: Served
) -> None:
    looping = "PROGRAM\nDIM LV(1)\nLV0 = 5\nWHILE (LV0 < 9)\nP5 = LV0\nDWL 0.1\nWEND\nENDP\n"
    stored(served, looping)
    on_card(served, "RUN PROG3")
    show_pane(page, "variables")
    shown = page.locator("[data-pane=variables]")
    shown.get_by_label("Program").select_option("3")
    expect(shown.locator(".level")).to_have_text("WHILE 40")
    expect(shown.locator("[data-item=P5] .live")).to_have_text("5")
    shown.get_by_role("button", name="Change LV0").click()
    page.get_by_role("dialog").get_by_role("textbox").fill("4+3")
    page.keyboard.press("Enter")
    expect(shown.locator("[data-variable=LV0] .live")).to_have_text("7")
    expect(shown.locator("[data-item=P5] .live")).to_have_text("7")
    page.get_by_role("button", name="CLOSE PANE").click()


VALUES = (
    "PROGRAM\nDIM LV(1)\nDIM SA(1)\nDIM SA0(3)\n_more\nSA0(2) = 2.5 : LV0 = LV0+1\n"
    "IF (BIT128 OR P5 > LV0+SA0(LV0 MOD 3)) THEN P5 = P5\nDWL 0.05\nGOTO more\nENDP\n"
)
RESULT = r"LV0 = (\d+)"


def values(page: Page) -> Locator:
    return pane(page).locator(".cm-values")


def shown_count(page: Page) -> int:
    found = re.search(RESULT, values(page).first.get_attribute("data-values") or "")
    return int(found[1]) if found else -1


def test_values_are_beside_the_lines_while_the_program_runs_and_move_no_text(
    page: Page, served: Served
) -> None:
    looks = "(lines) => lines.map((each) => [each.offsetTop, each.offsetHeight, each.textContent])"
    wide = "(scroller) => [scroller.scrollWidth, scroller.scrollHeight]"
    scroller = pane(page).locator(".cm-scroller")
    stored(served, VALUES)
    on_card(served, "P5 = 3", "CLR 128")
    lines(page).nth(0).click()
    key(page, "READ").click()
    expect(lines(page)).to_have_count(10)
    expect(values(page)).to_have_count(2)
    expect(values(page).first).to_have_attribute("data-values", "")  # it is halted
    expect(lines(page).nth(6).locator(".cm-hint").first).to_be_visible()
    expect(values(page).last).to_have_attribute("style", re.compile("width"))
    page.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
    before = lines(page).evaluate_all(looks), scroller.evaluate(wide)
    on_card(served, "RUN PROG3")
    expect(values(page).first).to_have_attribute(
        "data-values", re.compile(rf"SA0\(2\) = 2.5   {RESULT}")
    )
    expect(values(page).last).to_have_attribute(
        "data-values", re.compile(rf"BIT128 = off   P5 = 3   {RESULT}")
    )
    first = shown_count(page)
    until(page, lambda: shown_count(page) > first)
    assert (lines(page).evaluate_all(looks), scroller.evaluate(wide)) == before
    on_card(served, "SET 128", "P5 = 4")
    expect(values(page).last).to_have_attribute("data-values", re.compile("BIT128 = on   P5 = 4"))
    expect(values(page).last).to_have_attribute("title", re.compile("^BIT128 = on\nP5 = 4\nLV0 = "))
    on_card(served, "PAUSE PROG3")
    expect(pane(page).locator(".text-foot")).to_contain_text("paused")
    expect(values(page).last).to_have_attribute("data-values", re.compile("BIT128 = on"))
    assert shown_count(page) > 0
    on_card(served, "HALT PROG3")
    expect(values(page).last).to_have_attribute("data-values", "")


def test_values_are_switched_off_and_stay_so_and_a_card_that_cannot_be_read_says_why(
    page: Page, served: Served
) -> None:
    stored(served, VALUES)
    key(page, "READ").click()
    expect(lines(page)).to_have_count(10)
    on_card(served, "RUN PROG3")
    until(page, lambda: shown_count(page) > 0)
    switch = key(page, "VALUES")
    switch.click()
    expect(values(page).first).to_have_attribute("data-values", "")
    asked: list[str] = []
    page.on("request", lambda each: asked.append(each.url) if "card/values" in each.url else None)
    page.reload()
    until_model(page, "model.hello.value.client")
    expect(switch).to_have_attribute("aria-pressed", "false")
    expect(values(page).first).to_have_attribute("data-values", "")
    expect(pane(page).locator(".text-foot")).to_contain_text("dwells")
    assert asked == []
    held: list[Route] = []  # a link that is slow
    page.route("**/api/card/values?*", lambda route: held.append(route))
    switch.click()
    until(page, lambda: held)
    on_card(served, "CLR 128")
    expect(values(page).last).to_have_attribute(
        "data-values", re.compile("BIT128 = off .* LV0 = –")
    )
    on_card(served, "SET 128")
    expect(values(page).last).to_have_attribute("data-values", re.compile("BIT128 = on"))
    assert len(held) == 1  # the next question waits for the answer
    held[0].fulfill(status=409, json={"error": {"code": "refused", "text": "no second connection"}})
    expect(pane(page).locator(".text-foot")).to_contain_text("no second connection")
    until(page, lambda: len(held) == 2)
    page.unroute("**/api/card/values?*")  # which lets the second one through
    until(page, lambda: shown_count(page) > 0)
    expect(pane(page).locator(".text-foot")).not_to_contain_text("no second connection")
    assert page.complaints == [  # type: ignore[attr-defined]
        "Failed to load resource: the server responded with a status of 409 (Conflict)"
    ]
    page.complaints.clear()  # type: ignore[attr-defined]
    on_card(served, "HALT PROG3")


def test_a_breakpoint_holds_the_program_before_its_line_and_keys_let_it_step(
    page: Page, served: Served, pictures: Path
) -> None:
    bar = pane(page).get_by_role("toolbar", name="Breakpoints and steps")
    expect(bar).to_be_hidden()
    pane(page).locator(".cm-lineNumbers .cm-gutterElement").get_by_text("3", exact=True).click()
    expect(page.locator("#prompt")).to_contain_text("nothing is executed there")
    pane(page).locator(".cm-lineNumbers .cm-gutterElement").get_by_text("4", exact=True).click()
    expect(lines(page).nth(3)).to_have_class(re.compile("cm-line-break"))
    on_card(served, "RUN PROG3")
    held = pane(page).locator(".cm-line-held")
    expect(held).to_have_text(" LV0 = LV0+1")
    expect(held).to_have_attribute("data-mark", "PROG3")
    expect(page.locator("#prompt")).to_contain_text("PROG3 is held before line 40")
    expect(pane(page).locator(".cm-line-running")).to_have_count(0)
    lines(page).nth(5).click()
    page.keyboard.press("F10")
    expect(held).to_have_text(" DWL 0.2")
    bar.get_by_role("button", name="STEP INTO").click()
    expect(held).to_have_text(" GOTO more")
    picture(page, pictures / "bench-program.png")
    on_card(served, "PROG3", "LV0 = 0")
    lines(page).nth(3).click()
    page.keyboard.press("Shift+F9")
    page.get_by_role("dialog").get_by_role("textbox").fill("LV0 = 3")
    page.keyboard.press("Enter")
    expect(lines(page).nth(3)).to_have_attribute("title", "LV0 = 3")
    page.keyboard.press("F5")
    expect(held).to_have_text(" LV0 = LV0+1")
    assert served.call(lambda s: s.link.machine.card.ask("LV0", program=3)) == 3
    page.reload()
    until_model(page, "model.hello.value.client")
    expect(pane(page).locator(".cm-line-break")).to_have_text(" LV0 = LV0+1")
    expect(held).to_have_text(" LV0 = LV0+1")
    bar.get_by_role("button", name="BREAKPOINTS: 1").click()
    page.get_by_role("dialog", name="Breakpoints").get_by_role("button", name="REMOVE ALL").click()
    expect(pane(page).locator(".cm-line-break")).to_have_count(0)
    bar.get_by_role("button", name="GO ON").click()
    expect(held).to_have_count(0)
    on_card(served, "HALT PROG3")


def test_a_breakpoint_that_is_set_before_the_lines_of_the_card_are_known_waits_for_them(
    page: Page,
) -> None:
    held: list[Route] = []

    def hold(route: Route) -> None:
        is_asked = (route.request.post_data_json or {}).get("ask") == "stored"
        held.append(route) if is_asked else route.continue_()

    page.route("**/api/text", hold)
    key(page, "READ").click()
    until(page, lambda: held)
    expect(lines(page).nth(3)).to_have_text(" LV0 = LV0+1")
    pane(page).locator(".cm-lineNumbers .cm-gutterElement").get_by_text("4", exact=True).click()
    page.unroute("**/api/text")  # which lets the question through
    expect(lines(page).nth(3)).to_have_class(re.compile("cm-line-break"))
    give(page, "break.clear")
    expect(pane(page).locator(".cm-line-break")).to_have_count(0)


def test_a_plc_is_held_after_the_scan_that_changes_a_coil_of_its_line(
    page: Page, served: Served
) -> None:
    bar = pane(page).get_by_role("toolbar", name="Breakpoints and steps")
    gutter = pane(page).locator(".cm-lineNumbers .cm-gutterElement")
    on_card(served, "DIM PLC0(2000)", "CLR 200")
    text = "10 LD 200\n20 OUT 201\n"
    served.call(lambda station: station.link.machine.card.download(text, to=Level.plc(0)))
    page.reload()  # the list has the PLC now
    until_model(page, "model.hello.value.client")
    pane(page).get_by_label("Program or file").select_option("PLC0")
    expect(lines(page)).to_contain_text(["10 LD 200", "20 OUT 201"])
    expect(pane(page).locator(".text-foot")).to_contain_text("PLC0 · halted")
    on_card(served, "RUN PLC0")
    gutter.get_by_text("1", exact=True).click()
    expect(page.locator("#prompt")).to_contain_text("PLC0 line 10: no coil of a PLC on this line")
    gutter.get_by_text("2", exact=True).click()
    expect(pane(page).locator(".cm-line-break")).to_contain_text("20 OUT 201")
    expect(bar.get_by_role("button", name="GO ON")).to_be_disabled()
    on_card(served, "SET 200")
    held = pane(page).locator(".cm-line-held")
    expect(held).to_have_attribute("data-mark", "PLC0")
    expect(page.locator("#prompt")).to_contain_text(
        "PLC0 is held: its scan has changed a coil of line 20"
    )
    expect(bar.get_by_role("button", name="STEP OVER")).to_be_disabled()
    bar.get_by_role("button", name="BREAKPOINTS: 1").click()
    listed_there = page.get_by_role("dialog", name="Breakpoints")
    expect(listed_there).to_contain_text("PLC0 line 20")
    page.keyboard.press("Escape")
    lines(page).nth(0).click()
    page.keyboard.press("F5")
    expect(held).to_have_count(0)
    expect(pane(page).locator(".text-foot")).to_contain_text("PLC0 · running")
    page.keyboard.press("ArrowDown")
    page.keyboard.press("F9")
    expect(pane(page).locator(".cm-line-break")).to_have_count(0)
    on_card(served, "HALT PLC0")
    show_pane(page, "plc")
    contact = page.locator("[data-pane=plc] .symbol").first
    contact.focus()
    page.keyboard.press("Enter")
    expect(page.get_by_role("menu", name="BIT200")).to_be_visible()
    page.keyboard.press("Escape")
    expect(contact).to_be_focused()
    page.get_by_role("button", name="CLOSE PANE").click()


def test_where_a_name_is_used_is_shown_over_all_programs_and_leads_to_the_line(
    page: Page, served: Served, pictures: Path
) -> None:
    text = "PROGRAM\nP77 = LV0\nSET 130\nENDP\n"
    served.call(lambda station: station.link.machine.card.download(text, to=Level.program(4)))
    put(page, 4, " LV0 = LV0+P77")
    lines(page).nth(3).locator(".tok-variable").get_by_text("P77").click()
    page.keyboard.press("Shift+F12")
    uses = page.locator("[data-pane=uses]")
    expect(uses.locator(".use")).to_have_count(1)
    expect(uses.locator(".use .is-writes")).to_contain_text("PROG4 20")
    picture(page, pictures / "bench-program-uses.png")
    uses.get_by_label("P10, BIT516, LV0, a name or words").fill("130")
    expect(uses.locator(".use")).to_have_attribute("data-name", "BIT130")
    uses.get_by_label("P10, BIT516, LV0, a name or words").fill("P7")
    expect(uses.get_by_text("No program on the card names it")).to_be_visible()
    page.locator(".bench-tab-text").get_by_text("Editor", exact=True).click()
    lines(page).nth(3).locator(".tok-variable").get_by_text("LV0").first.click()
    page.keyboard.press("Shift+F12")
    expect(uses.locator(".use")).to_have_attribute("data-name", "PROG3 LV0")
    expect(uses.locator(".use-access")).to_have_text(["defines", "writes", "reads"])
    uses.get_by_label("P10, BIT516, LV0, a name or words").fill("lv0")
    expect(uses.locator(".use > strong")).to_have_text(["PROG3 LV0", "PROG4 LV0", "PROG7 LV0"])
    uses.get_by_label("P10, BIT516, LV0, a name or words").fill("130")
    uses.get_by_role("button", name="PROG4 30 writes").click()
    page.get_by_role("dialog").get_by_role("button", name="DROP").click()
    expect(pane(page).locator(".cm-activeLine")).to_contain_text("SET 130")
    page.locator(".bench-tab-text").get_by_text("Cross reference", exact=True).click()
    page.get_by_role("button", name="CLOSE PANE").click()
    page.locator(".bench-tab-text").get_by_text("Editor", exact=True).click()


def test_on_a_phone_the_keys_have_one_row_and_a_menu(page: Page) -> None:
    head, more = pane(page).locator(".pane-head"), pane(page).get_by_label("More keys")
    expect(more).to_be_hidden()
    wide = page.viewport_size
    assert wide is not None
    page.set_viewport_size({"width": 390, "height": 844})
    expect(page.locator(".dv-groupview")).to_have_count(1)  # the layout of a narrow window
    expect(page.locator(".bench-pane")).to_have_count(1)
    read(page)
    expect(more).to_be_visible()
    box = head.bounding_box()
    assert box is not None
    assert box["height"] <= 56.0
    assert head.evaluate("row => row.scrollWidth <= row.clientWidth")
    outline = head.get_by_role("button", name="OUTLINE")
    expect(outline).to_be_hidden()
    more.click()
    menu = pane(page).locator(".more-menu")
    expect(menu).to_be_visible()
    assert menu.locator("button").first.inner_text().strip() != "OUTLINE"  # in their order
    outline.click()
    expect(menu).to_be_hidden()
    expect(pane(page).get_by_role("region", name="Beside the text")).to_be_visible()
    pane(page).get_by_role("button", name="CLOSE").click()
    page.set_viewport_size(wide)
    expect(more).to_be_hidden()
    expect(outline).to_be_visible()
    texts = head.locator("button:visible").all_inner_texts()
    assert texts.index("READ") < texts.index("COMPARE") < texts.index("OUTLINE")
