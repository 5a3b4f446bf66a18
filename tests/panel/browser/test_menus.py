"""Every menu of the guide with its keys; each key by keyboard, by mouse and by touch."""

import re
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from playwright.sync_api import BrowserContext, Page, Route, expect
from tests.panel.bench import Served
from tests.panel.browser.conftest import (
    READY,
    give,
    hold_answers,
    left_over,
    let_through,
    open_page,
    release_answers,
    until,
    until_model,
)

# Menu: key, label, what it does: another menu, a screen, a dialog, or a command that is sent.
MENUS: dict[str, list[tuple[int, str, str]]] = {
    "main": [
        (1, "HOME", "screen home"), (2, "CLR ZERO", "dialog Clear zero"),
        (3, "SET ZERO", "screen zero"), (4, "EDIT", "screen edit"), (5, "RUN SETUP", "menu setup"),
        (6, "RUN PROG", "menu run"), (7, "MANUAL", "menu manual"), (8, "SET/DIAG", "menu diag"),
        (9, "HELP", "screen help"), (10, "EXIT", "dialog EXIT"),
    ],
    "setup": [
        (1, "CMP RAD", "form CMPRAD"), (3, "LOAD PROG", "screen load"),
        (4, "FEEDRATE", "form FEEDRATE"), (6, "P PARM", "screen pparm"),
        (7, "SET MODALS", "form MODALS"), (10, "MAIN MENU", "menu main"),
    ],
    "run": [
        (1, "STOP", "sent stop.hold"), (2, "START", "dialog RUN"), (3, "RUN", "dialog RUN"),
        (4, "DRY RUN", "dialog DRY RUN"), (5, "FEEDRATE", "form FEEDRATE"),
        (6, "OVERRIDES", "screen overrides"), (7, "BLOCK", "sent run.block"),
        (8, "SET ZERO", "screen zero"), (9, "EDIT", "dialog OPEN"), (10, "MAIN MENU", "menu main"),
    ],
    "stop": [
        (1, "ABORT", "sent run.abort"), (3, "BACK", "sent run.trace"),
        (4, "HALT", "sent run.trace"), (5, "FORWARD", "sent run.trace"), (6, "JOG", "screen jog"),
        (8, "RESUME", "sent run.resume"), (10, "MAIN MENU", "menu main"),
    ],
    "manual": [
        (1, "MDI", "screen mdi"), (2, "JOG", "screen jog"), (3, "HANDWHEEL", "screen handwheel"),
        (4, "TEACH", "screen teach"), (8, "GOTO ZERO", "dialog Go to zero"),
        (10, "MAIN MENU", "menu main"),
    ],
    "diag": [
        (1, "SYS PARAM", "screen parameters"), (2, "P PARM", "screen pparm"),
        (3, "OFFSETS", "screen offsets"), (4, "WORK COORD", "form WORK"),
        (5, "DIAGNOSTICS", "menu diagnostics"), (6, "PROG/PLC", "screen programs"),
        (7, "DISPLAY", "menu display"),
        (10, "MAIN MENU", "menu main"),
    ],
    "diagnostics": [
        (1, "I/O STATUS", "screen io"), (2, "TERMINAL", "screen terminal"),
        (3, "SCOPE", "screen scope"), (4, "GAIN", "screen gain"),
        (5, "BOARD PARAM", "screen board"), (6, "SERVO LOOP", "screen servo"),
        (7, "CPU LOAD", "screen cpu"), (8, "FAST STATUS", "screen fast"),
        (9, "MEMORY CONFIG", "screen memory"), (10, "MAIN MENU", "menu main"),
    ],
    "display": [
        (1, "BUTTON PANEL", "form BUTTONS"), (2, "OVERRIDES", "screen overrides"),
        (3, "I/O NAMES", "form IONAMES"), (7, "RESIZE SCREEN", "appearance"),
        (8, "USER MESSAGES", "form MESSAGES"), (9, "SETUP SCREEN", "screen views"),
        (10, "MAIN MENU", "menu main"),
    ],
}  # fmt: skip

