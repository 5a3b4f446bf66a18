"""The tuning pane of the workspace: an axis measured, gains proposed, set, and taken back."""

import math
import re
from functools import partial
from pathlib import Path

import pytest
from playwright.sync_api import BrowserContext, Page, expect
from tests.panel.bench import Served
from tests.panel.browser.conftest import open_page, picture
from tests.panel.browser.test_bench import open_pane
from tests.panel.browser.test_screens import AXE, AXE_RUN

from openacr.map.rows import compliant_loads
from openacr.panel.control.station import Station

RESONANCE_HZ = 330.0
P_GAIN, D_GAIN = 12304, 12308  # of axis X


@pytest.fixture(scope="module")
def page(context: BrowserContext, served: Served) -> Page:
    """The workspace with the tuning pane open."""
    opened = open_page(context, f"{served.url}/bench")
    opened.set_viewport_size({"width": 1280, "height": 900})
    open_pane(opened, "Tuning")
    expect(opened.locator("[data-gain='P Gain'] input.field")).not_to_have_value("")
    return opened


def gain(station: Station, parameter: int = P_GAIN) -> float:
    return float(station.link.machine.card.read(parameter))


def test_nothing_moves_or_changes_before_it_is_confirmed(page: Page, served: Served) -> None:
    before = served.call(gain)
    page.get_by_role("textbox", name="Crossover").fill("30")
    page.get_by_role("textbox", name="Time, s").fill("0.3")
    page.get_by_role("button", name="MEASURE").click()
    dialog = page.get_by_role("dialog", name="MEASURE")
    expect(dialog).to_contain_text("by 100 pulses to both sides, for 0.3 s")
    dialog.get_by_role("button", name="CANCEL").click()
    expect(page.locator(".tune-chart")).to_have_count(0)
    page.get_by_role("button", name="MEASURE").click()
    dialog.get_by_role("button", name="MEASURE").click()
    expect(page.locator(".tune-chart canvas")).to_have_count(5)
    expect(page.locator("#prompt")).to_contain_text("Axis X is measured; nothing has been set")
    rows = page.locator(".tune-table tbody tr")
    expect(rows.filter(has_text="Crossover")).to_contain_text("30")
    assert served.call(gain) == before
    page.evaluate(AXE.read_text())
    assert page.evaluate(AXE_RUN) == []


def test_proposed_gains_are_set_when_confirmed_and_taken_back_by_undo(
    page: Page, served: Served
) -> None:
    before = served.call(gain)
    page.get_by_role("button", name="SET THESE GAINS").click()
    page.get_by_role("dialog").get_by_role("button", name="SET THESE GAINS").click()
    expect(page.locator(".tune-chart canvas")).to_have_count(6)
    after = served.call(gain)
    assert after != before
    expect(page.locator(".tune-changes li", has_text="P Gain")).to_have_count(1)
    page.get_by_role("button", name="AS AT THE START").click()
    expect(page.locator("#prompt")).to_contain_text("as they were at the start")
    assert served.call(gain) == pytest.approx(before, rel=1e-6)


def test_a_step_is_drawn_over_the_one_before(page: Page) -> None:
    page.locator("[data-pane=tune]").get_by_role("button", name="STEP", exact=True).click()
    page.get_by_role("dialog").get_by_role("button", name="STEP", exact=True).click()
    expect(page.locator("#prompt")).to_contain_text("Axis X: overshoot")
    step = page.get_by_role("img", name="Step, pulses")  # the one before was that of the new gains
    expect(step).to_have_count(1)
    for label in ("setpoint", "measured", "predicted", "before"):
        expect(step.locator(".u-series", has_text=label)).to_have_count(1)


