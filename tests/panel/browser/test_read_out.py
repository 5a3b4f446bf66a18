"""The status window: what VIEW1 to VIEW3 show, live and alike in every browser."""

import re

import pytest
from playwright.sync_api import BrowserContext, Locator, Page, expect
from tests.panel.bench import Served
from tests.panel.browser.conftest import at_rest, give, open_page, to_main_menu, until_model

from openacr.sysvar.tabs import CONTROL, DISPLAY, OFFSETS

SLOW = "G21 G91 G1 X40 Y20 F60"
MINUS = "\u2212"


def number(text: str) -> float:
    return float(text.replace(MINUS, "-").replace("\u2007", " ").strip())


def view(page: Page, n: int) -> None:
    page.click(f"#status-tab-view{n}")


# At one moment: places, distances to go and next positions of X, Y and Z.
POSITIONS = """() => ['.positions', '[aria-label="Distance to go"]', '[aria-label="Next position"]']
  .map((block) => ['X', 'Y', 'Z'].map((axis) => document.querySelector(
    `#status ${block} [data-axis=${axis}] ${block === '.positions' ? '.work-value' : '.number'}`,
  ).textContent))"""


def choose(page: Page, served: Served, *names: str) -> None:
    """Show these blocks, one view for all."""
    served.panel.installation.store.write_text(DISPLAY.views[2], " ".join(names))
    view(page, 3)
    page.wait_for_function(
        "(count) => document.querySelectorAll('#status-panel > section.block').length === count",
        arg=len(names),
    )


@pytest.mark.req("MILL-SCR-VIEWTABS")
def test_every_view_is_chosen_at_any_time_also_while_a_program_runs(
    page: Page, served: Served
) -> None:
    for is_running in (False, True):
        if is_running:
            give(page, "mdi.execute", line=SLOW)
            until_model(page, "model.state.value.state === 'RUN'")
        for n in (1, 2, 3):
            view(page, n)
            tab = page.locator(f"#status-tab-view{n}")
            expect(tab).to_have_attribute("aria-selected", "true")
            expect(page.locator("#status [aria-selected=true]")).to_have_count(1)
    assert served.call(lambda station: station.link.machine.runner.is_busy)
    give(page, "stop.all")
    at_rest(page, served)


@pytest.mark.req("MILL-DISP-VIEWS-INDEP")
def test_each_view_shows_its_own_blocks_and_a_change_of_one_leaves_the_others(
    page: Page, served: Served
) -> None:
    store = served.panel.installation.store
    kept = [store.read_text(cell) for cell in DISPLAY.views]
    wanted = [
        ["Current position", "Push buttons"],
        ["Distance to go", "Modal status"],
        ["Emergency stop", "Next position", "Feed and spindle"],
    ]
    words = ["position buttons", "distance modal", "estop next feeds"]
    titles = page.locator("#status-panel > section.block")

    def shown() -> None:
        for n in (3, 1, 2):
            view(page, n)
            expect(titles).to_have_count(len(wanted[n - 1]))
            for place, name in enumerate(wanted[n - 1]):
                expect(titles.nth(place)).to_have_attribute("aria-label", name)

    try:
        for cell, text in zip(DISPLAY.views, words, strict=True):
            store.write_text(cell, text)
        shown()
        for n, name, word in ((2, "Modal status", "modal"), (3, "Push buttons", "buttons")):
            wanted[n - 1] = [name]
            store.write_text(DISPLAY.views[n - 1], word)
            shown()
    finally:
        for cell, text in zip(DISPLAY.views, kept, strict=True):
            store.write_text(cell, text)