SHOW = "(name) => import('/js/frame/menu_bar.js').then(({ openMenu }) => openMenu(name))"
RECORD = """() => import('/js/core/app.js').then(({ link }) => {
  window.sent = [];
  const send = link.send.bind(link);
  link.send = (message) => {
    if (message.cmd) window.sent.push(message.cmd);
    return send(message);
  };
})"""
CLEAN = """(name) => import('/js/frame/screen_host.js').then(async ({ closeScreen }) => {
  while (document.querySelector('dialog[open]')) window.dispatchEvent(new KeyboardEvent('keydown', { key: 'Escape' }));
  await closeScreen();
  window.sent = [];
  (await import('/js/frame/menu_bar.js')).openMenu(name);
})"""  # noqa: E501
HAPPENED = """([kind, what, before]) => {
  const shown = (selector) => document.querySelector(selector);
  if (kind === 'menu') return shown('#menu').dataset.shown === what;
  if (kind === 'dialog') return shown('dialog[open] h2')?.textContent === what;
  if (kind === 'sent') return window.sent.includes(what);
  if (kind === 'form') return shown('#screen:not([hidden])[data-screen=form] .form-row [id^=cell]');
  if (kind === 'screen') return shown(`#screen:not([hidden])[data-screen=${what}] .screen-body > *`);
  return window.sent === undefined && shown('#display-tab-graphics')?.ariaSelected === 'true'
    && localStorage.getItem('openacr.panel.tab') !== 'plc';
}"""  # noqa: E501
BAR = """() => [...document.querySelectorAll('#menu .menu-key:not(.empty)')].map((key) =>
  [Number(key.dataset.fkey.slice(1)), key.querySelector('small').textContent, key.querySelector('span').textContent.replaceAll(/[\\u00ad\\u200b]/g, '')])"""  # noqa: E501


def plain(label: str) -> str:
    """A label without spaces and places where it may be broken."""
    return re.sub("[ \u00ad\u200b]", "", label)


def by_key(page: Page, key: int) -> None:
    page.keyboard.press(f"F{key}")


def by_mouse(page: Page, key: int) -> None:
    page.click(f"[data-fkey=F{key}]")


def by_finger(page: Page, key: int) -> None:
    page.tap(f"[data-fkey=F{key}]")


# What each press of a menu key by mouse or finger arrives at; it has no effect.
CAUGHT = """() => {
  window.caught = [];
  window.catching = (event) => {
    event.stopImmediatePropagation();
    window.caught.push([event.target.closest('[data-fkey]')?.dataset.fkey, event.pointerType]);
  };
  window.addEventListener('click', window.catching, { capture: true });
}"""
LET_GO = "() => window.removeEventListener('click', window.catching, { capture: true })"


@pytest.fixture
def recorded(page: Page) -> Iterator[Page]:
    """The workspace, with the commands that it sends."""
    page.evaluate(RECORD)
    yield page
    page.evaluate("import('/js/core/app.js').then(({ link }) => { delete link.send; })")


MENU_IDS = (
    "MILL-MENU-MAIN", "MILL-MENU-SETUP", "MILL-MENU-RUN", "MILL-MENU-STOP", "MILL-MENU-MANUAL",
    "MILL-MENU-MAIN-HOME", "MILL-MENU-MAIN-EDIT", "MILL-MENU-MAIN-RUNSETUP",
    "MILL-MENU-MAIN-RUNPROG", "MILL-MENU-MAIN-MANUAL", "MILL-MENU-MAIN-SETDIAG",
    "MILL-MENU-MAIN-HELP", "MILL-MENU-DIAG", "MILL-MENU-SETDIAG",
    "MILL-MENU-DISPLAY", "MILL-OV-INPUTDEV", "MILL-SCR-FKEY", "MILL-SCR-MENUBAR",
)  # fmt: skip


def does(
    page: Page, menu: str, press: Callable[[Page, int], None], number: int, effect: str
) -> None:
    """Press a key of a shown menu and wait for what it does, which is put back."""
    kind, _, what = effect.partition(" ")
    if kind == "appearance":
        page.evaluate("localStorage.setItem('openacr.panel.tab', 'plc')")
    press(page, number)
    page.wait_for_function(HAPPENED, arg=[kind, what, ""])
    if kind == "appearance":
        page.wait_for_function(READY)
        page.evaluate(RECORD)
    if kind == "form":
        form = page.request.get(f"{page.url}api/forms/{what}").json()
        expect(page.locator("#screen-title")).to_have_text(form["title"])
    if effect in ("screen edit", "dialog OPEN"):  # which asks for a file
        expect(page.get_by_role("dialog", name="OPEN")).to_be_visible()
        expect(page.locator("#screen")).to_have_attribute("data-screen", "edit")
    page.evaluate(CLEAN, menu)


