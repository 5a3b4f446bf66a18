"""GRAPHICS as CONTROL and DISPLAY of SYS PARAM set it: colour and directions of path and cursor."""

import itertools
import re
import time
from typing import Any

import pytest
from playwright.sync_api import Page, expect
from tests.panel.bench import Served
from tests.panel.browser.conftest import (
    SETTLED_S,
    give,
    load_file,
    to_main_menu,
    until,
    until_model,
)

from openacr.mill.plan.pictures.blank import SIZES
from openacr.panel.control.station import Station
from openacr.sysvar import Store
from openacr.sysvar.tabs import CONTROL, DISPLAY, SPINDLE

ANGLE = "G21 G91 F600\nG1 X20\nY10\nM2\n"
GREEN, RED, BROWN = (0, 0x9E, 0x73), (0xB0, 0, 0x20), (0x8B, 0x5A, 0x2B)  # 10, 4 and 6
BLUE, BLUE_ON_DARK = (0, 0x33, 0xCC), (0x5C, 0x8D, 0xFF)  # 1
BLANK = (0x7A, 0x6A, 0x4F)
# How many pixels of the path are of a colour, and how many of any other. A line between two rows of
# pixels is half transparent in both, with the rounding of that.
COUNTED = """([red, green, blue]) => {
  const canvas = document.querySelector('#display .picture [data-layer=strokes]');
  const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  let [same, other] = [0, 0];
  for (let n = 0; n < data.length; n += 4) {
    if (data[n + 3] < 100) continue;
    if ([red, green, blue].every((part, k) => Math.abs(data[n + k] - part) < 4)) same += 1;
    else other += 1;
  }
  return [same, other];
}"""
# Middle of the cursor, and the box of the mark of the chosen line: pixels of the window.
SEEN = """() => {
  const canvas = document.querySelector('#display .picture [data-layer=over]');
  const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  const place = canvas.getBoundingClientRect();
  const box = [Infinity, Infinity, -Infinity, -Infinity];
  for (let n = 0; n < data.length / 4; n++) {
    if (data[4 * n + 3] < 250) continue;
    const [x, y] = [place.x + n % canvas.width, place.y + Math.floor(n / canvas.width)];
    box.splice(0, 4, Math.min(box[0], x), Math.min(box[1], y), Math.max(box[2], x), Math.max(box[3], y));
  }
  const cursor = document.querySelector('#display .tool-cursor').getBoundingClientRect();
  return { box, cursor: [cursor.x + cursor.width / 2, cursor.y + cursor.height / 2] };
}"""  # noqa: E501
# The box of what has a colour on the ground: pixels of the picture; null where there is none.
FRAMED = """([red, green, blue]) => {
  const canvas = document.querySelector('#display .picture [data-layer=ground]');
  const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  const box = [Infinity, Infinity, -Infinity, -Infinity];
  for (let n = 0; n < data.length; n += 4) {
    if (data[n + 3] < 255 || data[n] !== red || data[n + 1] !== green || data[n + 2] !== blue) continue;
    const [x, y] = [(n / 4) % canvas.width, Math.floor(n / 4 / canvas.width)];
    box.splice(0, 4, Math.min(box[0], x), Math.min(box[1], y), Math.max(box[2], x), Math.max(box[3], y));
  }
  return box[0] < box[2] ? { box, width: canvas.width, height: canvas.height } : null;
}"""  # noqa: E501
CHOOSE = "(line) => import('/js/draw/path.js').then((path) => path.chosenLine.set(line))"
STORE = """([form, values]) => fetch(`/api/forms/${form}`,
  { method: 'PUT', body: JSON.stringify({ values }) }).then((answer) => answer.ok)"""