@pytest.mark.req("MILL-SCR-VIEW-CURPOS", "MILL-SCR-VIEW-DTG", "MILL-SCR-VIEW-NEXTPOS")
def test_positions_distance_to_go_and_next_position_of_every_axis_are_live(
    page: Page, served: Served
) -> None:
    choose(page, served, "position", "distance", "next")
    give(page, "mdi.execute", lines=["G21 G90 G54 G0 X0 Y0 Z0"])
    at_rest(page, served)
    (served.programs / "legs.nc").write_text("G21 G90 G1 X30 Y15 Z3 F90\nX40 Y5 Z1\nM2\n")
    give(page, "program.load", path="legs.nc")
    give(page, "run.begin")
    until_model(page, "model.state.value.state === 'RUN' && model.status.value.toGo[0] > 1")
    first = page.get_by_role("region", name="Next position").locator("[data-axis=X] .number")
    expect(first).to_contain_text("40.000")
    seen = []
    for _ in range(2):
        place, to_go, after = ([*map(number, texts)] for texts in page.evaluate(POSITIONS))
        for at, left, end in zip(place, to_go, (30.0, 15.0, 3.0), strict=True):
            assert at + left == pytest.approx(end, abs=0.3)  # drawn one after the other
        assert after == [40.0, 5.0, 1.0]
        seen.append((place, to_go))
        page.wait_for_function(
            "(x) => Number(document.querySelector('#status .positions [data-axis=X] .work-value').textContent) > x",  # noqa: E501
            arg=place[0] + 0.5,
        )
    for k in range(3):
        assert seen[1][0][k] > seen[0][0][k]
        assert seen[1][1][k] < seen[0][1][k]
    give(page, "stop.all")
    at_rest(page, served)


@pytest.mark.req("MILL-SCR-VIEW-MODAL")
def test_one_code_of_every_modal_group_and_the_offsets_are_live(page: Page, served: Served) -> None:
    choose(page, served, "modal")
    codes = page.locator("#status .codes span")
    give(page, "mdi.execute", line="G21 G90 G17 G54 G94 G40 G49 G98 G64")
    at_rest(page, served)
    wanted = {"G21", "G90", "G17", "G54", "G94", "G40", "G49", "G98", "G64"}
    page.wait_for_function(
        "(wanted) => wanted.every((w) => [...document.querySelectorAll('#status .codes span')].some((e) => e.textContent === w))",  # noqa: E501
        arg=sorted(wanted),
    )
    give(page, "mdi.execute", line="G20 G91 G18 G55 G43 H3 G99 G61 G41 D5")
    at_rest(page, served)
    for code in ("G20", "G91", "G18", "G55", "G43", "G99", "G61", "G41", "D5", "H3"):
        expect(codes.get_by_text(code, exact=True)).to_have_count(1)
    for code in wanted - {"G94"}:
        expect(codes.get_by_text(code, exact=True)).to_have_count(0)
    give(page, "mdi.execute", line="G40 G49 G17 G21 G90 G54 G64 G98")
    at_rest(page, served)


@pytest.mark.req("MILL-SCR-VIEW-FEED")
def test_programmed_and_actual_feed_and_the_override_are_live(page: Page, served: Served) -> None:
    choose(page, served, "feeds")
    percent = page.locator("#status .percent strong").first
    give(page, "override.choose", which="feed", click=10)
    expect(percent).to_have_text("100 %")
    give(page, "mdi.execute", line="G21 G91 G1 X-40 F60")

    def fact(name: str) -> Locator:
        row = page.locator("#status .facts div", has=page.get_by_text(name, exact=True))
        return row.locator("dd")

    expect(fact("F set mm/min")).to_have_text("60")
    expect(fact("Feed mm/min")).to_have_text(re.compile("^(59|6[01])$"))
    give(page, "override.choose", which="feed", click=5)
    expect(percent).to_have_text("50 %")
    expect(fact("Feed mm/min")).to_have_text(re.compile("^(29|3[01])$"))
    expect(fact("F set mm/min")).to_have_text("60")
    give(page, "override.choose", which="feed", click=10)
    give(page, "stop.all")
    at_rest(page, served)


@pytest.mark.req("MILL-SCR-VIEW-VPB")
def test_the_push_buttons_are_shown_with_live_lamps(page: Page, served: Served) -> None:
    store = served.panel.installation.store
    store.write_text(OFFSETS.button_caption[0], "Lamp")
    store.write(OFFSETS.button_set_bit[0], 47)
    store.write(OFFSETS.button_show_bit[0], 47)
    store.write(OFFSETS.button_mode[0], 1)
    choose(page, served, "buttons")
    button = page.locator("#status").get_by_role("button", name="Lamp")
    lamp = button.locator(".lamp.is-on")
    expect(button).to_be_visible()
    for on in (True, False):
        button.click()
        expect(lamp).to_have_count(int(on))
        assert served.call(lambda station: station.link.machine.card.read_bit(47)) is on
    store.write_text(OFFSETS.button_caption[0], "")


