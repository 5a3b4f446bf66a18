"""The pane Bus, on an emulated bus in memory: states, faults, counters, texts in German."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Locator, Page, expect
from tests.panel.bench import Served
from tests.panel.browser.conftest import picture, until_model
from tests.panel.browser.test_bench import open_pane
from tests.panel.bus_in_memory import BusInMemory


@pytest.fixture
def bus(served: Served) -> Iterator[BusInMemory]:
    one = BusInMemory()
    served.panel.installation.bus = one
    yield one
    served.panel.installation.bus = None


@pytest.fixture
def page(workspace: Page, served: Served) -> Page:
    workspace.goto(f"{served.url}/bench")
    workspace.set_viewport_size({"width": 1366, "height": 768})
    until_model(workspace, "model.hello.value.client")
    return workspace


def row(page: Page, of: str) -> Locator:
    return page.locator(f"[data-pane=bus] tr[data-row='{of}']")


def counter(page: Page, name: str) -> Locator:
    return page.locator(f"[data-pane=bus] [data-counter={name}] dd")


def test_a_drive_is_seen_through_enabling_motion_fault_and_reset_of_the_counters(
    page: Page, bus: BusInMemory, pictures: Path
) -> None:
    open_pane(page, "Bus")
    pane = page.locator("[data-pane=bus]")
    expect(pane.get_by_role("status")).to_have_text("The bus works")
    expect(pane).to_contain_text("emulated \u00b7 cycle 1.0 ms \u00b7 not in real time: Python")
    expect(counter(page, "cycles")).to_be_hidden()
    for place, name, state in (
        ("0", "drive", "OP"),
        ("1", "drive", "OP"),
        ("2", "digital", "PREOP"),
    ):
        expect(row(page, place).locator("td")).to_have_text([place, name, state, ""])
    expect(row(page, "X")).to_contain_text("switch on disabled")
    bus.rig.switch_on()
    bus.rig.send("ACC 400000 DEC 400000 STP 400000 VEL 40000", "X4000")
    bus.rig.card.advance(2000)
    cells = ["X", "0", "operation enabled", "CSP", "4000", "4000", ""]
    expect(row(page, "X").locator("td")).to_have_text(cells)
    bus.rig.drive().fault(0x2310)
    bus.rig.card.advance(500)
    expect(row(page, "X")).to_contain_text("0x2310 continuous overcurrent at the motor")
    expect(row(page, "X").locator("td").last).to_have_class("refusal")
    picture(page, pictures / "bus.png")
    bus.rig.link.pass_on = lambda _back: None
    bus.rig.card.advance(20)
    bus.rig.link.pass_on = None
    expect(pane.get_by_role("status")).to_have_text(
        "All drives are stopped: no frame comes back, 4 times in a row"
    )
    expect(counter(page, "lost")).to_have_text("10")
    pane.get_by_role("button", name="RESET COUNTERS").click()
    expect(counter(page, "lost")).to_have_text("0")
    expect(counter(page, "sent")).to_have_text("0")


def test_a_panel_without_a_bus_says_how_one_is_opened_and_a_silent_one_is_named(
    page: Page, served: Served
) -> None:
    open_pane(page, "Bus")
    status = page.locator("[data-pane=bus]").get_by_role("status")
    expect(status).to_contain_text("openacr panel PROJECT --real")
    one = BusInMemory(is_real=False)
    served.panel.installation.bus = one
    expect(page.locator("[data-pane=bus]")).to_contain_text("read only: no drive can be enabled")
    one.is_known = False
    expect(status).to_contain_text("does not report")
    expect(row(page, "X")).to_be_hidden()
    served.panel.installation.bus = None


LOOP = {
    "period_s": 0.0005, "cycles": 120000, "missed": 3, "lost_s": 0.0015,
    "late": {"median_s": 4.4e-6, "most_s": 61e-6, "worst_s": 812e-6},
    "computing": {"median_s": 2e-6, "most_s": 9e-6, "worst_s": 24e-6},
}  # fmt: skip


def test_the_figures_of_a_real_time_loop_are_shown(
    page: Page, bus: BusInMemory, pictures: Path
) -> None:
    bus.loop = LOOP
    open_pane(page, "Bus")
    expect(counter(page, "cycles")).to_have_text("120000")
    expect(counter(page, "missed")).to_have_text("3")
    expect(counter(page, "late-by")).to_have_text("median 4, 99.99 % 61, worst 812")
    expect(counter(page, "computing")).to_have_text("median 2, 99.99 % 9, worst 24")
    expect(page.locator("[data-pane=bus]")).not_to_contain_text("not in real time")
    picture(page, pictures / "bus-loop.png")


def test_the_pane_is_in_german_with_the_faults_of_drives(
    page: Page, served: Served, bus: BusInMemory, pictures: Path
) -> None:
    bus.rig.switch_on()
    bus.rig.drive().fault(0x8611)
    bus.rig.card.advance(400)
    bus.rig.segment.power(1, False)
    bus.rig.card.advance(400)
    bus.loop = LOOP
    page.evaluate("localStorage.setItem('openacr.panel.language', 'de')")
    page.goto(f"{served.url}/bench")
    until_model(page, "model.hello.value.client")
    expect(page.locator("[data-pane]").first).to_be_visible()
    page.evaluate("() => import('/js/bench/workspace.js').then((each) => each.openPane('bus'))")
    expect(row(page, "X")).to_contain_text("0x8611 Schleppfehler")
    expect(row(page, "X")).to_contain_text("nicht bekannt")
    expect(row(page, "1")).to_contain_text("antwortet nicht")
    expect(page.locator("[data-pane=bus]")).to_contain_text("Echtzeitschleife")
    expect(counter(page, "late-by")).to_have_text("Median 4, 99,99 % 61, größte 812")
    picture(page, pictures / "bus-de.png")
    page.evaluate("localStorage.removeItem('openacr.panel.language')")
