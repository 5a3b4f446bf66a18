"""The engineer's workspace: panes, layouts that the browser keeps, STOP, roles, sizes."""

import json
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, BrowserContext, Locator, Page, Route, expect
from tests.panel.bench import Served
from tests.panel.browser.conftest import (
    give,
    left_over,
    let_through,
    open_page,
    picture,
    until_model,
)
from tests.panel.browser.test_screens import AXE, AXE_COLORS, AXE_RUN, MISFITS

from openacr.panel.control.station import Station
from openacr.sysvar import password

FIRST = [
    "Programs", "PLC", "Editor", "Variables", "Watch list", "Terminal", "Values", "ALARMS",
]  # fmt: skip
ANEW = """() => import('/js/bench/workspace.js').then(({ arrange }) => {
  localStorage.clear();
  arrange(null);
})"""
# As the workspace does when it is opened.
OPENED = """() => import('/js/bench/workspace.js').then(({ arrange }) =>
  import('/js/bench/layouts.js').then(({ presentLayout }) =>
    arrange(presentLayout('wide', 'program'))))"""
KEY = "openacr.panel.bench.wide.program"
KEPT = f"() => JSON.parse(localStorage.getItem('{KEY}') || 'null')"


@pytest.fixture(scope="module")
def bench(context: BrowserContext, served: Served) -> Page:
    """The workspace, opened once for the file."""
    return open_page(context, f"{served.url}/bench")


@pytest.fixture
def page(bench: Page) -> Page:
    """The workspace in its first layout, with no dialog open."""
    bench.set_viewport_size({"width": 1024, "height": 768})
    while bench.get_by_role("dialog").count():
        bench.keyboard.press("Escape")
    bench.evaluate(ANEW)
    return bench


def again(page: Page) -> None:
    page.reload()
    page.wait_for_selector("body:not(.is-stale) #menu .menu-key")
    until_model(page, "model.hello.value.client")


def kept(page: Page, count: int) -> dict[str, Any]:
    """The layout that the browser keeps, once it has this count of panes: it writes late."""
    page.wait_for_function(
        f"(count) => Object.keys(({KEPT})()?.panels ?? {{}}).length === count", arg=count
    )
    layout: dict[str, Any] = page.evaluate(KEPT)
    return layout


def laid_out(page: Page, width: int) -> None:
    """Wait until the workspace has the form of this width: one place on a narrow screen."""
    groups = page.locator(".dv-groupview")
    expect(groups).to_have_count(1) if width <= 900 else expect(groups).not_to_have_count(1)


def write(station: Station, parameter: int, value: float) -> None:
    station.link.machine.card.write(parameter, value)


def tabs(page: Page) -> list[str]:
    return page.locator(".bench-tab-text").all_inner_texts()


def open_pane(page: Page, name: str) -> None:
    page.get_by_role("button", name="PANES").click()
    page.get_by_role("dialog").get_by_role("button", name=name, exact=True).click()
    expect(page.get_by_role("dialog")).to_have_count(0)


def show_pane(page: Page, kind: str) -> None:
    """Show the pane of a kind that is open, or open one."""
    page.evaluate(
        "(kind) => import('/js/bench/workspace.js').then((each) => each.openPane(kind))", kind
    )


def test_the_first_layout_shows_panes_of_the_operators_screens_live(
    page: Page, served: Served
) -> None:
    expect(page.locator(".bench-tab-text")).to_have_text(FIRST)
    show_pane(page, "servo")
    expect(page.locator("#state")).to_contain_text("IDLE")
    gear = page.locator("[data-pane=servo] [data-box=gear] .value")
    for value in (250, 0):  # gear offset of X
        served.call(partial(write, parameter=12288 + 8, value=value))
        expect(gear).to_have_text(str(value))
    expect(page.locator("[data-pane=programs] [data-name=PROG7] .program-state")).not_to_be_empty()
    assert page.complaints == []  # type: ignore[attr-defined]