@pytest.mark.req("MILL-SCR-POSFONT", "MILL-SYS-CTL-POSDISP")
def test_the_position_font_is_big_or_small_as_position_display_says(
    page: Page, served: Served
) -> None:
    store = served.panel.installation.store
    choose(page, served, "position")
    value = page.locator("#status .positions [data-axis=X] .work-value")

    def size() -> float:
        return float(value.evaluate("(e) => parseFloat(getComputedStyle(e).fontSize)"))

    assert store.default(CONTROL.position_display) == 0  # big
    expect(page.locator("#status .positions")).to_have_attribute("data-size", "big")
    big = size()
    store.write(CONTROL.position_display, 1)
    expect(page.locator("#status .positions")).to_have_attribute("data-size", "small")
    assert size() < 0.7 * big
    store.write(CONTROL.position_display, 0)
    expect(page.locator("#status .positions")).to_have_attribute("data-size", "big")
    until_model(page, "model.status.value.machine.length === 3")


def test_the_read_out_is_switched_between_mm_and_inch(page: Page, served: Served) -> None:
    choose(page, served, "position", "distance", "feeds")
    at_rest(page, served)
    give(page, "zero.preset", values={"X": 25.4, "Y": -12.7})
    work = page.locator("#status .positions .work-value")
    expect(work.nth(0)).to_have_text(re.compile(r"25\.400"))
    page.get_by_role("button", name="mm \u2192 inch").click()
    expect(work.nth(0)).to_have_text(re.compile(r"^\u20071\.0000$"))
    expect(work.nth(1)).to_have_text(f"{MINUS}0.5000")
    expect(page.locator("#status .facts dt").first).to_have_text("Feed inch/min")
    expect(page.locator("#status .simple-row .quiet").first).to_have_text("inch")
    page.locator("#status [data-axis=X] .work-key").click()  # arithmetic in the shown unit
    field = page.locator("dialog .pad-value")
    field.fill("1+2*3/4")
    expect(page.locator("dialog .hint").first).to_have_text("= 2.5 inch")
    field.fill("1+")
    page.keyboard.press("Enter")
    expect(page.locator("dialog .refusal")).to_have_text(
        "Not a number: digits, . + - * / and parentheses"
    )
    field.fill("1+2*3/4")
    page.keyboard.press("Enter")
    expect(work.nth(0)).to_have_text(re.compile(r"2\.5000"))
    page.get_by_role("button", name="inch \u2192 mm").click()
    expect(work.nth(0)).to_have_text(re.compile(r"63\.500"))
    page.evaluate("localStorage.removeItem('openacr.panel.unit')")
    give(page, "zero.clear")


@pytest.mark.req("MILL-SCR-SYNC")
def test_two_browsers_show_the_same_and_one_of_them_jogs(
    page: Page, served: Served, context: BrowserContext
) -> None:
    to_main_menu(page)
    choose(page, served, "position")
    other = open_page(context, served.url)
    view(other, 3)
    both = "({ tick: model.status.value.tick, x: model.status.value.work[0] })"
    read = f"() => import('/js/core/app.js').then(({{ model }}) => {both})"
    give(page, "control.take")
    begin = page.evaluate(read)["x"]
    assert give(page, "mdi.execute", line=SLOW) is not None
    for one in (page, other):
        expect(one.locator("#state")).to_contain_text("RUN")
    for one in (page, other):
        until_model(one, f"model.status.value.work[0] > {begin} + 1")
    first, second = page.evaluate(read), other.evaluate(read)
    # 1 mm/s: positions of the two lie apart by what the machine moved between the two readings.
    apart_s = abs(first["tick"] - second["tick"]) / 1000.0
    assert abs(first["x"] - second["x"]) <= 1.2 * apart_s + 0.01
    give(page, "stop.estop")
    for one in (page, other):
        expect(one.locator("#state")).to_contain_text("ALARM")
        expect(one.locator("#alarms .text")).to_contain_text("Stopped at a screen")
    give(page, "alarm.acknowledge")
    for one in (page, other):
        expect(one.locator("#state")).to_contain_text("IDLE")
    at_rest(page, served)
    other.keyboard.press("F7")
    other.keyboard.press("F2")
    before = served.call(lambda station: station.link.machine.runner.stream.host.position()[0])
    other.get_by_role("button", name="X plus").hover()
    other.mouse.down()
    expect(other.locator("#prompt")).to_contain_text("has control of the machine")
    other.mouse.up()
    assert served.call(lambda s: s.link.machine.runner.stream.host.position()[0]) == before
    other.close()
