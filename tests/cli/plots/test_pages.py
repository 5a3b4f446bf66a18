"""Pages of runs and tool paths in a real browser, opened from a file."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Browser, Page, sync_playwright
from tests.panel.browser.chromium import MISSING, OPTIONS, found
from typer.testing import CliRunner

from openacr.cli.main import app
from openacr.cli.plots import AxisCurves, BitCurve, Curves, draw
from openacr.cli.results import Event

TIME_S = np.arange(4000, dtype=np.float64) * 0.0005
PART = "F10\nG0 X1 Y1 Z1\nG1 Z-1\nX3\nG2 X5 I1 J0 G200 F1\nG1 Y4\nG0 Z1\nM2\n"
INK = """(layer) => {
  const canvas = document.querySelector(`[data-layer=${layer}]`);
  const copy = document.createElement('canvas');
  [copy.width, copy.height] = [canvas.width, canvas.height];
  const pen = copy.getContext('2d');
  pen.drawImage(canvas, 0, 0);
  const { data } = pen.getImageData(0, 0, copy.width, copy.height);
  let shown = 0;
  for (let n = 3; n < data.length; n += 4) if (data[n] > 60) shown += 1;
  return shown;
}"""


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    path = found()
    if path is None:
        pytest.fail(MISSING)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=path, args=OPTIONS)
        yield browser
        browser.close()


@pytest.fixture
def page(browser: Browser) -> Iterator[Page]:
    """A page that may load nothing but files and what is in them."""
    page = browser.new_page(viewport={"width": 1200, "height": 1400})
    asked: list[str] = []
    errors: list[str] = []
    page.on("request", lambda request: asked.append(request.url))
    page.on("pageerror", lambda error: errors.append(str(error)))
    yield page
    assert errors == []
    assert [url for url in asked if not url.startswith(("file:", "data:"))] == []
    page.close()


def axis(number: int, name: str) -> AxisCurves:
    position = 10.0 * np.sin(TIME_S * (number + 1))
    error = np.zeros_like(TIME_S)
    error[1234] = 0.5
    return AxisCurves(
        number, position, position - error, np.gradient(position, 0.0005), error,
        name=name, unit="mm", master=0,
    )  # fmt: skip


def test_curves_of_a_run_are_read_and_zoomed_together(page: Page, tmp_path: Path) -> None:
    bits = (BitCurve(32, (TIME_S % 0.5) < 0.25, "clamp"),)
    curves = Curves(
        TIME_S, (axis(0, "X"), axis(1, "Y")), bits, "gantry", events=(Event(1.5, "limit"),)
    )
    draw(curves, tmp_path / "run.html")
    page.goto((tmp_path / "run.html").as_uri())
    page.locator(".uplot").nth(7).wait_for()  # three for each axis, the path, the output
    assert page.locator("h1").text_content() == "gantry: 2 s simulated"
    assert page.locator("h2").all_text_contents() == [
        "X (axis 0)", "Y (axis 1)", "path, master 0", "outputs and flags", "events",
    ]  # fmt: skip
    assert page.locator("li").all_text_contents() == ["1.5 s: limit"]
    area = page.locator(".u-over").first.bounding_box()
    assert area is not None
    at_s = [0.25 * area["width"], 0.75 * area["width"]]  # 0.5 s and 1.5 s of 2 s
    page.mouse.move(area["x"] + at_s[0], area["y"] + 50)
    page.mouse.down()
    page.mouse.move(area["x"] + at_s[1], area["y"] + 50, steps=4)
    page.mouse.up()
    page.mouse.move(area["x"] + 0.5 * area["width"], area["y"] + 50)
    for legend in (0, 4):  # X position, Y velocity: the middle of what is shown is 1 s
        text = page.locator(".u-legend").nth(legend).locator(".u-value").first.text_content()
        assert float((text or "").removesuffix(" s")) == pytest.approx(1.0, abs=0.02)
    page.mouse.dblclick(area["x"] + 0.5 * area["width"], area["y"] + 50)
    page.mouse.move(area["x"] + 0.25 * area["width"], area["y"] + 50)
    text = page.locator(".u-legend").nth(4).locator(".u-value").first.text_content()
    assert float((text or "").removesuffix(" s")) == pytest.approx(0.5, abs=0.02)


def test_a_tool_path_is_stepped_through_and_its_kinds_are_switched_off(
    page: Page, tmp_path: Path
) -> None:
    part, target = tmp_path / "PART.NC", tmp_path / "part.html"
    part.write_text(PART)
    assert CliRunner().invoke(app, ["mill", "plot", str(part), str(target)]).exit_code == 0
    page.goto(target.as_uri())
    where = page.locator("#where")
    page.wait_for_function("() => document.querySelector('#where').textContent")
    assert where.text_content() == "line 7: X5.0000 Y4.0000 Z1.0000 (rapid)"
    whole = page.evaluate(INK, "strokes")
    assert whole > 200
    page.locator("#upto").evaluate("(e) => { e.value = 3; e.dispatchEvent(new Event('input')); }")
    page.wait_for_function("() => document.querySelector('#where').textContent.includes('line 4')")
    assert where.text_content() == "line 4: X3.0000 Y1.0000 Z-1.0000 (feed)"
    assert page.evaluate(INK, "strokes") < whole / 2
    for box in page.locator("#keys input").all():
        box.uncheck()
    page.wait_for_timeout(100)
    assert page.evaluate(INK, "strokes") == 0
    page.get_by_role("button", name="front").click()
    page.locator("#keys input").first.check()
    page.wait_for_timeout(100)
    assert page.evaluate(INK, "strokes") > 0


def test_the_page_of_a_verified_folder_lists_programs_by_their_result(
    page: Page, tmp_path: Path
) -> None:
    shop = tmp_path / "shop"
    shop.mkdir()
    (shop / "good.nc").write_text("G20\n" + PART)
    (shop / "wr<b>ng.nc").write_text("X\nM2\n")
    target = tmp_path / "shop.html"
    words = ["verify", str(shop), "--workers", "1", "--html", str(target)]
    assert CliRunner().invoke(app, words).exit_code == 1
    page.goto(target.as_uri())
    page.locator("tbody tr").nth(1).wait_for()
    assert page.locator("tbody b").all_text_contents() == ["good.nc", "wr<b>ng.nc"]
    assert page.locator("tbody tr").nth(1).locator("li").first.text_content() == (
        "1:2 E105 value expected after letter"
    )
    page.locator("select").select_option("errors")
    assert page.locator("tbody tr:visible b").all_text_contents() == ["wr<b>ng.nc"]
