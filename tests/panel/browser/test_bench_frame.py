"""The frame of the engineer's workspace for a mouse: three jobs, shortcuts, search."""

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Locator, Page, expect
from tests.panel.bench import Served
from tests.panel.browser.conftest import open_page, until, until_model
from tests.panel.browser.test_screens import AXE, AXE_COLORS, AXE_RUN

from openacr.sysvar import password

JOBS = {
    "PROGRAM": ["Programs", "PLC", "Editor", "Variables", "Watch list", "Terminal", "Values",
                "ALARMS"],
    "TUNE": ["Jog", "Watch list", "ALARMS", "Gains", "Servo loop", "Tuning", "Scope"],
    "WATCH": ["Status", "Values", "Watch list", "I/O", "ALARMS", "Scope", "Servo loop", "Timeline",
              "PLC"],
}  # fmt: skip
SIZES = ((1366, 768), (1920, 1080))
FORGET = """() => import('/js/bench/workspace.js').then(async ({ arrange, chooseJob }) => {
  localStorage.clear();
  await chooseJob('program');
  localStorage.clear();
  arrange(null);
})"""


@pytest.fixture(scope="module")
def desk(browser: Browser, served: Served) -> Iterator[Page]:
    """The workspace on a desk: a mouse, no touch screen."""
    context = browser.new_context(viewport={"width": 1366, "height": 768})
    yield open_page(context, f"{served.url}/bench")
    context.close()


@pytest.fixture
def page(desk: Page) -> Page:
    """The first layout of PROGRAM, with no dialog open."""
    while desk.get_by_role("dialog").count():
        desk.keyboard.press("Escape")
    desk.set_viewport_size({"width": 1366, "height": 768})
    desk.evaluate(FORGET)
    expect(panes(desk)).to_have_text(JOBS["PROGRAM"])
    return desk


def panes(page: Page) -> Locator:
    return page.locator(".bench-tab-text")


def job(page: Page, name: str) -> Locator:
    return page.get_by_role("group", name="Layouts for three jobs").get_by_role("button", name=name)


# --- jobs -----------------------------------------------------------------------------


def test_each_job_has_a_first_layout_chosen_by_its_key_or_shortcut(page: Page) -> None:
    for n, (name, shown) in enumerate(JOBS.items(), 1):
        job(page, name).click()
        expect(panes(page)).to_have_text(shown)
        expect(job(page, name)).to_have_attribute("aria-pressed", "true")
        expect(page.locator(".jobs [aria-pressed=true]")).to_have_count(1)
        page.keyboard.press("Control+Alt+1" if n > 1 else "Control+Alt+3")
        expect(panes(page)).to_have_text(JOBS["PROGRAM" if n > 1 else "WATCH"])
        page.keyboard.press(f"Control+Alt+{n}")
        expect(panes(page)).to_have_text(shown)


def test_a_job_is_left_as_it_is_and_first_layout_is_its_own(page: Page) -> None:
    job(page, "TUNE").click()
    page.locator(".dv-tab", has_text="Gains").locator(".bench-close").click()
    without = [name for name in JOBS["TUNE"] if name != "Gains"]
    expect(panes(page)).to_have_text(without)
    job(page, "WATCH").click()
    expect(panes(page)).to_have_text(JOBS["WATCH"])
    job(page, "TUNE").click()
    expect(panes(page)).to_have_text(without)
    page.reload()
    page.wait_for_selector("body:not(.is-stale) #menu .menu-key")
    until_model(page, "model.hello.value.client")
    expect(panes(page)).to_have_text(without)
    page.get_by_role("button", name="LAYOUTS").click()
    page.get_by_role("button", name="FIRST LAYOUT").click()
    expect(panes(page)).to_have_text(JOBS["TUNE"])


def test_a_pane_of_both_jobs_goes_on_and_one_with_changes_may_stay(page: Page) -> None:
    job(page, "TUNE").click()
    page.locator(".bench-tab-text", has_text="Scope").click()
    page.wait_for_selector("[data-pane=scope] .u-over")
    page.evaluate("document.querySelector('[data-pane=scope]').isTheOne = true")
    job(page, "WATCH").click()
    expect(panes(page)).to_have_text(JOBS["WATCH"])
    assert page.evaluate("document.querySelector('[data-pane=scope]').isTheOne")
    job(page, "PROGRAM").click()
    page.locator("[data-pane=editor] .cm-content").click()
    page.keyboard.type("PROG1")
    job(page, "TUNE").click()
    page.get_by_role("dialog").get_by_role("button", name="CANCEL").click()
    expect(panes(page)).to_have_text(JOBS["PROGRAM"])
    expect(page.locator("[data-pane=editor] .cm-content")).to_contain_text("PROG1")
    job(page, "TUNE").click()
    page.get_by_role("dialog").get_by_role("button", name="DROP").click()
    expect(panes(page)).to_have_text(JOBS["TUNE"])