def test_panes_are_closed_and_opened_and_the_browser_keeps_what_is_open(page: Page) -> None:
    page.locator(".bench-tab-text", has_text="Watch list").click()
    page.get_by_role("button", name="CLOSE PANE").click()
    page.locator(".dv-tab", has_text="Values").locator(".bench-close").click()
    left = [name for name in FIRST if name not in ("Watch list", "Values")]
    expect(page.locator(".bench-tab-text")).to_have_text(left)
    open_pane(page, "Gains")
    expect(page.locator("[data-pane=gain] .gain-row").first).to_be_visible()
    open_pane(page, "Gains")  # the one that is open is shown
    shown = tabs(page)
    assert sorted(shown) == sorted([*left, "Gains"])
    kept(page, len(shown))
    again(page)
    expect(page.locator(".bench-tab-text")).to_have_text(shown)
    expect(page.locator("[data-pane=gain] .gain-row").first).to_be_visible()
    page.get_by_role("button", name="LAYOUTS").click()
    page.get_by_role("button", name="FIRST LAYOUT").click()
    expect(page.locator(".bench-tab-text")).to_have_text(FIRST)


def test_a_layout_is_kept_under_a_name_taken_again_and_deleted(page: Page) -> None:
    page.locator(".dv-tab", has_text="PLC").locator(".bench-close").click()
    expect(page.locator(".bench-tab-text")).to_have_count(len(FIRST) - 1)
    page.get_by_role("button", name="LAYOUTS").click()
    page.get_by_role("button", name="KEEP AS").click()
    page.get_by_label("Name of the layout").fill('without "PLC"')
    page.keyboard.press("Enter")
    expect(page.locator("#prompt")).to_have_text('The layout is kept as without "PLC"')
    page.locator(".dv-tab", has_text="ALARMS").locator(".bench-close").click()
    expect(page.locator(".bench-tab-text")).to_have_count(len(FIRST) - 2)
    kept(page, len(FIRST) - 2)
    again(page)
    expect(page.locator(".bench-tab-text")).to_have_count(len(FIRST) - 2)
    page.get_by_role("button", name="LAYOUTS").click()
    page.get_by_role("button", name='without "PLC"', exact=True).click()
    names = [name for name in FIRST if name != "PLC"]
    expect(page.locator(".bench-tab-text")).to_have_text(names)
    page.get_by_role("button", name="LAYOUTS").click()
    page.get_by_role("button", name='Delete without "PLC"').click()
    page.get_by_role("button", name="CLOSE", exact=True).click()
    page.get_by_role("button", name="LAYOUTS").click()
    expect(page.get_by_role("dialog")).to_contain_text("No layout has been kept under a name.")
    page.keyboard.press("Escape")


@pytest.mark.parametrize("broken", ["{", "{}", "[]", '"text"', None])
def test_a_kept_layout_that_cannot_be_used_is_replaced_by_the_first(
    page: Page, broken: str | None
) -> None:
    expect(page.locator(".bench-tab-text")).to_have_text(FIRST)
    if broken is None:  # of another version, with a pane that is gone
        page.locator(".dv-tab", has_text="PLC").locator(".bench-close").click()
        expect(page.locator(".bench-tab-text")).to_have_count(len(FIRST) - 1)
        broken = json.dumps(kept(page, len(FIRST) - 1)).replace('"terminal"', '"teleprinter"')
        assert "teleprinter" in broken
    page.evaluate(f"(text) => localStorage.setItem('{KEY}', text)", broken)
    page.evaluate(OPENED)
    expect(page.locator(".bench-tab-text")).to_have_text(FIRST)
    assert page.complaints == []  # type: ignore[attr-defined]


def test_the_operator_resizing_the_screen_forgets_no_layout(
    page: Page, context: BrowserContext, served: Served
) -> None:
    page.locator(".dv-tab", has_text="PLC").locator(".bench-close").click()
    expect(page.locator(".bench-tab-text")).to_have_count(len(FIRST) - 1)
    layout = kept(page, len(FIRST) - 1)
    page.evaluate("localStorage.setItem('openacr.panel.split', '0.5')")
    page.evaluate("import('/js/core/settings.js').then((each) => each.forgetSettings())")
    assert page.evaluate("localStorage.getItem('openacr.panel.split')") is None
    assert page.evaluate(KEPT) == layout


def test_stop_holds_the_machine_from_the_workspace_also_over_a_dialog(page: Page) -> None:
    for press in ("click", "key"):
        give(page, "mdi.execute", line="G21 G91 G1 X60 F60")
        until_model(page, "model.state.value.state === 'RUN'")
        page.get_by_role("button", name="PANES").click()
        expect(page.get_by_role("dialog")).to_be_visible()
        if press == "click":
            page.get_by_role("button", name="STOP feed hold").click()
        else:
            page.keyboard.press("Pause")
        until_model(page, "model.state.value.state === 'PAUSED'")
        page.keyboard.press("Escape")
        give(page, "stop.all")
        until_model(page, "!model.state.value.busy")