def test_a_slider_acts_at_once_and_undo_and_redo_go_back_and_forth(
    page: Page, served: Served
) -> None:
    before = served.call(partial(gain, parameter=D_GAIN))
    row = page.locator("[data-gain='D Gain']")
    changes = page.locator(".tune-changes li")
    count = changes.count()
    row.get_by_role("slider").press("ArrowRight")
    expect(changes).to_have_count(count + 1)
    wanted = float(f"{before * 10**0.01:.4g}")
    assert served.call(partial(gain, parameter=D_GAIN)) == pytest.approx(wanted, rel=1e-3)
    for word, value, left in (("UNDO", before, count), ("REDO", wanted, count + 1)):
        page.get_by_role("button", name=word, exact=True).click()
        expect(changes).to_have_count(left)
        assert served.call(partial(gain, parameter=D_GAIN)) == pytest.approx(value, rel=1e-3)
    assert page.complaints == []  # type: ignore[attr-defined]


def test_any_earlier_set_of_gains_comes_back_with_one_press_and_redo_goes_forward(
    page: Page, served: Served
) -> None:
    changes = page.locator(".tune-changes li")
    count = changes.count()
    values: list[float] = []
    for name, parameter in (("P Gain", P_GAIN), ("D Gain", D_GAIN), ("P Gain", P_GAIN)):
        page.locator(f"[data-gain='{name}']").get_by_role("slider").press("ArrowRight")
        expect(changes).to_have_count(count + len(values) + 1)
        values.append(served.call(partial(gain, parameter=parameter)))
    expect(changes.last.locator("time")).not_to_have_text("")
    expect(changes.last.get_by_role("button")).to_have_count(0)  # it counts now
    changes.nth(count).get_by_role("button").click()
    expect(changes).to_have_count(count + 1)
    expect(page.locator("#prompt")).to_contain_text("The gains are as they were then")
    assert served.call(gain) == pytest.approx(values[0], rel=1e-6)
    assert served.call(partial(gain, parameter=D_GAIN)) != pytest.approx(values[1], rel=1e-3)
    for _ in range(2):
        page.get_by_role("button", name="REDO", exact=True).click()
    expect(changes).to_have_count(count + 3)
    assert served.call(gain) == pytest.approx(values[2], rel=1e-6)
    assert served.call(partial(gain, parameter=D_GAIN)) == pytest.approx(values[1], rel=1e-6)


def elastic(station: Station) -> None:
    """Put the load of axis X, as heavy as its motor, on an elastic shaft."""
    controller = station.installation.controller
    assert controller is not None
    memory = controller.memory
    resonance_rad_s = 2.0 * math.pi * RESONANCE_HZ
    for place, value in (
        (compliant_loads.damping_per_s, 0.03 * resonance_rad_s),
        (compliant_loads.inertia_ratio, 1.0),
        (compliant_loads.resonance_rad_s, resonance_rad_s),
    ):
        memory.F[place[0]] = value


def test_a_resonance_is_shown_and_a_notch_is_asked_for_with_the_gains(
    page: Page, served: Served, pictures: Path
) -> None:
    served.call(elastic)
    page.get_by_role("textbox", name="Highest frequency").fill("500")
    page.get_by_role("textbox", name="Crossover").fill("")
    page.get_by_role("textbox", name="Time, s").fill("0.6")
    page.get_by_role("button", name="MEASURE").click()
    page.get_by_role("dialog").get_by_role("button", name="MEASURE").click()
    shown = page.locator(".tune-resonance")
    expect(shown).to_contain_text("antiresonance", timeout=60_000)
    found = re.match(r"Resonance: ([\d.]+) Hz", shown.inner_text())
    assert found is not None
    assert float(found[1]) == pytest.approx(RESONANCE_HZ, rel=0.02)
    rows = page.locator(".tune-table tbody tr")
    notch = rows.filter(has_text="NOTCH, Hz").locator("td").last.inner_text()
    assert float(notch) == pytest.approx(RESONANCE_HZ, rel=0.02)
    expect(rows.filter(has_text="Load swings")).to_have_count(1)
    picture(page, pictures / "tuning-resonance.png")
    page.get_by_role("button", name="SET THESE GAINS").click()
    dialog = page.get_by_role("dialog")
    expect(dialog).to_contain_text(f"NOTCH ({notch},")
    dialog.get_by_role("button", name="CANCEL").click()
    assert page.complaints == []  # type: ignore[attr-defined]