def share(page: Page, part: str, whole: str) -> float:
    """What part of the area of an element another one has."""
    boxes = [page.locator(each).first.bounding_box() for each in (part, whole)]
    areas = [box["width"] * box["height"] if box else 0.0 for box in boxes]
    return areas[0] / areas[1] if areas[1] else 0.0


@pytest.mark.parametrize(("width", "height"), SIZES)
def test_the_editor_has_twenty_lines_and_the_plot_half_of_its_pane(
    page: Page, width: int, height: int
) -> None:
    page.set_viewport_size({"width": width, "height": height})
    editor = page.locator("[data-pane=editor]")
    lines = (editor.locator(".cm-scroller"), editor.locator(".cm-line").first)

    def is_large() -> bool:
        text, line = (each.bounding_box() for each in lines)
        return bool(text and line and text["height"] >= 20 * line["height"])

    until(page, is_large)
    for name in ("TUNE", "WATCH"):
        job(page, name).click()
        page.locator(".bench-tab-text", has_text="Scope").click()
        until(page, lambda: share(page, "[data-pane=scope] .uplot", "[data-pane=scope]") >= 0.5)


def test_the_editor_and_the_scope_open_in_the_largest_place(page: Page) -> None:
    page.locator(".bench-tab-text", has_text="ALARMS").click()
    page.evaluate("import('/js/bench/workspace.js').then((each) => each.openPane('scope'))")
    beside = page.locator(".dv-groupview", has=page.locator(".bench-tab-text", has_text="Editor"))
    expect(beside.locator(".bench-tab-text")).to_have_text(["Editor", "Scope"])


def test_the_first_load_is_at_most_450_kilobytes(browser: Browser, served: Served) -> None:
    context = browser.new_context(viewport={"width": 1366, "height": 768})
    sizes: list[int] = []
    page = context.new_page()
    page.on("requestfinished", lambda each: sizes.append(each.sizes()["responseBodySize"]))
    page.goto(f"{served.url}/bench")
    page.wait_for_selector("[data-pane=editor] .cm-line")
    page.wait_for_selector("[data-pane=terminal] .xterm-rows")
    page.wait_for_load_state("networkidle")
    assert len(sizes) > 50
    assert sum(sizes) <= 450_000
    context.close()


# --- shortcuts ------------------------------------------------------------------------


def test_the_list_of_shortcuts_has_each_key_of_the_table_and_opens_by_f1_and_question_mark(
    page: Page,
) -> None:
    rows = page.evaluate(
        "import('/js/bench/actions.js')"
        ".then(({ ACTIONS }) => Object.values(ACTIONS).map((each) => each.keys))"
    )
    assert len(rows) > 9
    page.locator("[data-pane=editor] .cm-content").click()
    page.keyboard.press("?")
    expect(page.get_by_role("dialog")).to_have_count(0)  # it is typed
    page.keyboard.press("Backspace")
    page.keyboard.press("F1")
    shown = page.get_by_role("dialog", name="SHORTCUTS")
    expect(shown.locator("kbd")).to_have_text([*rows, "Alt+1 \u2026 Alt+9", "Shift+F10", "Pause"])
    page.keyboard.press("Alt+P")  # not over a dialog
    expect(page.get_by_role("dialog")).to_have_count(1)
    page.keyboard.press("Escape")
    page.locator(".bench-tab-text", has_text="ALARMS").click()
    page.keyboard.press("?")
    expect(shown).to_be_visible()