def test_each_workspace_leads_to_the_other(page: Page, served: Served) -> None:
    page.get_by_role("link", name="OPERATOR").click()
    page.wait_for_url(f"{served.url}/")
    page.wait_for_selector("body:not(.is-stale) #menu [data-fkey]")
    page.get_by_role("button", name="Appearance").click()
    page.get_by_role("link", name="Workspace of the engineer").click()
    page.wait_for_url(f"{served.url}/bench")
    page.get_by_role("button", name="Appearance").click()
    expect(page.get_by_role("link", name="Workspace of the operator")).to_be_visible()
    page.keyboard.press("Escape")


def test_the_alarms_key_of_the_top_shows_the_pane(page: Page, served: Served) -> None:
    page.locator(".dv-tab", has_text="ALARMS").locator(".bench-close").click()
    page.evaluate(
        "import('/js/core/app.js').then(({ model }) => model.alarms.set({ active: "
        "[{ code: 7, text: 'seven', time: '' }], history: [], bars_start: true }))"
    )
    page.locator("#alarms").get_by_role("button", name="ALARMS").click()
    expect(page.locator("[data-pane=alarms] tbody")).to_contain_text("seven")


def test_panes_of_the_service_ask_for_its_password_and_go_on(
    browser: Browser, tmp_path: Path
) -> None:
    served = Served(tmp_path)
    password.change(served.panel.installation.store, "deep secret")
    context = browser.new_context(viewport={"width": 1024, "height": 768})
    try:
        page = open_page(context, f"{served.url}/bench")
        terminal = page.locator("[data-pane=terminal]")
        expect(terminal).to_contain_text("This needs the role service: log in")
        expect(terminal.locator(".xterm")).to_have_count(0)
        terminal.get_by_role("button", name="LOG IN").click()
        page.get_by_role("dialog").get_by_label("Password").fill("deep secret")
        page.keyboard.press("Enter")
        expect(terminal.locator(".xterm")).to_be_visible()
    finally:
        context.close()
        served.close()


def terminal_of(page: Page, name: str) -> Locator:
    return page.get_by_role("region", name=name, exact=True)


def typed(terminal: Locator, line: str) -> None:
    terminal.get_by_label("Line for the card").fill(line)
    terminal.get_by_label("Line for the card").press("Enter")


def test_several_terminals_are_streams_of_their_own_and_are_opened_again(
    page: Page, served: Served
) -> None:
    page.locator(".bench-tab-text", has_text="Programs").click()
    open_pane(page, "Terminal")
    first, second = terminal_of(page, "Terminal"), terminal_of(page, "Terminal 2")
    for terminal in (first, second):
        expect(terminal.locator(".xterm-rows")).to_be_visible()
    typed(second, "PROG5")
    expect(second.locator(".xterm-rows")).to_contain_text("P05>")
    typed(first, "?P12288")
    expect(first.locator(".xterm-rows")).to_contain_text("?P12288")
    expect(first.locator(".xterm-rows")).not_to_contain_text("P05>")
    client = page.evaluate("import('/js/core/app.js').then((app) => app.model.hello.value.client)")
    page.evaluate("import('/js/core/app.js').then((app) => app.link.renew())")
    until_model(page, f"model.hello.value.client > {client} && !model.isStale.value")
    served.call(partial(write, parameter=5, value=55.5))
    typed(second, "?P5")  # the new connection has opened it again
    expect(second.locator(".xterm-rows")).to_contain_text("55.5")
    for _ in range(3):
        open_pane(page, "Terminal")
    expect(page.locator(".bench-tab-text", has_text="Terminal")).to_have_count(4)