@pytest.mark.req(*MENU_IDS)
def test_every_key_of_every_menu_does_what_the_guide_says(recorded: Page) -> None:
    page = recorded
    defined: dict[str, Any] = page.evaluate(
        "() => import('/js/frame/menus.js').then((module) => module.MENUS)"
    )
    assert set(defined) == set(MENUS)
    for menu, keys in MENUS.items():
        page.evaluate(SHOW, menu)
        bar = page.evaluate(BAR)
        assert [(n, plain(label)) for n, _, label in bar] == [(n, plain(x)) for n, x, _ in keys]
        assert [small for _, small, _ in bar] == [f"F{n}" for n, _, _ in keys]
        for number, _label, effect in keys:
            does(page, menu, by_key, number, effect)


@pytest.mark.req(*MENU_IDS)
@pytest.mark.parametrize(("press", "kind"), [(by_mouse, "mouse"), (by_finger, "touch")])
def test_mouse_and_finger_reach_every_key_of_every_menu_and_press_it(
    recorded: Page, press: Callable[[Page, int], None], kind: str
) -> None:
    """Two keys of each menu with their effect: what is done is the same by every device."""
    page = recorded
    for menu, keys in MENUS.items():
        page.evaluate(SHOW, menu)
        page.evaluate(CAUGHT)
        for number, _, _ in keys:
            press(page, number)
        page.evaluate(LET_GO)
        assert page.evaluate("window.caught") == [[f"F{number}", kind] for number, _, _ in keys]
        for number, _, effect in (keys[1], keys[-1]):
            does(page, menu, press, number, effect)


def test_an_editor_that_is_left_before_it_is_loaded_asks_for_no_file(
    context: BrowserContext, served: Served
) -> None:
    page = open_page(context, served.url)
    held: list[Route] = []
    page.route("**/js/edit/editor.js", lambda route: held.append(route))
    with page.expect_request("**/js/edit/editor.js"):
        page.keyboard.press("F4")
    page.keyboard.press("Escape")
    expect(page.locator("#screen")).to_be_hidden()
    until(page, lambda: held)
    held[0].continue_()
    page.evaluate("import('/js/edit/editor.js')")
    page.evaluate("() => new Promise((done) => setTimeout(done))")
    expect(page.get_by_role("dialog")).to_have_count(0)
    page.close()


def test_of_two_screens_the_one_that_was_asked_for_last_is_shown(
    context: BrowserContext, served: Served
) -> None:
    """Whichever of them is loaded first; a menu counts as none."""
    page = open_page(context, served.url)
    held: list[Route] = []
    page.route("**/js/screens/views.js", lambda route: held.append(route))
    page.evaluate(SHOW, "display")
    with page.expect_request("**/js/screens/views.js"):
        page.keyboard.press("F9")
    page.keyboard.press("F1")
    page.wait_for_function(HAPPENED, arg=["form", "BUTTONS", ""])
    until(page, lambda: held)
    held[0].continue_()
    page.evaluate("import('/js/screens/views.js')")  # is there, and what waited for it goes on
    page.evaluate("() => new Promise((done) => setTimeout(done))")
    assert page.locator("#screen").get_attribute("data-screen") == "form"
    page.route("**/js/screens/mdi.js", lambda route: held.append(route))
    page.evaluate(SHOW, "manual")
    with page.expect_request("**/js/screens/mdi.js"):
        page.keyboard.press("F1")
    page.keyboard.press("F10")
    until(page, lambda: held[1:])
    held[1].continue_()
    page.evaluate("import('/js/screens/mdi.js')")
    page.evaluate("() => new Promise((done) => setTimeout(done))")
    expect(page.locator("#screen")).to_be_hidden()
    assert page.locator("#menu").get_attribute("data-shown") == "main"
    page.close()