@pytest.fixture
def drawn(page: Page, served: Served) -> Page:
    """The workspace with the path of a right angle, as it is drawn by default."""
    served.call(forget_sizes)
    if served.call(lambda station: station.part.data()["loaded"]["name"]) != "ANGLE.TXT":
        (served.programs / "ANGLE.TXT").write_text(ANGLE)
        load_file(page, "ANGLE.TXT")
        to_main_menu(page)
    until_counted(page, GREEN)
    return page


@pytest.mark.req("MILL-SYS-CTL-XSIZE", "MILL-SYS-CTL-YSIZE", "MILL-SYS-CTL-ZSIZE")
def test_cutting_sizes_are_the_blank_of_the_picture_and_its_area(
    drawn: Page, served: Served
) -> None:
    page, store = drawn, served.panel.installation.store
    assert [store.default(cell) for cell in SIZES] == [609.6] * 3  # 24 inches
    assert page.evaluate(FRAMED, BLANK) is None
    page.keyboard.press("F8")
    page.keyboard.press("F1")
    page.get_by_role("tab", name="Control, page 1", exact=True).click()
    for cell, letter, size in zip(SIZES, "XYZ", (60, 40, 8), strict=True):
        field = page.get_by_label(f"{letter} Axis Cutting Size", exact=True)
        field.fill("-1")
        page.get_by_role("button", name="SAVE", exact=True).click()
        expect(page.locator(f"#cell-{cell}-refusal")).to_contain_text("a number from 0 up [mm]")
        field.fill(str(size))
        page.get_by_role("button", name="SAVE", exact=True).click()
        expect(page.locator(f"#cell-{cell}-refusal")).to_have_text("")
        until_stored(page, store, cell, size)
    to_main_menu(page)
    page.evaluate(CHOOSE, 2)  # X20, of which the blank has three times the length
    for view, shape in (("TOP", (60, 40)), ("FRONT", (60, 8)), ("SIDE", (40, 8))):
        page.get_by_role("button", name=view, exact=True).click()
        seen = until_blank(page, shape)
        assert min(seen["box"][:2]) > 0
        assert seen["box"][2] < seen["width"] and seen["box"][3] < seen["height"]
    page.get_by_role("button", name="TOP", exact=True).click()
    left, _, right, _ = until_blank(page, (60, 40))["box"]
    start, _, end, _ = page.evaluate(SEEN)["box"]
    host = page.locator("#display .picture").bounding_box()
    assert host is not None
    assert (end - start - 4) == pytest.approx((right - left) / 3, abs=4)
    assert (start + end) / 2 - host["x"] == pytest.approx((left + right) / 2, abs=3)
    page.evaluate(CHOOSE, 0)


def until_stored(page: Page, store: Store, cell: int, value: float) -> None:
    until(page, lambda: store.read(cell) == value)


def until_blank(page: Page, size: tuple[int, int]) -> dict[str, Any]:
    """Wait until the outline of the blank has the shape of its sizes; where it is."""
    end_s = time.monotonic() + SETTLED_S
    while time.monotonic() < end_s:
        seen: dict[str, Any] | None = page.evaluate(FRAMED, BLANK)
        if seen is not None:
            left, top, right, bottom = seen["box"]
            if abs((right - left) * size[1] / size[0] - (bottom - top)) < 3:
                return seen
        page.wait_for_timeout(20)
    pytest.fail(f"{size}: {page.evaluate(FRAMED, BLANK)}")


def forget_sizes(station: Station) -> None:
    """Take the sizes of the blank out of the store."""
    for cell in SIZES:
        station.installation.store.reset(cell)


def until_counted(page: Page, color: tuple[int, int, int]) -> None:
    """Wait until the path is drawn in one colour."""
    page.wait_for_function(
        f"(color) => {{ const [same, other] = ({COUNTED})(color); return same > 100 && !other; }}",
        arg=color,
    )