def test_keys_show_their_shortcuts_and_one_that_types_a_sign_is_none(page: Page) -> None:
    expect(page.get_by_role("button", name="PANES")).to_have_attribute("title", "PANES (Alt+P)")
    expect(job(page, "TUNE")).to_have_attribute("aria-keyshortcuts", "Control+Alt+2")
    found = page.evaluate("""() => import('/js/bench/shown_keys.js').then(({ isPressed }) => {
      const event = (more) => new KeyboardEvent('keydown', { code: 'Digit2', ...more });
      const keys = 'Ctrl+Alt+2';
      const both = { ctrlKey: true, altKey: true };
      return [both, { ...both, modifierAltGraph: true }, { altKey: true },
        { ...both, shiftKey: true }, { ...both, metaKey: true }]
        .map((each) => isPressed(event(each), keys));
    })""")
    assert found == [True, False, False, False, False]


# --- search ---------------------------------------------------------------------------


def search(page: Page, typed: str) -> Locator:
    """What the search finds, once it has more than a moment ago."""
    page.keyboard.press("Control+K")
    field = page.get_by_role("combobox", name="Pane, command, parameter")
    expect(field).to_be_focused()
    page.keyboard.type(typed)
    return page.get_by_role("listbox", name="What is found").get_by_role("option")


def title(name: str) -> re.Pattern[str]:
    return re.compile(rf"^{re.escape(name)}")


def test_the_search_opens_a_pane_in_the_editor_and_by_its_key(page: Page) -> None:
    page.locator("[data-pane=editor] .cm-content").click()
    expect(search(page, "gains").first).to_have_text(title("Gains"))
    page.keyboard.press("Enter")
    expect(page.get_by_role("dialog")).to_have_count(0)
    expect(page.locator("[data-pane=gain] .gain-row").first).to_be_visible()
    page.get_by_role("button", name="SEARCH").click()
    expect(page.get_by_role("combobox", name="Pane, command")).to_be_focused()


def test_the_search_does_with_a_value_what_its_key_says(page: Page) -> None:
    found = search(page, "axis1 act pos")
    expect(found.first).to_have_text(title("AXIS1 Actual Position"))
    page.keyboard.press("Enter")
    expect(page.locator("[data-pane=watch] [data-item=P12546]")).to_be_visible()
    expect(search(page, "bit516").first).to_have_text(title("MASTER0 In Motion"))
    page.keyboard.press("Control+Enter")
    expect(page.get_by_label("CH4 source")).to_have_value("BIT516")
    expect(search(page, "12290").first).to_have_text(title("AXIS0 Actual Position"))
    page.keyboard.press("Shift+Enter")
    expect(page.get_by_label("Parameters to compare")).to_have_value("P12290")
    expect(search(page, "p12547").first).to_have_text(title("AXIS1 Following Error"))
    found.first.get_by_text("show in Values").click()
    expect(page.locator("[data-pane=tree] [data-key=P12547]")).to_be_visible()


def test_arrow_keys_choose_among_what_is_found_and_are_heard(page: Page) -> None:
    found = search(page, "act pos")
    expect(found.nth(1)).to_have_text(title("AXIS1 Actual Position"))
    field = page.get_by_role("combobox", name="Pane, command, parameter")
    for key, n in (("ArrowDown", 1), ("ArrowDown", 2), ("ArrowUp", 1), ("ArrowUp", 0)):
        page.keyboard.press(key)
        expect(found.nth(n)).to_have_attribute("aria-selected", "true")
        expect(page.locator(".palette-entry[aria-selected=true]")).to_have_count(1)
        expect(field).to_have_attribute("aria-activedescendant", f"palette-{n}")
    page.keyboard.press("ArrowUp")
    expect(found.last).to_have_attribute("aria-selected", "true")
    page.keyboard.press("Escape")
    page.evaluate(AXE.read_text(encoding="utf-8"))
    expect(search(page, "act pos").first).to_have_text(title("AXIS0 Actual Position"))
    assert page.evaluate(AXE_RUN, "dialog") == []


def test_a_line_of_a_program_is_found_and_the_editor_shows_it(page: Page) -> None:
    found = search(page, ":lv0 = p96")
    expect(found).to_have_text([title("LV0 = P96")])
    expect(found.first).to_contain_text("PROG7 50")
    page.keyboard.press("Enter")
    active = page.locator("[data-pane=editor] .cm-activeLine")
    expect(active).to_contain_text("LV0 = P96")


