"""Every screen opens by keyboard and by mouse, in every size, light and dark, accessible."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import BrowserContext, Page, expect
from tests.panel.bench import Served
from tests.panel.browser.conftest import READY, left_over, open_page, picture, to_main_menu

AXE = Path(__file__).parent / "axe" / "axe.min.js"
SIZES = ((800, 600), (1920, 1080), (1024, 768))  # the last one is that of the other tests
LEAST_PX = 44

MENUS = "() => import('/js/frame/menus.js').then((module) => module.MENUS)"
# Boxes that reach out of the window, keys whose text is cut off, keys too small for a finger.
MISFITS = """() => {
  const found = [];
  const [wide, high] = [innerWidth, innerHeight];
  const root = document.documentElement;
  if (root.scrollWidth > wide || root.scrollHeight > high) found.push(`the page scrolls: ${root.scrollWidth} x ${root.scrollHeight}`);
  for (const key of document.querySelectorAll('button, select, input')) {
    const box = key.getBoundingClientRect();
    if (!box.width || getComputedStyle(key).visibility !== 'visible' || key.closest('[inert]')) continue;
    const name = (key.textContent || key.ariaLabel || key.id || key.type).trim().slice(0, 24);
    const scrolls = key.closest('.scroll, .tab-panel, .screen-body, .dialog-body');
    if (!scrolls && (box.right > wide + 1 || box.bottom > high + 1)) found.push(`${name} is outside`);
    if (key.matches('button') && key.scrollWidth > key.clientWidth + 1) found.push(`${name} is cut off`);
    const isBox = key.matches('[type=checkbox], [type=radio]');
    if (!isBox && (Math.round(box.width) < LEAST || Math.round(box.height) < LEAST) && !key.matches('FREE')) found.push(`${name} is ${Math.round(box.width)} x ${Math.round(box.height)}`);
  }
  return found;
}""".replace("LEAST", str(LEAST_PX)).replace("FREE", ".findings .item, .time-names *")  # noqa: E501

SHOW = "(name) => import('/js/frame/menu_bar.js').then(({ openMenu }) => openMenu(name))"
OPEN = "(name) => import('/js/frame/screen_host.js').then(({ openScreen }) => openScreen(name))"

# Of the page, or of some places in it. The editor is left out: its text has the focus, which axe
# does not see in a shadow root.
AXE_RUN = """(places) => axe.run({ include: [...document.querySelectorAll(places ?? 'html')], exclude: ['.editor'] }, { runOnly: ['wcag2a', 'wcag2aa', 'wcag21aa'], resultTypes: ['violations'], preload: false }).then((result) =>
  result.violations.map((each) => `${each.id}: ${each.nodes.map((node) => node.target.join(' ')).slice(0, 3).join(', ')}`))"""  # noqa: E501
AXE_COLORS = AXE_RUN.replace(
    "['wcag2a', 'wcag2aa', 'wcag21aa']",
    "{ type: 'rule', values: ['color-contrast', 'link-in-text-block'] }",
)


def keys_of(page: Page) -> list[tuple[str, dict[str, Any]]]:
    """Every key that opens a screen, with its menu."""
    menus: dict[str, list[dict[str, Any]]] = page.evaluate(MENUS)
    return [(menu, key) for menu, keys in menus.items() for key in keys if "screen" in key]


def screens_of(page: Page) -> list[tuple[str, dict[str, Any]]]:
    """One key for each screen, or form."""
    found: dict[str, tuple[str, dict[str, Any]]] = {}
    for menu, key in keys_of(page):
        found.setdefault(name_of(key), (menu, key))
    return list(found.values())


PATHS = {
    "main": [], "setup": ["F5"], "run": ["F6"], "stop": None, "manual": ["F7"], "diag": ["F8"],
    "diagnostics": ["F8", "F5"], "display": ["F8", "F7"],
}  # fmt: skip


def name_of(key: dict[str, Any]) -> str:
    return str(key.get("args", {}).get("form", key["screen"])).lower()


def go(page: Page, menu: str) -> bool:
    """Go to a menu by its function keys; the menu of a held program is not reached so."""
    path = PATHS[menu]
    if path is None:
        return False
    to_main_menu(page)
    for key in path:
        page.keyboard.press(key)
    assert page.locator("#menu").get_attribute("data-shown") == menu
    return True


def opened(page: Page, key: dict[str, Any]) -> None:
    selector = f"#screen[data-screen={key['screen']}]:not([hidden]) .screen-body > *"
    page.wait_for_selector(selector, state="attached")


def looks(page: Page, pictures: Path, name: str, theme: str, places: str | None) -> list[str]:
    """What does not fit in one of the sizes, and what breaks a rule of accessibility.

    A theme is colours alone: where things are is looked at in the light one.
    """
    found = []
    for width, height in SIZES if theme == "light" else ():
        page.set_viewport_size({"width": width, "height": height})
        found += [f"{width}: {each}" for each in left_over(page, MISFITS)]
        picture(page, pictures / f"{name}-{width}x{height}-{theme}.png")
    rules: list[str] = page.evaluate(AXE_RUN if theme == "light" else AXE_COLORS, places)
    return found + rules


def by_function_key(page: Page, key: dict[str, Any]) -> None:
    page.keyboard.press(f"F{key['key']}")


def by_mouse(page: Page, key: dict[str, Any]) -> None:
    page.click(f"[data-fkey=F{key['key']}]")


@pytest.mark.timeout(400)
@pytest.mark.parametrize(
    ("theme", "press", "close"),
    [
        ("light", by_function_key, lambda page: page.keyboard.press("Escape")),
        ("dark", by_mouse, lambda page: page.click("#screen [data-close]")),
    ],
)
def test_every_screen_opens_fits_its_window_and_keeps_the_rules_of_accessibility(
    page: Page,
    pictures: Path,
    theme: Any,
    press: Callable[[Page, dict[str, Any]], None],
    close: Callable[[Page], None],
) -> None:
    page.emulate_media(color_scheme=theme)
    page.evaluate(AXE.read_text(encoding="utf-8"))
    found: dict[str, list[str]] = {}
    seen: set[str] = set()
    for tab in ("graphics", "program", "io", "plc", "alarms"):
        page.click(f"#display-tab-{tab}")
        found[tab] = looks(page, pictures, f"tab-{tab}", theme, None)
    page.click("#display-tab-graphics")
    for menu, key in screens_of(page):
        if not go(page, menu):
            continue
        press(page, key)
        opened(page, key)
        page.wait_for_function("() => document.activeElement.closest('#screen, dialog') !== null")
        places = None if menu not in seen else "#screen, dialog[open]"  # the menu is seen once
        seen.add(menu)
        found[name_of(key)] = looks(page, pictures, name_of(key), theme, places)
        while page.locator("dialog[open]").count():  # EDIT asks for a file
            page.keyboard.press("Escape")
        close(page)
        page.wait_for_selector("#screen", state="hidden")
    assert {name: each for name, each in found.items() if each} == {}


def test_stop_is_within_reach_while_a_dialog_is_open(page: Page) -> None:
    page.click("[data-fkey=F2]")
    page.get_by_role("dialog", name="Clear zero").wait_for()
    page.get_by_role("button", name="STOP feed hold").click()
    assert page.get_by_role("dialog").count() == 1
    page.keyboard.press("Escape")
    assert page.get_by_role("dialog").count() == 0


# Where keys and values are while the values are taken for old, with every text of the banner, and
# a reason beside the state.
WITH_BANNER = """async () => {
  const { model } = await import('/js/core/app.js');
  model.state.set({ ...model.state.value, reason: 'the feed hold of the panel is on' });
  const { default: catalogue } = await import('/js/catalog/operator.js');
  const texts = ['stale.old', 'stale.lost', 'stale.card'].flatMap((name) => Object.values(catalogue[name]));
  const banner = document.querySelector('#banner');
  const places = () => [...document.querySelectorAll('button, .position-row, #prompt, #work')]
    .filter((each) => !each.closest('#alarms')).map((each) => {
      const { x, y, width, height } = each.getBoundingClientRect();
      return `${each.id} ${each.textContent.slice(0, 9)} ${[x, y, width, height].map(Math.round)}`;
    }).join('; ');
  const before = banner.hidden ? places() : 'a banner was shown before';
  const found = [];
  for (const text of texts) {
    banner.hidden = false;
    banner.textContent = text;
    if (places() !== before) found.push(`${text}: ${before} / ${places()}`);
    if (banner.scrollHeight > banner.clientHeight) found.push(`${text}: ${banner.scrollHeight} of ${banner.clientHeight}`);
  }
  banner.hidden = true;
  return found;
}"""  # noqa: E501


def test_no_key_moves_under_the_finger_when_the_values_are_taken_for_old(
    context: BrowserContext, served: Served, page: Page
) -> None:
    bench = open_page(context, f"{served.url}/bench")
    for each in (page, bench):
        each.bring_to_front()
        for width, height in ((800, 600), (1920, 1080), (390, 844)):
            each.set_viewport_size({"width": width, "height": height})
            assert left_over(each, WITH_BANNER) == []
    page.set_viewport_size({"width": 1024, "height": 768})
    bench.close()


# What of read-out, STOP and jog keys a finger does not reach on a phone.
OUT_OF_REACH = """() => {
  const panel = document.querySelector('#status-panel').getBoundingClientRect();
  const found = document.body.classList.contains('is-stale') ? ['the banner is shown'] : [];
  for (const each of document.querySelectorAll('#status .position-row, #stop .stop-key, #screen .jog-key')) {
    const box = each.getBoundingClientRect();
    const isRow = each.matches('.position-row');
    const name = each.textContent.slice(0, 9);
    if (box.left < 0 || box.right > innerWidth || box.bottom > (isRow ? panel.bottom : innerHeight)) found.push(`${name} is cut off`);
    const corners = [[box.left + 8, box.top + 8], [box.right - 8, box.bottom - 8]];
    if (!isRow && corners.some(([x, y]) => !each.contains(document.elementFromPoint(x, y)))) found.push(`${name} is covered`);
  }
  return found;
}"""  # noqa: E501


@pytest.mark.parametrize(("width", "height"), [(390, 844), (375, 667), (360, 640)])
def test_a_phone_shows_the_read_out_and_stop_with_every_menu_and_while_jogging(
    page: Page, width: int, height: int
) -> None:
    page.set_viewport_size({"width": width, "height": height})
    page.click("#status-tab-view1")
    found = {}
    for place in [*page.evaluate(MENUS), "jog", "mdi", "home"]:
        if place in PATHS:
            page.evaluate(SHOW, place)
        else:
            page.evaluate(OPEN, place)
            page.wait_for_selector(f"#screen[data-screen={place}] button")
        found[place] = left_over(page, OUT_OF_REACH, MISFITS)
    page.set_viewport_size({"width": 1024, "height": 768})
    assert {place: each for place, each in found.items() if each} == {}


# Whether texts of the servo loop can be read, and it alone is moved sideways.
READABLE = """() => {
  const heights = [...document.querySelectorAll('#screen .loop-picture text')].map((each) => each.getBoundingClientRect().height);
  const host = document.querySelector('#screen .loop-host');
  return { texts: heights.length > 0 && Math.min(...heights) >= 12, room: host.scrollWidth - host.clientWidth > 500,
    page: document.documentElement.scrollWidth === 390 };
}"""  # noqa: E501


def test_the_servo_loop_is_readable_on_a_phone_and_moved_sideways(page: Page) -> None:
    page.set_viewport_size({"width": 390, "height": 844})
    page.evaluate(OPEN, "servo")
    page.wait_for_selector("#screen .loop-picture text")
    unreadable = f"() => Object.entries(({READABLE})()).filter(([, fits]) => !fits)"
    assert left_over(page, unreadable) == []
    page.set_viewport_size({"width": 1024, "height": 768})


def test_every_text_is_shown_in_german_and_every_key_fits(page: Page) -> None:
    """The last one: the page stays German."""
    page.evaluate("localStorage.setItem('openacr.panel.language', 'de')")
    page.reload()
    page.wait_for_function(READY)
    expect(page.locator("[data-fkey=F5] span")).to_have_text("EINRICHTEN")
    expect(page.locator("html")).to_have_attribute("lang", "de")
    page.set_viewport_size({"width": 800, "height": 600})
    found = {}
    for menu in page.evaluate(MENUS):
        page.evaluate(SHOW, menu)
        found[menu] = left_over(page, MISFITS)
    assert {menu: each for menu, each in found.items() if each} == {}


def test_the_browser_has_nothing_to_complain_about(page: Page) -> None:
    complaints: list[str] = page.complaints  # type: ignore[attr-defined]
    assert complaints == []
