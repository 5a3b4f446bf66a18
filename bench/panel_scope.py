"""The scope of the bench in a real browser: what eight live channels and an hour cost in the page.

A core is that of the main thread (TaskDuration); pictures are drawn by it, too, without a graphics
processor.
"""

import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from playwright.sync_api import CDPSession, Page, sync_playwright
from tests.panel.bench import Served
from tests.panel.browser.chromium import MISSING, OPTIONS, found

from bench.figures import at_least, at_most, percentile
from bench.panel_graphics import FRAMES
from openacr.client.names import named
from openacr.panel.control.station import Station

CHANNELS = ["P12288", "P12289", "P12290", "P12291", "P12294", "P12295", "P6916", "BIT516"]
LIVE_MS = 5000
REST_MS = 150  # from key to key
KNOWN = "() => import('/js/core/app.js').then(({ model }) => model.hello.value.client)"
ZOOM = """async ([key, wait]) => {
  const begin = performance.now();
  document.querySelector('.scope-overview').dispatchEvent(new KeyboardEvent('keydown', { key, bubbles: true }));
  const drawn = performance.now() - begin;
  await new Promise((done) => setTimeout(done, wait));
  return drawn;
}"""  # noqa: E501


def an_hour(station: Station) -> None:
    """A record of eight channels at 1 kHz over an hour."""
    record = station.records.begin(1, [named(each) for each in CHANNELS], 0.001, take=True)
    station.records.end()
    for minute in range(60):
        times = np.arange(60_000.0) + 60_000.0 * minute
        record.samples.append(np.array([np.sin(times / (50.0 + n)) + n for n in range(8)]))


def fill_in(page: Page) -> None:
    """Eight sources, ten screens a second of what the engine samples."""
    for n, source in enumerate(CHANNELS):
        field = page.get_by_label(f"CH{n + 1} source", exact=True)
        field.fill(source)
        field.press("Tab")
    sweep = page.get_by_label("Sweep, ms/div", exact=True)
    sweep.fill("50")
    sweep.press("Tab")


def task_s(cdp: CDPSession) -> float:
    metrics = cdp.send("Performance.getMetrics")["metrics"]
    return float(next(each["value"] for each in metrics if each["name"] == "TaskDuration"))


def live(page: Page, cdp: CDPSession) -> None:
    page.get_by_label("Trigger", exact=True).select_option("roll")
    page.locator("[data-pane=scope]").get_by_role("button", name="START", exact=True).click()
    page.wait_for_timeout(1500)
    page.evaluate(FRAMES)
    begin_s = task_s(cdp)
    page.wait_for_timeout(LIVE_MS)
    share = (task_s(cdp) - begin_s) / (LIVE_MS / 1000.0)
    frames: list[float] = page.evaluate("window.frames_ms")
    at_least("scope, live: frames", 1000.0 * len(frames) / sum(frames), 55.0, "/s")
    at_most("scope, live: 8 channels, of a core", 100.0 * share, 25.0, "%")
    page.locator("[data-pane=scope]").get_by_role("button", name="STOP SCOPE").click()


def an_hour_zoomed(page: Page, cdp: CDPSession, panel: Served) -> None:
    page.get_by_label("Trigger", exact=True).select_option("record")
    panel.call(an_hour)
    page.wait_for_timeout(1000)
    idle_s = task_s(cdp)
    page.wait_for_timeout(REST_MS * 10)
    idle_s = (task_s(cdp) - idle_s) / 10.0  # of the other panes meanwhile
    keys = ["0", *["+"] * 8, *["ArrowRight"] * 8, *["-"] * 8, *["ArrowLeft"] * 8]
    begin_s = task_s(cdp)
    drawn: list[Any] = [page.evaluate(ZOOM, [key, REST_MS]) for key in keys]
    share_s = (task_s(cdp) - begin_s) / len(keys) - idle_s
    at_most("scope, an hour: the key until it is drawn, 95 %", percentile(drawn, 0.95), 50.0, "ms")
    at_most("scope, an hour: a key with its answers, of a core", 1000.0 * share_s, 50.0, "ms")


def main() -> None:
    path = found()
    if path is None:
        print(MISSING)
        return
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        panel = Served(Path(folder))
        browser = playwright.chromium.launch(executable_path=path, args=OPTIONS)
        page = browser.new_page(viewport={"width": 1366, "height": 768})
        page.goto(f"{panel.url}/bench")
        page.wait_for_function(KNOWN, timeout=120_000)
        page.wait_for_selector(".bench-tab-text")
        page.evaluate("import('/js/bench/workspace.js').then((each) => each.openPane('scope'))")
        page.wait_for_selector("[data-pane=scope] .scope-rows")
        fill_in(page)
        cdp = page.context.new_cdp_session(page)
        cdp.send("Performance.enable")
        live(page, cdp)
        an_hour_zoomed(page, cdp, panel)
        browser.close()
        panel.close()


if __name__ == "__main__":
    main()