def test_a_list_that_is_drawn_anew_leaves_the_focus_where_it_was(page: Page) -> None:
    """The list of programs is drawn again when it is known what the project has."""
    held: list[Route] = []
    page.route("**/api/project", lambda route: held.append(route))
    page.evaluate(SHOW, "diag")
    page.keyboard.press("F6")
    chosen = page.locator("#screen [role=option][aria-selected=true]")
    expect(chosen).to_be_focused()
    until(page, lambda: held)
    page.keyboard.press("Tab")
    expect(chosen.locator("xpath=following-sibling::*[1]")).to_be_focused()
    page.evaluate("document.activeElement.isOld = true")
    let_through(page, held[0])
    page.wait_for_function("() => document.activeElement.matches('#screen [role=option]')")
    page.wait_for_function("() => !document.activeElement.isOld")
    expect(chosen.locator("xpath=following-sibling::*[1]")).to_be_focused()
    page.unroute("**/api/project")


def test_a_row_that_is_drawn_anew_before_its_state_is_known_keeps_the_focus(
    page: Page, served: Served
) -> None:
    page.evaluate(SHOW, "diagnostics")
    page.keyboard.press("F1")
    row = page.locator("#screen [data-bit='0']")
    expect(row).to_be_focused()
    expect(row).to_contain_text("off")
    page.evaluate("document.activeElement.isOld = true")
    page.evaluate("""import('/js/core/app.js').then(({ model }) => {
      model.changed.set({ what: 'forms', cells: [] });
    })""")
    page.wait_for_function("() => !document.querySelector('#screen [data-bit]').isOld")
    expect(row).to_be_focused()


def test_a_late_answer_to_abort_leaves_the_menu_that_was_chosen_meanwhile(page: Page) -> None:
    page.evaluate(SHOW, "stop")
    hold_answers(page)
    page.keyboard.press("F1")
    page.keyboard.press("F10")
    page.keyboard.press("F7")
    release_answers(page, "each.ok = true, each.result = {}")
    assert page.locator("#menu").get_attribute("data-shown") == "manual"
    page.evaluate(SHOW, "stop")
    hold_answers(page)
    page.keyboard.press("F1")
    release_answers(page, "each.ok = true, each.result = {}")
    assert page.locator("#menu").get_attribute("data-shown") == "run"


@pytest.mark.req("MILL-OV-MENUDEPTH")
def test_no_menu_is_deeper_than_two_levels_and_each_leads_back_to_main(page: Page) -> None:
    """The menu of a held program is an overlay of RUN PROG, not a level."""
    menus: dict[str, list[dict[str, Any]]] = page.evaluate(
        "() => import('/js/frame/menus.js').then((module) => module.MENUS)"
    )
    depth, level, names = {"main": 0}, 0, {"main"}
    while names:
        level += 1
        names = {key["menu"] for name in names for key in menus[name] if "menu" in key} - set(depth)
        depth.update(dict.fromkeys(names, level))
    assert depth == {
        "main": 0, "setup": 1, "run": 1, "manual": 1, "diag": 1, "diagnostics": 2, "display": 2
    }  # fmt: skip
    assert set(menus) - set(depth) == {"stop"}
    for name, keys in menus.items():
        if name != "main":
            assert [key["menu"] for key in keys if key["key"] == 10] == ["main"]


# Keys of the menu that are no place for a finger or outside, and parts that overlap or are outside.
CRAMPED = """() => {
  const box = (each) => each.getBoundingClientRect();
  const places = ['#status', '#display', '#prompt', '#menu', '#stop'].map((name) => document.querySelector(name));
  const keys = [...document.querySelectorAll('#menu .menu-key:not(.empty)')];
  const outside = [...places, ...keys].filter((each) => box(each).x < 0 || box(each).y < 0 || box(each).right > 800 || box(each).bottom > 600);
  const small = keys.filter((each) => box(each).width < 44 || box(each).height < 44);
  const [status, display, prompt, menu] = places.map(box);
  const { scrollWidth, scrollHeight } = document.documentElement;
  return [
    ...outside.map((each) => `${each.id || each.textContent} is outside`), ...small.map((each) => `${each.textContent} is small`),
    ...(keys.length ? [] : ['no keys']), ...(scrollWidth === 800 && scrollHeight === 600 ? [] : [`${scrollWidth} x ${scrollHeight}`]),
    ...(status.right <= display.x && display.bottom <= prompt.y && prompt.bottom <= menu.y ? [] : ['parts overlap']),
  ];
}"""  # noqa: E501