def test_where_a_number_is_used_is_found_however_it_is_written(page: Page) -> None:
    expect(search(page, ":BIT520").first).to_have_text(title("SET 520"))
    page.keyboard.press("Escape")
    found = search(page, ":P98")
    expect(found.first).to_contain_text("P98")
    texts = found.locator(".palette-title").all_inner_texts()
    assert all(re.search(r"P98\b", text) for text in texts)


def test_a_command_is_given_with_its_arguments_and_one_of_keys_is_not_offered(
    page: Page, served: Served
) -> None:
    expect(search(page, ">card.write").first).to_contain_text("card.write")
    page.keyboard.press("Enter")
    dialog = page.get_by_role("dialog", name="card.write")
    dialog.get_by_label("parameter").fill("5")
    dialog.get_by_label("value").fill("-2,5")
    page.keyboard.press("Enter")
    expect(page.locator("#prompt")).to_have_text("card.write was carried out")
    assert served.call(lambda station: float(station.link.machine.card.read(5))) == -2.5
    expect(search(page, ">card.write").first).to_contain_text("card.write")
    page.keyboard.press("Enter")
    dialog.get_by_label("parameter").fill("x")
    page.keyboard.press("Enter")
    expect(page.locator("#prompt")).to_contain_text("card.write: Expected `int`, got `str`")
    expect(search(page, ">jog.")).to_have_text([title("Jog"), title("jog.stop")])


def test_an_entry_says_which_role_it_needs_and_asks_for_it(
    browser: Browser, tmp_path: Path
) -> None:
    served = Served(tmp_path)
    password.change(served.panel.installation.store, "deep secret")
    context = browser.new_context(viewport={"width": 1366, "height": 768})
    try:
        page = open_page(context, f"{served.url}/bench")
        found = search(page, ">tuning").first
        expect(found).to_contain_text("This needs the role service: log in")
        page.keyboard.press("Enter")
        page.get_by_role("dialog").get_by_label("Password").fill("deep secret")
        page.keyboard.press("Enter")
        expect(page.locator("[data-pane=tune] .tune")).to_be_visible()
        expect(search(page, ">tuning").first).not_to_contain_text("This needs")
    finally:
        context.close()
        served.close()


# --- names ----------------------------------------------------------------------------


def drag(page: Page, what: Locator, to: Locator, *, drop: bool = True) -> None:
    """Drag with the mouse from the middle of one element to that of another."""
    what.scroll_into_view_if_needed()
    places = [each.bounding_box() for each in (what, to)]
    middles = [(box["x"] + box["width"] / 2, box["y"] + 20) for box in places if box]
    page.mouse.move(*middles[0])
    page.mouse.down()
    page.mouse.move(middles[0][0] + 10, middles[0][1])
    page.mouse.move(*middles[1])
    if drop:
        page.mouse.up()


def test_a_name_is_dragged_from_status_into_watch_list_scope_and_timeline(page: Page) -> None:
    job(page, "WATCH").click()
    cell = page.locator("[data-pane=status] [data-item=P12290]")
    expect(cell).to_be_visible()
    drag(page, cell, page.locator("[data-pane=watch]"))
    expect(page.locator("[data-pane=watch] [data-item=P12290]")).to_be_visible()
    page.wait_for_selector("[data-pane=scope] .u-over")
    page.wait_for_selector("[data-pane=timeline] .time-lanes")
    drag(page, page.locator("[data-pane=watch] tr[data-item=P12290]"),
         page.locator("[data-pane=timeline]"))  # fmt: skip
    expect(page.get_by_label("Parameters to compare")).to_have_value("P12290")
    other = page.locator("[data-pane=status] [data-item=P12546]")
    drag(page, other, page.locator("[data-pane=scope]"))
    expect(page.get_by_label("CH4 source")).to_have_value("P12546")
    expect(page.locator("#prompt")).to_have_text("P12546 is CH4")
    drag(page, other, page.locator(".dv-tab", has_text="Timeline"))
    expect(page.get_by_label("Parameters to compare")).to_have_value("P12290, P12546")


def test_a_drag_that_is_given_up_or_ends_elsewhere_changes_nothing(page: Page) -> None:
    job(page, "WATCH").click()
    cell = page.locator("[data-pane=status] [data-item=P12290]")
    watch = page.locator("[data-pane=watch]")
    drag(page, cell, watch, drop=False)
    expect(page.locator(".name-ghost")).to_have_text("P12290")
    expect(page.locator(".name-ghost")).to_have_class(re.compile("is-taken"))
    page.keyboard.press("Escape")
    expect(page.locator(".name-ghost")).to_have_count(0)
    page.mouse.up()
    drag(page, cell, page.locator("#prompt"))
    expect(page.locator(".name-ghost")).to_have_count(0)
    cell.click()  # without a move it is a click
    expect(page.locator("[data-pane=status] .tree-facts")).to_contain_text("P12290")
    expect(watch.locator("[data-item]")).to_have_count(0)