@pytest.mark.req("MILL-SYS-CTL-PATHCOLOR")
def test_the_path_has_the_colour_of_the_index_that_control_holds(
    drawn: Page, served: Served
) -> None:
    page, store = drawn, served.panel.installation.store
    assert store.default(CONTROL.path_color) == store.read(CONTROL.path_color) == 10
    for index, color in ((4, RED), (6, BROWN), (10, GREEN)):
        page.keyboard.press("F8")
        page.keyboard.press("F1")
        page.get_by_role("tab", name="Control, page 2", exact=True).click()
        field = page.get_by_label("Path Color", exact=True)
        field.fill("16")
        page.get_by_role("button", name="SAVE", exact=True).click()
        expect(page.locator(f"#cell-{CONTROL.path_color}-refusal")).to_contain_text("0 to 15")
        field.fill(str(index))
        page.get_by_role("button", name="SAVE", exact=True).click()
        expect(page.locator("#prompt")).to_have_text("Saved: 1")
        until_stored(page, store, CONTROL.path_color, index)
        to_main_menu(page)
        until_counted(page, color)


def test_a_colour_is_chosen_by_its_swatch_and_has_its_name(page: Page, served: Served) -> None:
    store = served.panel.installation.store
    page.keyboard.press("F8")
    page.keyboard.press("F1")
    page.get_by_role("tab", name="Control, page 2", exact=True).click()
    row = page.locator(".form-row", has=page.get_by_label("Path Color", exact=True))
    swatches = row.locator(".swatch")
    expect(swatches).to_have_count(16)
    expect(row.locator(".swatches .hint")).to_have_text("light green")
    for index, name, tone in ((15, "white", "rgb(111, 143, 175)"), (4, "red", "rgb(176, 0, 32)")):
        swatch = row.get_by_role("button", name=f"Path Color {index}: {name}", exact=True)
        expect(swatch).to_have_css("background-color", tone)
        swatch.click()
        expect(page.get_by_label("Path Color", exact=True)).to_have_value(str(index))
        expect(row.locator(".swatches .hint")).to_have_text(name)
        expect(row.locator("[aria-pressed=true]")).to_have_count(1)
    page.get_by_role("button", name="SAVE", exact=True).click()
    until_stored(page, store, CONTROL.path_color, 4)
    store.write(CONTROL.path_color, 10)
    to_main_menu(page)


def test_bits_of_the_spindle_code_are_boxes_beside_its_number(page: Page, served: Served) -> None:
    store = served.panel.installation.store
    store.write(SPINDLE.code, 6.0)
    page.keyboard.press("F8")
    page.keyboard.press("F1")
    page.get_by_role("tab", name="Spindle", exact=True).click()
    row = page.locator(".form-row", has=page.get_by_label("Spindle Code", exact=True))
    number, boxes = page.get_by_label("Spindle Code", exact=True), row.locator("[type=checkbox]")
    expect(boxes).to_have_count(5)
    expect(row.locator(".bits label")).to_have_text([re.compile(f"^{n}:") for n in range(5)])
    expect(row.locator(".bits label").nth(3)).to_have_text("3: wait for At Zero")
    assert [box.is_checked() for box in boxes.all()] == [False, True, True, False, False]
    boxes.nth(4).check()
    boxes.nth(1).uncheck()
    expect(number).to_have_value("20")
    number.fill("9")
    assert [box.is_checked() for box in boxes.all()] == [True, False, False, True, False]
    page.get_by_role("button", name="SAVE", exact=True).click()
    until_stored(page, store, SPINDLE.code, 9)
    to_main_menu(page)


def test_the_path_has_another_tone_of_its_colour_in_the_dark_theme(drawn: Page) -> None:
    page = drawn
    assert page.evaluate(STORE, ["CONTROL2", {str(CONTROL.path_color): "1"}])
    until_counted(page, BLUE)
    page.emulate_media(color_scheme="dark")
    until_counted(page, BLUE_ON_DARK)
    page.emulate_media(color_scheme="light")
    until_counted(page, BLUE)
    assert page.evaluate(STORE, ["CONTROL2", {str(CONTROL.path_color): "10"}])
    until_counted(page, GREEN)