@pytest.mark.timeout(300)
@pytest.mark.parametrize("theme", ["light", "dark"])
def test_every_pane_fits_every_size_and_keeps_the_rules_of_accessibility(
    page: Page, pictures: Path, theme: Any
) -> None:
    page.emulate_media(color_scheme=theme)
    page.evaluate(AXE.read_text(encoding="utf-8"))
    panes = page.evaluate("import('/js/bench/panes.js').then(({ PANES }) => Object.keys(PANES))")
    found: dict[str, list[str]] = {}
    sizes = ((1920, 1080), (1024, 768), (800, 600))
    for width, height in sizes if theme == "light" else sizes[-1:]:  # a theme is colours alone
        page.set_viewport_size({"width": width, "height": height})
        laid_out(page, width)
        for pane in panes:
            page.evaluate(
                "(name) => import('/js/bench/workspace.js').then((each) => each.openPane(name))",
                pane,
            )
            expect(page.locator(f"[data-pane={pane}] .pane-body > *").first).to_be_visible()
            name = f"bench-{pane}-{width}x{height}-{theme}"
            found[name] = left_over(page, MISFITS)
            if width == 800:
                found[name] += page.evaluate(
                    AXE_RUN if theme == "light" else AXE_COLORS,
                    f"[data-pane={pane}]" if pane != panes[0] else None,
                )
            picture(page, pictures / f"{name}.png")
    assert {name: each for name, each in found.items() if each} == {}
    complaints: list[str] = page.complaints  # type: ignore[attr-defined]
    # Where all panes ask the card at once, a listing may run out of time; its pane says so.
    assert [each for each in complaints if "503" not in each] == []
    page.complaints.clear()  # type: ignore[attr-defined]


def test_a_tablet_shows_one_pane_at_a_time_and_leaves_the_wide_layout_alone(page: Page) -> None:
    page.locator(".dv-tab", has_text="PLC").locator(".bench-close").click()
    expect(page.locator(".bench-tab-text")).to_have_count(len(FIRST) - 1)
    page.locator(".bench-tab-text", has_text="Watch list").click()
    wide = kept(page, len(FIRST) - 1)
    page.set_viewport_size({"width": 800, "height": 600})
    expect(page.locator("[data-pane=watch]")).to_be_visible()  # the pane in use stays
    expect(page.locator(".dv-groupview")).to_have_count(1)
    expect(page.locator(".bench-tab-text")).to_have_text(FIRST)
    expect(page.locator(".bench-pane")).to_have_count(1)
    page.locator(".bench-tab-text", has_text="ALARMS").click()
    expect(page.locator("[data-pane=alarms]")).to_be_visible()
    expect(page.locator(".bench-pane")).to_have_count(1)
    page.set_viewport_size({"width": 1024, "height": 768})
    expect(page.locator(".bench-tab-text")).to_have_text([name for name in FIRST if name != "PLC"])
    assert page.evaluate(KEPT)["panels"].keys() == wide["panels"].keys()


# --- values ---------------------------------------------------------------------------

WATCHED = """() => import('/js/core/app.js').then(({ link }) => [
  link.topics.get('watch')?.parameters ?? [], link.topics.get('flags')?.words ?? []])"""


@pytest.fixture
def tree(page: Page) -> Locator:
    """The tree of values alone in its place."""
    page.evaluate("import('/js/bench/workspace.js').then((each) => each.openPane('tree'))")
    expect(page.get_by_role("treeitem").first).to_be_visible()
    return page.get_by_role("tree")


def row_of(page: Page, item: str) -> Locator:
    return page.locator(f".tree-row[data-key={item}]")


def search(page: Page, text: str) -> None:
    page.get_by_label("Words of a name, or a number").fill(text)


def watches(page: Page, parameters: list[int], words: list[int]) -> None:
    """Wait until exactly these are asked of the card."""
    end = [sorted(parameters), sorted(words)]
    for _ in range(1200):
        asked = [sorted(each) for each in page.evaluate(WATCHED)]
        if asked == end:
            break
        page.wait_for_timeout(50)
    assert asked == end