def test_a_name_of_the_keyboard_has_the_menu_also_in_the_tree_and_among_inputs(page: Page) -> None:
    job(page, "WATCH").click()
    menu = page.get_by_role("menu")
    page.locator("[data-pane=status] [data-item=P12546]").focus()
    page.keyboard.press("Shift+F10")
    expect(menu.get_by_role("menuitem")).to_have_text(
        ["watch", "scope", "compare", "show in Values", "where used"]
    )
    page.keyboard.press("ArrowUp")
    expect(menu.get_by_role("menuitem", name="where used")).to_be_focused()
    page.keyboard.press("ArrowDown")
    page.keyboard.press("ArrowDown")
    page.keyboard.press("Enter")
    expect(page.get_by_label("CH4 source")).to_have_value("P12546")
    page.locator("[data-pane=status] [data-item=P12546]").focus()
    page.keyboard.press("Shift+F10")
    page.keyboard.press("Escape")
    expect(menu).to_have_count(0)
    expect(page.locator("[data-pane=status] [data-item=P12546]")).to_be_focused()
    page.locator(".bench-tab-text", has_text="I/O").click()
    page.locator("[data-pane=io] [data-item=BIT0]").focus()
    page.keyboard.press("ArrowDown")
    page.keyboard.press("Shift+F10")
    menu.get_by_role("menuitem", name="show in Values").click()
    expect(page.locator("[data-pane=tree] [data-item=BIT1]")).to_be_visible()
    tree = page.locator("[data-pane=tree] [role=tree]")
    tree.focus()
    while not tree.locator("[aria-selected=true][data-item]").count():
        page.keyboard.press("ArrowDown")
    page.keyboard.press("Shift+F10")
    expect(page.get_by_role("menu", name=re.compile(r"^(P|BIT)\d+$"))).to_be_visible()
    page.keyboard.press("Escape")


PLACE_OF = """(word) => {
  const texts = document.createTreeWalker(document.querySelector('[data-pane=programs]'), 4);
  while (!texts.nextNode().textContent.includes(word));
  const range = new Range();
  const at = texts.currentNode.textContent.indexOf(word);
  range.setStart(texts.currentNode, at);
  range.setEnd(texts.currentNode, at + word.length);
  const box = range.getBoundingClientRect();
  return [box.x + box.width / 2, box.y + box.height / 2];
}"""


def test_a_number_in_a_text_has_the_menu_and_where_used_lists_the_lines(page: Page) -> None:
    page.locator("[data-pane=programs] [data-name=PROG7]").click()
    line = page.locator("[data-pane=programs]").get_by_text("P6916").first
    expect(line).to_be_visible()
    found = page.evaluate("""() => import('/js/bench/names.js').then(({ wordAt }) => [
      ...[3, 4, 9, 10, 12, 19].map((place) => wordAt('LET P6916 = BIT 516', place)),
      wordAt('PP1', 1)])""")
    assert found == ["", "P6916", "P6916", "", "BIT516", "BIT516", ""]
    page.evaluate("""() => import('/js/bench/names.js').then(({ actsOn }) =>
      { void actsOn('P6916').at(-1).does(); })""")
    entries = page.get_by_role("listbox", name="What is found").get_by_role("option")
    expect(entries).to_have_text([title("LV1 = P6916"), title("LV2 = P6916-LV1")])
    page.keyboard.press("Escape")
    x, y = page.evaluate(PLACE_OF, "P6916")
    page.mouse.click(x, y, button="right")
    page.get_by_role("menu", name="P6916").get_by_role("menuitem", name="watch").click()
    expect(page.locator("[data-pane=watch] [data-item=P6916]")).to_be_visible()


# --- accessibility --------------------------------------------------------------------

