"""The panel in a real browser: size and time of its first load, frames with 200,000 segments.

Both painters are measured, the one for machines without a graphics processor and WebGL, which a
machine without one computes by SwiftShader.
"""

import math
import tempfile
from pathlib import Path
from typing import Any

from playwright.sync_api import Page, sync_playwright
from tests.panel.browser.chromium import MISSING, OPTIONS, found

from bench.figures import at_least, at_most, percentile, value_only
from bench.panel import served

SEGMENTS = 200_000
LIMIT_MS = 120_000
GL = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
PAINTERS = {"canvas": OPTIONS, "webgl": [*OPTIONS[:1], *OPTIONS[2:], *GL]}
FIRST = """
const look = () => {
  const isLive = document.querySelector('body:not(.is-stale) #menu .menu-key');
  if (isLive) window.firstMs = performance.now();
  else requestAnimationFrame(look);
};
requestAnimationFrame(look);
"""
FRAMES = """() => {
  window.frames_ms = [];
  let last = performance.now();
  const note = (now) => {
    window.frames_ms.push(now - last);
    last = now;
    requestAnimationFrame(note);
  };
  requestAnimationFrame(note);
}"""
SIZE = """() => ['navigation', 'resource']
  .flatMap((kind) => performance.getEntriesByType(kind))
  .filter((each) => !each.name.includes('/api/'))
  .reduce((sum, each) => sum + each.encodedBodySize, 0)"""
LOADED = (
    "() => import('/js/draw/path.js').then(({ path }) => path.value && path.value.lines.length)"
)


def part() -> str:
    """A surface in rows, with as many moves as are to be drawn."""
    rows = 400
    lines = ["G21 G90 F3000", "G0 X0 Y0 Z5"]
    for n in range(SEGMENTS):
        row, at = divmod(n, SEGMENTS // rows)
        x = at if row % 2 == 0 else SEGMENTS // rows - at
        z = -3.0 + math.sin(x / 40.0) * math.cos(row / 30.0)
        lines.append(f"G1 X{x * 0.2:.3f} Y{row * 0.25:.3f} Z{z:.3f}")
    return "\n".join([*lines, "G0 Z5", "M2"]) + "\n"


def turn(page: Page, name: str) -> None:
    """Turn the picture for some seconds."""
    page.get_by_role("button", name="3D", exact=True).click()
    page.wait_for_timeout(1500)
    box: Any = page.locator("#display .picture").bounding_box()
    x, y = box["x"] + box["width"] / 3, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.evaluate(FRAMES)
    for step in range(150):
        page.mouse.move(x + step % 60, y + step % 25)
        page.wait_for_timeout(16)
    frames: list[float] = page.evaluate("window.frames_ms")
    page.mouse.up()
    at_least(f"{name}: frames while turning", 1000.0 * len(frames) / sum(frames), 55.0, "/s")
    at_most(f"{name}: a frame, 95 %", percentile(frames, 0.95), 34.0, "ms")


def main() -> None:
    path = found()
    if path is None:
        print(MISSING)
        return
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        (Path(folder) / "plate.nc").write_text(part())  # the name of the sample, which is loaded
        with served("--programs", folder) as (host, _pid):
            for painter, options in PAINTERS.items():
                browser = playwright.chromium.launch(executable_path=path, args=options)
                page = browser.new_page(viewport={"width": 1024, "height": 768})
                page.add_init_script(FIRST)
                page.add_init_script(f"localStorage.setItem('openacr.panel.renderer', '{painter}')")
                page.goto(f"http://{host}/")
                page.wait_for_function("() => window.firstMs", timeout=LIMIT_MS)
                first_s = page.evaluate("window.firstMs") / 1000.0
                while not page.evaluate(LOADED):
                    page.wait_for_timeout(200)
                name = f"panel, {painter}"
                at_most(f"{name}: first value", first_s, 0.6, "s")
                at_most(f"{name}: first load", page.evaluate(SIZE) / 1000.0, 450.0, "kB")
                value_only(f"{name}: points shown", page.evaluate(LOADED), "")
                turn(page, name)
                browser.close()


if __name__ == "__main__":
    main()
