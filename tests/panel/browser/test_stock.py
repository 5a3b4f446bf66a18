"""STOCK of GRAPHICS: what a program leaves of the blank, from above and from the side."""

import re
from pathlib import Path

from playwright.sync_api import Page, expect
from tests.panel.bench import Served
from tests.panel.browser.conftest import load_file, picture

# How many pixels of the picture of the material have a colour, how many are red, and a sum that no
# two pictures share.
PIXELS = """() => {
  const canvas = document.querySelector('#display .picture [data-layer=material]');
  const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  let [shown, red, sum] = [0, 0, 0];
  for (let n = 0; n < data.length; n += 4) {
    if (data[n + 3]) shown += 1;
    sum = (31 * sum + data[n] + data[n + 3]) | 0;
    if (data[n] > 180 && data[n + 1] < 60 && data[n + 2] < 60) red += 1;
  }
  return { shown, red, sum, all: data.length / 4 };
}"""
BAD = "G21 F600\nG10 L12 P1 R4\nD1\nG0 X1 Y1 Z5\nX0 Y0\nG1 Z-6\nX60\nG0 Y40\nZ5\nM2\n"


def show_view(page: Page, name: str, holds: str) -> None:
    """Press the key of a view and wait until it is drawn and something holds of its pixels."""
    before = page.evaluate(PIXELS)["sum"]
    page.get_by_role("button", name=name, exact=True).click()
    page.wait_for_function(
        f"() => {{ const {{ shown, red, sum }} = ({PIXELS})();"
        f" return sum !== {before} && {holds}; }}"
    )


def load(page: Page, name: str) -> None:
    load_file(page, name)
    page.keyboard.press("F10")


def test_the_stock_is_shown_instead_of_the_path_until_its_key_is_pressed_again(
    page: Page, pictures: Path
) -> None:
    page.click("#display-tab-graphics")
    key = page.get_by_role("button", name="STOCK")
    note = page.locator(".stock-note")
    key.click()
    expect(key).to_have_attribute("aria-pressed", "true")
    expect(note).to_have_text("No rapid in material, no cut below the blank", timeout=60_000)
    page.wait_for_function(  # once the path is there as well, it is fitted
        f"() => {{ const {{ shown, all }} = ({PIXELS})(); return shown > all / 10; }}"
    )
    assert page.evaluate(PIXELS)["red"] == 0
    for view in ("3D", "FRONT", "TOP"):
        show_view(page, view, "shown > 1000")
        picture(page, pictures / f"stock-{view.lower()}.png")
    expect(page.locator(".picture [data-layer=strokes]")).to_be_hidden()
    key.click()
    expect(key).to_have_attribute("aria-pressed", "false")
    expect(page.locator(".picture [data-layer=material]")).to_be_hidden()
    expect(page.locator(".picture [data-layer=strokes]")).to_be_visible()
    expect(note).to_have_text("")


def test_a_rapid_in_material_is_red_and_its_line_is_named(
    page: Page, served: Served, pictures: Path
) -> None:
    (served.programs / "bad.nc").write_text(BAD)
    load(page, "bad.nc")
    page.click("#display-tab-graphics")
    key = page.get_by_role("button", name="STOCK")
    key.click()
    note = page.locator(".stock-note")
    expect(note).to_have_text(re.compile("Rapid in material: line 8"), timeout=60_000)
    page.wait_for_function(f"() => ({PIXELS})().red > 10")
    show_view(page, "3D", "red > 10")
    picture(page, pictures / "stock-rapid.png")
    key.click()


def test_a_stock_that_cannot_be_computed_says_why_and_the_path_stays(
    page: Page, served: Served
) -> None:
    (served.programs / "bare.nc").write_text("G21 F100\nG1 Z-3\nX9\nM2\n")
    load(page, "bare.nc")
    page.click("#display-tab-graphics")
    key = page.get_by_role("button", name="STOCK")
    key.click()
    expect(page.locator(".stock-note")).to_have_text(
        "the radius of the tool is not known: no D is in force, and CMP RAD is 0", timeout=60_000
    )
    expect(key).to_have_attribute("aria-pressed", "false")
    expect(page.locator(".picture [data-layer=strokes]")).to_be_visible()