def test_settings_that_leave_the_extents_leave_the_view_as_it_is(
    drawn: Page, served: Served
) -> None:
    page = drawn
    page.evaluate(CHOOSE, 2)
    for _ in range(2):
        page.locator("#display .view-keys").get_by_text("+", exact=True).click()
    left, right = until_still(page)
    assert page.evaluate(STORE, ["CONTROL2", {str(CONTROL.path_color): "4"}])
    until_counted(page, RED)
    assert until_still(page) == (left, right)
    wide = right - left
    assert page.evaluate(STORE, ["CONTROL", {str(SIZES[0]): "90"}])
    page.wait_for_function(  # the extents are others: the picture is fitted
        f"(wide) => {{ const {{ box }} = ({SEEN})(); return box[2] - box[0] < wide / 2; }}",
        arg=wide,
    )
    assert page.evaluate(STORE, ["CONTROL2", {str(CONTROL.path_color): "10"}])
    page.evaluate(CHOOSE, 0)


def until_still(page: Page) -> tuple[float, float]:
    """Where the mark of the chosen line begins and ends, once two paintings agree."""
    before: list[float] = []
    while (box := page.evaluate(SEEN)["box"]) != before or None in box:
        before = box
        page.wait_for_timeout(60)
    return before[0], before[2]


@pytest.mark.req("MILL-SYS-DISP-COMBINE")
def test_flips_and_exchange_are_combined_and_turn_path_and_cursor_alike(drawn: Page) -> None:
    page = drawn
    give(page, "mdi.execute", line="G21 G91 G1 X20 Y10 F6000")
    until_model(
        page,
        "!model.state.value.busy && Math.abs(model.status.value.machine[0] - 20) < 0.1"
        " && Math.abs(model.status.value.machine[1] - 10) < 0.1",
    )
    cells = (DISPLAY.flip_x_axis, DISPLAY.flip_y_axis, DISPLAY.exchange_xy)
    for flip_x, flip_y, exchange in itertools.product((False, True), repeat=3):
        switches = (flip_x, flip_y, exchange)
        values = {str(cell): str(int(on)) for cell, on in zip(cells, switches, strict=True)}
        assert page.evaluate(STORE, ["DISPLAY", values])
        x, y = (-1 if flip_x else 1), (-1 if flip_y else 1)
        legs = [(0, x), (y, 0)] if exchange else [(x, 0), (0, y)]  # of X20 and Y10, up is plus
        for line, leg in enumerate(legs, 2):
            page.evaluate(CHOOSE, line)
            until_seen(page, line == 3, leg)
    page.evaluate(CHOOSE, 0)


def until_seen(page: Page, is_last: bool, leg: tuple[int, int]) -> None:
    """Wait until a leg has its direction, with the cursor at the end of the last one.

    The cursor is at X20 Y10: off the first leg by half its length, at right angles to it.
    """
    seen: dict[str, Any] = {}
    end_s = time.monotonic() + SETTLED_S
    while time.monotonic() < end_s:
        seen = page.evaluate(SEEN)
        left, top, right, bottom = seen["box"]
        if left < right:
            across, down = leg[0] != 0, leg[1] != 0
            x = (left + right) / 2 if down else (right if leg[0] > 0 else left)
            y = (top + bottom) / 2 if across else (top if leg[1] > 0 else bottom)
            is_along = (right - left > bottom - top) == across
            off = (seen["cursor"][0] - x, seen["cursor"][1] - y)
            is_near = max(map(abs, off)) <= 4
            if is_along and is_near == is_last:
                return
        page.wait_for_timeout(20)
    pytest.fail(f"{leg}: {seen}")


def test_the_browser_has_nothing_to_complain_about(page: Page) -> None:
    complaints: list[str] = page.complaints  # type: ignore[attr-defined]
    assert [each for each in complaints if "422" not in each] == []