def test_the_tree_of_values_is_opened_by_keys_and_only_rows_that_are_seen_are_watched(
    page: Page, tree: Locator
) -> None:
    page.set_viewport_size({"width": 800, "height": 600})
    again(page)
    page.evaluate("import('/js/bench/workspace.js').then((each) => each.openPane('tree'))")
    expect(page.get_by_role("treeitem").first).to_be_visible()
    watches(page, [], [])
    search(page, "master1 in motion")
    expect(row_of(page, "BIT548")).to_contain_text("off")
    search(page, "")
    box = page.get_by_role("tree")
    expect(page.get_by_role("treeitem", name="AXIS 5616")).to_have_count(1)
    box.press("Home")
    box.press("ArrowRight")  # ADC
    adc = page.get_by_role("treeitem").nth(1)
    expect(adc).to_contain_text("ADC0")
    box.press("ArrowDown")
    box.press("ArrowRight")
    expect(row_of(page, "P6408")).to_be_visible()
    box.press("ArrowLeft")
    expect(row_of(page, "P6408")).to_have_count(0)
    box.press("ArrowDown")
    box.press("ArrowLeft")
    box.press("ArrowLeft")
    expect(page.get_by_role("treeitem").nth(0)).to_have_attribute("aria-expanded", "false")
    search(page, "axis0")
    expect(row_of(page, "P12288")).to_be_visible()
    seen = "els => els.map((each) => each.dataset.key).filter((key) => /^P\\d/.test(key))"
    keys = page.get_by_role("treeitem").evaluate_all(seen)
    watches(page, [int(key[1:]) for key in keys], [])
    assert 5 < len(keys) < 30
    box.press("End")
    expect(page.get_by_role("treeitem", selected=True)).to_contain_text("BIT")
    asked: list[list[int]] = []
    for _ in range(1200):  # flags take the place of parameters
        asked = page.evaluate(WATCHED)
        if not asked[0]:
            break
        page.wait_for_timeout(50)
    assert asked[0] == []
    assert 0 < len(asked[1]) < 6


def test_a_value_is_changed_from_the_tree_with_the_refusal_of_the_card(
    page: Page, tree: Locator, served: Served
) -> None:
    search(page, "p12322")
    row_of(page, "P12322").click()
    before = served.call(lambda station: float(station.link.machine.card.read(12322)))
    page.get_by_role("button", name="CHANGE").click()
    page.get_by_role("dialog").get_by_role("textbox").fill("0.5")
    page.keyboard.press("Enter")
    expect(row_of(page, "P12322")).to_contain_text("0.5unit")
    assert served.call(lambda station: float(station.link.machine.card.read(12322))) == 0.5
    served.call(partial(write, parameter=12322, value=before))
    search(page, "bit1920")
    row_of(page, "BIT1920").click()
    for word, state in (("SET", "on"), ("CLEAR", "off")):
        page.get_by_role("button", name="CHANGE").click()
        page.get_by_role("dialog").get_by_role("button", name=word, exact=True).click()
        expect(row_of(page, "BIT1920")).to_contain_text(state)
        is_set = served.call(lambda station: bool(station.link.machine.card.read_bit(1920)))
        assert is_set is (state == "on")
    search(page, "bit516")
    row_of(page, "BIT516").click()
    expect(page.get_by_role("button", name="CHANGE")).to_be_disabled()


def test_the_watch_list_shows_formats_and_is_kept_with_the_layout(
    page: Page, tree: Locator, served: Served
) -> None:
    search(page, "p12322")
    row_of(page, "P12322").click()
    page.locator("[data-pane=tree]").get_by_role("button", name="WATCH").click()
    name = page.get_by_label("P12288, BIT516 or axis0.actual position")
    name.fill("P5; BIT516")
    name.press("Enter")
    rows = page.locator("[data-pane=watch] tbody tr")
    expect(rows).to_have_count(3)
    name.fill("BIT99999")
    name.press("Enter")
    expect(page.locator("#prompt")).to_contain_text("there is no flag BIT99999")
    expect(name).to_have_value("BIT99999")
    served.call(partial(write, parameter=5, value=-2.5))
    value = page.locator("[data-item=P5] .live")
    expect(value).to_have_text("-2.5")
    for shown, text in (
        ("hexadecimal", "0xFFFFFFFE"), ("binary", "11111111 11111111 11111111 11111110"),
        ("0.000", "-2.500"),
    ):  # fmt: skip
        page.get_by_label("Format of P5").select_option(shown)
        expect(value).to_have_text(text)
    page.get_by_label("Change P5").click()
    page.get_by_role("dialog").get_by_role("textbox").fill("7")
    page.keyboard.press("Enter")
    expect(value).to_have_text("7.000")
    page.get_by_role("button", name="Delete P12322").click()
    expect(rows).to_have_count(2)
    page.wait_for_function(
        f"(rows) => JSON.stringify(({KEPT})()?.panels['watch-1'].params?.rows) === rows",
        arg='[{"id":"P5","format":"fixed"},{"id":"BIT516","format":"plain"}]',
    )
    again(page)
    expect(page.locator("[data-item=P5] .live")).to_have_text("7.000")
    expect(page.locator("[data-item=BIT516] .live")).to_have_text("off")