@pytest.mark.req("MILL-OV-TOUCH", "MILL-OV-800X600", "MILL-SCR-MAIN")
def test_the_main_screen_with_every_menu_fits_800_x_600_with_keys_for_fingers(page: Page) -> None:
    page.set_viewport_size({"width": 800, "height": 600})
    for name in MENUS:
        page.evaluate(SHOW, name)
        assert left_over(page, CRAMPED) == []
    expect(page.locator("#status [role=tab]")).to_have_text(["VIEW 1", "VIEW 2", "VIEW 3"])
    expect(page.locator("#display [role=tab]")).to_have_text(
        ["GRAPHICS", "PROGRAM", "I/O STATUS", "PLC", "ALARMS"]
    )
    page.set_viewport_size({"width": 1024, "height": 768})


# The help text of every key in the list.
HELP = """async () => {
  const text = document.querySelector('.help-text');
  const title = async () => { while (!text.querySelector('h2')) await new Promise((done) => setTimeout(done, 5)); };
  const found = {};
  for (const item of document.querySelectorAll('#screen .form-tabs .item')) {
    await title();
    text.replaceChildren();
    item.click();
    await title();
    found[item.querySelector('.name').textContent] = text.innerText;
  }
  return found;
}"""  # noqa: E501


@pytest.mark.req("MILL-MENU-HELP-TEXT")
def test_help_has_a_text_for_every_key_of_every_menu(page: Page) -> None:
    page.keyboard.press("F9")
    expect(page.locator("#screen .form-tabs .item").first).to_be_visible()
    shown = {plain(name): text for name, text in page.evaluate(HELP).items()}
    labels = {plain(label) for keys in MENUS.values() for _, label, _ in keys}
    assert labels - set(shown) == {"MAINMENU"}
    assert {name for name, text in shown.items() if len(text) < 40} == set()


def test_a_help_page_that_is_missing_is_said(page: Page) -> None:
    assert page.request.get(page.url + "api/help/nothing").status == 404


@pytest.mark.req("MILL-MENU-EXIT-SAFE")
def test_exit_while_a_program_runs_asks_and_brings_the_machine_to_rest(
    page: Page, served: Served
) -> None:
    until_model(page, "!model.state.value.busy")
    assert give(page, "mdi.execute", line="G21 G91 G1 X50 F60") is not None
    until_model(page, "model.state.value.busy")
    page.keyboard.press("F10")
    dialog = page.get_by_role("dialog", name="EXIT")
    expect(dialog.locator("p")).to_have_text(
        "The machine is working. It is stopped first: the program ends, the axes come to rest."
    )
    dialog.get_by_role("button", name="CANCEL").click()
    assert served.call(lambda station: station.link.machine.runner.is_busy)
    page.keyboard.press("F10")
    dialog.get_by_role("button", name="LEAVE").click()
    expect(page.locator("main.left")).to_contain_text("The controller program is still running.")
    assert not served.call(lambda station: station.link.machine.runner.is_busy)
    place = served.call(lambda station: station.link.machine.runner.stream.host.position()[0])
    assert 0.0 < place < 50.0
    page.get_by_role("button", name="COME BACK").click()
    page.wait_for_function(READY)


def test_a_screen_that_only_watches_leaves_without_stopping_the_machine(
    page: Page, served: Served, context: BrowserContext
) -> None:
    give(page, "mdi.execute", line="G21 G91 G1 X-20 F60")
    other = open_page(context, served.url)
    other.keyboard.press("F10")
    dialog = other.get_by_role("dialog", name="EXIT")
    expect(dialog.locator("p")).to_have_text(
        "Leave the screens? The controller program keeps running."
    )
    assert dialog.get_by_role("button").all_inner_texts() == ["CANCEL", "LEAVE"]
    dialog.get_by_role("button", name="LEAVE").click()
    expect(other.locator("main.left")).to_be_visible()
    assert served.call(lambda station: station.link.machine.runner.is_busy)
    other.close()
    give(page, "stop.all")
    until_model(page, "!model.state.value.busy")


@pytest.mark.req("MILL-MENU-MAIN-EXIT")
def test_exit_ends_the_application(
    context: BrowserContext, tmp_path_factory: pytest.TempPathFactory
) -> None:
    own = Served(tmp_path_factory.mktemp("exit"))
    try:
        page = open_page(context, own.url)
        page.keyboard.press("F10")
        page.get_by_role("dialog", name="EXIT").get_by_role("button", name="END").click()
        expect(page.locator("main.left")).to_have_text(re.compile("AcroMill has ended."))
        page.close()
        own.wait_until_ended()
    finally:
        own.close()
