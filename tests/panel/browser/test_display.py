"""DISPLAY, user messages and alarms as the operator sees and changes them."""

import re

import pytest
from playwright.sync_api import Locator, Page, expect
from tests.panel.bench import Served
from tests.panel.browser.conftest import READY, left_over, to_main_menu, until

from openacr.mill.card.messages import Message, define
from openacr.mill.config.overrides import Override
from openacr.panel.control.station import Station
from openacr.sysvar.tabs import DISPLAY, OFFSETS

LAMP = 140


def to_menu(page: Page, *keys: str) -> None:
    for each in keys:
        page.keyboard.press(each)


def reload(page: Page) -> None:
    page.reload()
    page.wait_for_function(READY)


def bit(served: Served, number: int) -> bool:
    return served.call(lambda station: station.link.machine.card.read_bit(number))


def set_bit(served: Served, number: int, on: bool) -> None:
    served.call(lambda station: station.link.machine.card.write_bit(number, on))


def view(page: Page, n: int) -> Locator:
    page.click(f"#status-tab-view{n}")
    return page.locator("#status-panel")


def blocks(page: Page, n: int) -> list[str]:
    """The titles of the blocks of a view."""
    view(page, n).locator(".block").first.wait_for()
    return [
        each.get_attribute("aria-label") or ""
        for each in page.locator("#status-panel .block").all()
    ]


# --- views ----------------------------------------------------------------------------


def checks(page: Page, names: dict[str, bool]) -> None:
    for name, on in names.items():
        page.get_by_role("checkbox", name=name, exact=True).set_checked(on)


@pytest.mark.req("MILL-DISP-SETUPVIEW")
@pytest.mark.req("MILL-DISP-VIEWS-INDEP")
def test_each_view_shows_what_setup_screen_has_saved_for_it(page: Page, served: Served) -> None:
    before = [blocks(page, n) for n in (1, 2, 3)]
    to_menu(page, "F8", "F7", "F9")
    changes = {
        "Distance to go, VIEW 1": True,
        "Next position, VIEW 2": False,
        "Feed and spindle, VIEW 2": True,
        "Emergency stop, VIEW 3": False,
    }
    checks(page, changes)
    page.keyboard.press("Escape")
    to_main_menu(page)
    assert [blocks(page, n) for n in (1, 2, 3)] == before  # not saved
    to_menu(page, "F8", "F7", "F9")
    checks(page, changes)
    page.get_by_role("button", name="SAVE VIEW").click()
    expect(page.locator("#prompt")).to_have_text("The views are saved")
    to_main_menu(page)
    reload(page)
    until(page, lambda: "Distance to go" in blocks(page, 1))
    saved = [blocks(page, n) for n in (1, 2, 3)]
    assert saved != before
    assert "Distance to go" in saved[0] and "Distance to go" not in before[0]
    assert "Next position" not in saved[1] and "Feed and spindle" in saved[1]
    assert "Emergency stop" not in saved[2]
    store = served.panel.installation.store
    assert store.read_text(DISPLAY.views[1]).split() == ["position", "distance", "feeds"]


# --- windows --------------------------------------------------------------------------


def width(page: Page) -> int:
    return int(page.locator("#status").bounding_box()["width"])  # type: ignore[index]


TOO_NARROW = """() => {
  const width = (name) => document.querySelector(name).getBoundingClientRect().width;
  return [['#status', 300], ['#display', 390]].filter(([name, least]) => width(name) < least);
}"""


def until_width(page: Page, wanted: int) -> None:
    """Wait until the status window is as wide; a busy browser lays out late."""
    measure = "Math.trunc(document.querySelector('#status').getBoundingClientRect().width)"
    page.wait_for_function(f"(wanted) => {measure} === wanted", arg=wanted)


@pytest.mark.req("MILL-DISP-LAYOUT")
@pytest.mark.req("MILL-DISP-RESIZE")
def test_the_edge_between_the_windows_is_moved_kept_and_put_back(page: Page) -> None:
    edge = page.get_by_role("separator")
    first = width(page)
    box = edge.bounding_box()
    assert box is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + 200
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 80, y, steps=4)
    page.mouse.up()
    until(page, lambda: abs(width(page) - first - 80) <= 3)
    edge.focus()
    page.keyboard.press("ArrowLeft")
    until(page, lambda: width(page) < first + 75)
    moved = width(page)
    page.click("#display-tab-io")
    reload(page)
    until_width(page, moved)
    expect(page.locator("#display-tab-io")).to_have_attribute("aria-selected", "true")
    page.set_viewport_size({"width": 800, "height": 600})
    assert left_over(page, TOO_NARROW) == []
    page.set_viewport_size({"width": 1024, "height": 768})
    to_menu(page, "F8", "F7")
    with page.expect_navigation():
        page.keyboard.press("F7")
    page.wait_for_function(READY)
    until_width(page, first)
    expect(page.locator("#display-tab-graphics")).to_have_attribute("aria-selected", "true")


# --- buttons --------------------------------------------------------------------------