# --- status ---------------------------------------------------------------------------


def test_status_shows_each_part_of_the_setpoint_of_the_axes_of_the_machine(
    page: Page, served: Served
) -> None:
    page.evaluate("import('/js/bench/workspace.js').then((each) => each.openPane('status'))")
    table = page.locator("[data-pane=status] table")
    expect(table.locator("thead th")).to_have_text(["", "AXIS0 X", "AXIS1 Y", "AXIS2 Z"])
    keys = page.get_by_role("group", name="Which of them").get_by_role("button")
    expect(keys).to_have_text(["X", "Y", "Z", *map(str, range(3, 16))])
    expect(keys.nth(2)).to_have_attribute("title", "AXIS2 Z")
    expect(keys.nth(3)).to_have_attribute("title", "AXIS3")
    first = 12288 + 256  # of Y
    served.call(partial(write, parameter=first + 9, value=40))  # jog offset
    for place, value in ((8, 250), (8, 0)):  # gear offset
        served.call(partial(write, parameter=first + place, value=value))
        for parameter, shown in ((first + 8, value), (first + 9, 40), (first + 6, value + 40)):
            expect(table.locator(f"[data-item=P{parameter}]")).to_have_text(str(shown))
    served.call(partial(write, parameter=first + 9, value=0))
    enabled = table.locator("tr", has_text="Drive Enabled").locator("td.number")
    on = served.call(
        lambda station: bool(station.link.machine.card.read_bit("axis0.drive enabled"))
    )
    expect(enabled.first).to_have_text("on" if on else "off")


def test_another_panel_of_status_and_its_objects_are_kept_with_the_layout(page: Page) -> None:
    page.evaluate("import('/js/bench/workspace.js').then((each) => each.openPane('status'))")
    page.get_by_label("What is shown").select_option("Masters")
    heads = page.locator("[data-pane=status] thead th")
    expect(heads).to_have_text(["", *(f"MASTER{n}" for n in range(4))])
    which = page.get_by_role("group", name="Which of them")
    which.get_by_role("button", name="1", exact=True).click()
    which.get_by_role("button", name="7", exact=True).click()
    shown = ["", "MASTER0", "MASTER2", "MASTER3", "MASTER7"]
    expect(heads).to_have_text(shown)
    page.locator("[data-item=BIT516]").click()
    facts = page.locator("[data-pane=status] .tree-facts")
    expect(facts).to_contain_text("BIT516 MASTER0 In Motion")
    expect(facts.get_by_role("button", name="CHANGE")).to_be_disabled()
    again(page)
    expect(heads).to_have_text(shown)
    panels = page.get_by_label("What is shown").locator("option").all_inner_texts()
    for panel in panels:
        page.get_by_label("What is shown").select_option(panel)
        expect(page.locator("[data-pane=status] [data-item] .live").first).not_to_have_text(
            "\u2013"
        )
    assert panels[-1] == "CANopen nodes"


def test_the_panel_of_status_that_was_chosen_last_is_shown(page: Page) -> None:
    """However late the answer to the choice before comes."""
    held: list[Route] = []
    asked = "**/api/card/panel?*"
    page.route(asked, lambda route: route.continue_() if held else held.append(route))
    with page.expect_request(asked):
        page.evaluate(
            "void import('/js/bench/workspace.js').then((each) => each.openPane('status'))"
        )
    page.get_by_label("What is shown").select_option("Masters")
    heads = page.locator("[data-pane=status] thead th")
    masters = ["", *(f"MASTER{n}" for n in range(4))]
    expect(heads).to_have_text(masters)
    let_through(page, held[0])
    expect(heads).to_have_text(masters)
    expect(page.get_by_label("What is shown").locator("option:checked")).to_have_text("Masters")
    page.unroute(asked)


def test_the_workspace_is_shown_in_german(page: Page) -> None:
    """The last one: the page stays German."""
    page.evaluate("localStorage.setItem('openacr.panel.language', 'de')")
    again(page)
    expect(page.get_by_role("button", name="FENSTER", exact=True)).to_be_visible()
    expect(page.locator(".dv-tab", has_text="ALARME")).to_be_visible()
    page.set_viewport_size({"width": 800, "height": 600})
    assert left_over(page, MISFITS) == []