# Texts smaller than 12 pixels, also in shadow roots; those of pictures are scaled with them.
SMALL = """(pane) => {
  const found = [];
  const look = (root) => {
    for (const each of root.querySelectorAll('*')) {
      if (each.shadowRoot) look(each.shadowRoot);
      const isText = [...each.childNodes].some((one) => one.nodeType === 3 && one.textContent.trim());
      if (!isText || each instanceof SVGElement || !each.checkVisibility()) continue;
      const size = parseFloat(getComputedStyle(each).fontSize);
      if (size < 12) found.push(`${each.className || each.tagName} is ${size.toFixed(1)}: ${each.textContent.slice(0, 20)}`);
    }
  };
  look(document.querySelector(pane));
  return found;
}"""  # noqa: E501


@pytest.mark.timeout(300)
def test_every_pane_keeps_the_rules_of_accessibility_for_a_mouse_light_and_dark(page: Page) -> None:
    page.evaluate(AXE.read_text(encoding="utf-8"))
    names = page.evaluate("import('/js/bench/panes.js').then(({ PANES }) => Object.keys(PANES))")
    found: dict[str, list[str]] = {"frame": page.evaluate(SMALL, "body")}
    for name in names:
        page.evaluate(
            "(name) => import('/js/bench/workspace.js').then((each) => each.openPane(name))", name
        )
        pane = f"[data-pane={name}]"
        expect(page.locator(f"{pane} .pane-body > *").first).to_be_visible()
        for theme in ("light", "dark"):
            page.emulate_media(color_scheme="light" if theme == "light" else "dark")
            rules = AXE_RUN if theme == "light" else AXE_COLORS
            found[f"{name} {theme}"] = page.evaluate(rules, pane)
        found[f"{name} size"] = page.evaluate(SMALL, pane)
    assert {name: each for name, each in found.items() if each} == {}


def test_the_focus_is_seen_and_nothing_moves_where_that_is_not_wanted(page: Page) -> None:
    page.emulate_media(reduced_motion="reduce")
    job(page, "TUNE").focus()
    page.keyboard.press("Tab")  # by the keyboard
    style = "(each) => [getComputedStyle(each).outlineStyle, getComputedStyle(each).outlineWidth]"
    assert page.evaluate(f"({style})(document.activeElement)") == ["solid", "3px"]
    moving = page.evaluate("""() => [...document.querySelectorAll('*')].filter((each) => {
      const { transitionDuration, animationName } = getComputedStyle(each);
      return animationName !== 'none' || !/^(0s(, )?)+$/.test(transitionDuration);
    }).map((each) => each.className)""")
    assert moving == []
    page.emulate_media(reduced_motion="no-preference")


def test_keys_of_the_field_have_their_symbol_and_keep_their_text_as_their_name(
    page: Page, served: Served
) -> None:
    def symbol(key: Locator) -> Locator:
        return key.locator("svg[aria-hidden=true]")

    def until_text(key: Locator, is_seen: bool) -> None:
        until(page, lambda: (wide_of_text(key) > 10) is is_seen)

    def wide_of_text(key: Locator) -> float:
        return float(key.locator(".key-text").evaluate("(text) => text.offsetWidth"))

    programs = page.locator("[data-pane=programs]")
    run = programs.get_by_role("button", name="RUN", exact=True)
    expect(symbol(run)).to_have_attribute("data-symbol", "run")
    until_text(run, True)
    expect(programs.get_by_role("button", name="EDIT", exact=True).locator("svg")).to_have_count(0)
    editor = page.locator("[data-pane=editor]")
    send = editor.locator(".pane-head").get_by_role("button", name="DOWNLOAD")
    expect(symbol(send)).to_have_attribute("data-symbol", "download")
    for wide, is_text_seen in ((641, True), (640, False)):  # of the pane
        editor.evaluate("(pane, wide) => { pane.style.width = `${wide}px`; }", wide)
        until_text(send, is_text_seen)
        expect(send).to_have_attribute("title", "DOWNLOAD")
    page.evaluate("import('/js/bench/workspace.js').then((each) => each.openPane('tune'))")
    step = page.locator("[data-pane=tune]").get_by_role("button", name="STEP", exact=True)
    expect(step).to_be_visible()
    expect(step.locator("svg")).to_have_count(0)  # a step of the position, no line of a program
    operator = open_page(page.context, served.url)
    expect(operator.locator(".key").first).to_be_visible()
    expect(operator.locator(".key-symbol")).to_have_count(0)
    operator.close()