@pytest.mark.req("MILL-DISP-VPB")
def test_a_button_gets_a_caption_a_bit_to_set_and_a_bit_to_show(page: Page, served: Served) -> None:
    to_menu(page, "F8", "F7", "F1")
    for cell, value in (
        (OFFSETS.button_caption[0], "Door"), (OFFSETS.button_set_bit[0], str(LAMP)),
        (OFFSETS.button_show_bit[0], str(LAMP + 1)),
    ):  # fmt: skip
        page.locator(f"#cell-{cell}").fill(value)
    page.get_by_role("button", name="SAVE", exact=True).click()
    expect(page.locator("#prompt")).to_have_text("Saved: 3")
    to_main_menu(page)
    view(page, 3)
    door = page.get_by_role("button", name="Door")
    door.hover()  # once it is there and stays at its place
    page.mouse.down()
    until(page, lambda: bit(served, LAMP))
    page.mouse.up()
    until(page, lambda: not bit(served, LAMP))
    lamp = door.locator(".lamp")
    expect(lamp).not_to_have_class(re.compile("is-on"))
    set_bit(served, LAMP + 1, True)
    expect(lamp).to_have_class(re.compile("is-on"))
    set_bit(served, LAMP + 1, False)
    expect(lamp).not_to_have_class(re.compile("is-on"))


@pytest.mark.req("MILL-DISP-FOV")
def test_the_fov_panel_chooses_one_of_sixteen_overrides(page: Page, served: Served) -> None:
    to_menu(page, "F8", "F7", "F2")
    feed = page.get_by_role("radiogroup", name="Feed")
    expect(feed.get_by_role("radio")).to_have_count(16)
    table = feed.get_by_role("radio").all_inner_texts()
    feed.get_by_role("radio").nth(4).click()
    expect(feed.get_by_role("radio").nth(4)).to_have_attribute("aria-checked", "true")
    factor = served.call(
        lambda station: station.link.machine.runner.overrides.factor(Override.FEED)
    )
    assert round(100 * factor) == int(table[4]) != 100
    full = table.index("100")
    feed.get_by_role("radio").nth(full).click()
    expect(feed.get_by_role("radio").nth(full)).to_have_attribute("aria-checked", "true")


# --- messages and alarms --------------------------------------------------------------


def messages(page: Page, served: Served, count: int) -> None:
    """Define messages on one bit after the other."""

    def write(station: Station) -> None:
        store = station.installation.store
        for n in range(count):
            text = f"Message {n} of the machine"
            define(
                store,
                Message(n, 160 + n, text, text_color=15, back_color=1 + n % 4, size=9 + n % 3),
            )

    served.call(write)
    until(page, lambda: len(served.call(defined)) == count)


def defined(station: Station) -> list[str]:
    """The texts of the messages that the machine shows when their bits are set."""
    return [each.text for each in station.link.machine.messages.defined]


@pytest.mark.req("MILL-MSG-PLACE")
def test_user_messages_appear_at_the_top_of_the_main_screen(page: Page, served: Served) -> None:
    messages(page, served, 32)
    area = page.locator("header.top #alarms")
    expect(area.locator(".none")).to_have_text("plate.nc")
    set_bit(served, 160, True)
    shown = area.locator(".user")
    expect(shown).to_have_text(["Message 0"])
    for n in range(1, 32):
        set_bit(served, 160 + n, True)
    expect(shown).to_have_text(["Message 0", "Message 1 ", "Message 2 o"])
    colours = {shown.nth(n).evaluate("(each) => each.style.background") for n in range(3)}
    assert len(colours) == 3
    box = area.bounding_box()
    assert box is not None and box["y"] < 60
    area.get_by_role("button", name="+29").click()
    dialog = page.get_by_role("dialog", name="All messages")
    expect(dialog.locator(".user")).to_have_count(32)
    page.keyboard.press("Escape")
    for n in range(32):
        set_bit(served, 160 + n, False)
    expect(area.locator(".none")).to_have_text("plate.nc")


@pytest.mark.req("MILL-ALM-SCREEN")
def test_the_alarm_screen_lists_alarms_with_time_and_text_and_those_of_the_user(
    page: Page, served: Served
) -> None:
    page.click("#display-tab-alarms")
    rows = page.locator("#display-panel tbody tr.is-alarm")
    expect(rows).to_have_count(0)

    def write(station: Station) -> None:
        define(
            station.installation.store,
            Message(3, bit=163, text="Oil is low", size=40, is_alarm=True),
        )

    served.call(write)
    until(page, lambda: "Oil is low" in served.call(defined))
    set_bit(served, 163, True)
    expect(rows).to_have_count(1)
    cells = rows.first.locator("td")
    expect(cells.nth(0)).to_have_text(re.compile(r"^\d{4}-\d\d-\d\d \d\d:\d\d:\d\d$"))
    expect(cells.nth(2)).to_contain_text("Oil is low")
    expect(page.locator("#alarms")).to_contain_text("Oil is low")
    set_bit(served, 163, False)
    page.locator("#display-panel").get_by_role("button", name="ACKNOWLEDGE").click()
    expect(rows).to_have_count(0)
    page.click("#display-tab-graphics")


# --- start ----------------------------------------------------------------------------


@pytest.mark.req("MILL-START-DIAG")
def test_diagnostics_are_reached_from_the_main_menu_right_after_the_start(page: Page) -> None:
    reload(page)
    assert page.locator("#menu").get_attribute("data-shown") == "main"
    to_menu(page, "F8", "F5")
    assert page.locator("#menu").get_attribute("data-shown") == "diagnostics"
    page.keyboard.press("F1")
    expect(page.locator("#screen-title")).to_have_text("I/O status")


def test_the_browser_has_nothing_to_complain_about(page: Page) -> None:
    complaints: list[str] = page.complaints  # type: ignore[attr-defined]
    assert complaints == []
