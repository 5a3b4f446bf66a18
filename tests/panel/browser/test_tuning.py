"""The tuning pane of the workspace: an axis measured, gains proposed, set, and taken back."""

import math
import re
from functools import partial
from pathlib import Path

import pytest
from playwright.sync_api import Browser, BrowserContext, Locator, Page, Route, expect
from tests.panel.bench import Served
from tests.panel.browser.conftest import (
    READY,
    give,
    let_through,
    open_page,
    picture,
    until,
    until_model,
)
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


INSIDE = """(bottom) => [...document.querySelectorAll('.tune-chart canvas')]
  .every((each) => each.getBoundingClientRect().bottom <= bottom + 1)"""


def in_force(page: Page) -> Locator:
    """The set of gains that is in force, in the list of changes."""
    return page.locator(".tune-changes [aria-current=true]")


def open_pane_again(page: Page) -> None:
    page.wait_for_function(READY)
    until_model(page, "model.hello.value.client")
    page.locator(".bench-tab-text", has_text="Tuning").click()
    expect(page.locator("[data-gain='P Gain'] input.field")).not_to_have_value("")


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
    rows = page.locator(".tune-side .tune-table tbody tr")
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
    expect(page.locator(".tune-chart canvas")).to_have_count(7)
    after = served.call(gain)
    assert after != before
    expect(page.locator(".tune-changes li", has_text="P Gain")).to_have_count(1)
    page.get_by_role("button", name="AS AT THE START").click()
    expect(page.locator("#prompt")).to_contain_text("The gains are those of")
    expect(in_force(page)).to_contain_text("as they were found")
    assert served.call(gain) == before


def test_a_step_is_drawn_over_the_one_before(page: Page) -> None:
    page.locator("[data-pane=tune]").get_by_role("button", name="STEP", exact=True).click()
    page.get_by_role("dialog").get_by_role("button", name="STEP", exact=True).click()
    expect(page.locator("#prompt")).to_contain_text("Axis X: overshoot")
    # the one before was that of the new gains
    shown = "Step, pulses: setpoint, measured, predicted, before"
    expect(page.locator("[data-chart='Step, pulses']")).to_have_attribute("aria-label", shown)


def press(page: Page, name: str, served: Served, parameter: int) -> float:
    """Move the slider of a gain by one step; the value it has then."""
    now = in_force(page).get_attribute("data-set")
    page.locator(f"[data-gain='{name}']").get_by_role("slider").press("ArrowRight")
    expect(in_force(page)).not_to_have_attribute("data-set", now or "")
    return served.call(partial(gain, parameter=parameter))


def test_a_slider_acts_at_once_and_undo_and_redo_go_back_and_forth(
    page: Page, served: Served
) -> None:
    before = served.call(partial(gain, parameter=D_GAIN))
    wanted = press(page, "D Gain", served, D_GAIN)
    assert wanted == pytest.approx(float(f"{before * 10**0.01:.4g}"), rel=1e-3)
    count = page.locator(".tune-changes li").count()
    for word, value in (("UNDO", before), ("REDO", wanted)):
        number = in_force(page).get_attribute("data-set")
        page.get_by_role("button", name=word, exact=True).click()
        expect(in_force(page)).not_to_have_attribute("data-set", number or "")
        assert served.call(partial(gain, parameter=D_GAIN)) == value
    expect(page.locator(".tune-changes li")).to_have_count(count)  # none is lost
    assert page.complaints == []  # type: ignore[attr-defined]


def test_any_earlier_set_of_gains_comes_back_with_one_press_and_redo_goes_forward(
    page: Page, served: Served
) -> None:
    changes = page.locator(".tune-changes li")
    values: list[float] = []
    numbers: list[str] = []
    for name, parameter in (("P Gain", P_GAIN), ("D Gain", D_GAIN), ("P Gain", P_GAIN)):
        values.append(press(page, name, served, parameter))
        numbers.append(in_force(page).get_attribute("data-set") or "")
    expect(in_force(page).locator("time")).not_to_have_text("")
    expect(in_force(page).get_by_role("button")).to_have_count(0)
    page.locator(f".tune-changes [data-set='{numbers[0]}']").get_by_role("button").click()
    expect(in_force(page)).to_have_attribute("data-set", numbers[0])
    expect(page.locator("#prompt")).to_contain_text("The gains are those of")
    assert served.call(gain) == values[0]
    assert served.call(partial(gain, parameter=D_GAIN)) != values[1]
    for number in numbers[1:]:
        page.get_by_role("button", name="REDO", exact=True).click()
        expect(in_force(page)).to_have_attribute("data-set", number)
    assert served.call(gain) == values[2]
    assert served.call(partial(gain, parameter=D_GAIN)) == values[1]
    assert changes.count() >= len(numbers)


def test_what_another_host_changes_is_signed_and_the_fields_follow(
    page: Page, served: Served
) -> None:
    served.call(lambda station: station.link.machine.card.command("AXIS0 PGAIN 0.0031"))
    expect(in_force(page)).to_contain_text("changed elsewhere")
    expect(page.locator("[data-gain='P Gain'] input.field")).to_have_value("0.0031")
    page.get_by_role("button", name="UNDO", exact=True).click()
    expect(page.locator("[data-gain='P Gain'] input.field")).not_to_have_value("0.0031")
    assert served.call(gain) != pytest.approx(0.0031)


def keep_as(page: Page, name: str) -> None:
    page.get_by_role("button", name="KEEP AS").click()
    dialog = page.get_by_role("dialog", name="KEEP AS")
    dialog.get_by_role("textbox").fill(name)
    dialog.get_by_role("button", name="OK").click()
    expect(page.locator(f"[data-kept='{name}'] input")).to_be_checked()


def curves(page: Page, title: str) -> str:
    return page.locator(f"[data-chart='{title}']").get_attribute("aria-label") or ""


def test_kept_measurements_are_drawn_over_the_present_one_and_compared_in_a_table(
    page: Page, served: Served
) -> None:
    keep_as(page, "soft")
    keep_as(page, "as found")
    for title in ("Magnitude, dB", "Phase, degrees", "Coherence", "Predicted steps, pulses"):
        assert curves(page, title).endswith("as found, soft")
    inks = [
        page.locator(f"[data-kept='{name}'] .tune-ink").evaluate("e => e.style.background")
        for name in ("soft", "as found")
    ]
    assert len(set(inks)) == 2
    expect(page.locator(".tune-legend .tune-name", has_text="as found")).to_have_count(1)
    page.get_by_role("radio", name="TABLE").click()
    table = page.locator(".tune-compared table")
    expect(table.locator("thead th")).to_have_text(["", "present", "proposed", "as found", "soft"])
    for row in (
        "PGAIN",
        "Gain margin",
        "Phase margin",
        "Bandwidth",
        "Overshoot",
        "Settling",
        "RMS",
    ):
        cells = table.locator("tbody tr", has_text=row).locator("td")
        expect(cells).to_have_count(4)
        assert cells.nth(0).inner_text() == cells.nth(2).inner_text() != ""
    page.get_by_role("radio", name=re.compile("CHARTS|BODE")).click()
    page.locator("[data-kept='soft'] input").uncheck()
    expect(
        page.locator("[data-chart='Magnitude, dB'][aria-label$='proposed, as found']")
    ).to_have_count(1)


def test_a_kept_measurement_is_renamed_exported_read_again_and_deleted_after_a_question(
    page: Page, tmp_path: Path
) -> None:
    ink = page.locator("[data-kept='as found'] .tune-ink").get_attribute("style")
    page.get_by_role("button", name="RENAME measurement as found").click()
    page.get_by_role("dialog").get_by_role("textbox").fill("first")
    page.keyboard.press("Enter")
    expect(page.locator("[data-kept=first] input")).to_be_checked()
    expect(page.locator("[data-kept=first] .tune-ink")).to_have_attribute("style", ink or "")
    with page.expect_download() as saved:
        page.get_by_role("link", name="FILE measurement first").click()
    file = tmp_path / saved.value.suggested_filename
    assert file.name == "first.tuning.json"
    saved.value.save_as(file)
    page.get_by_role("button", name="DELETE measurement first").click()
    dialog = page.get_by_role("dialog", name="DELETE")
    expect(dialog).to_contain_text("measurement first? It cannot be brought back")
    dialog.get_by_role("button", name="CANCEL").click()
    expect(page.locator("[data-kept=first]")).to_have_count(1)
    page.get_by_role("button", name="DELETE measurement first").click()
    dialog.get_by_role("button", name="DELETE").click()
    expect(page.locator("[data-kept=first]")).to_have_count(0)
    page.get_by_label("IMPORT").set_input_files(file)
    expect(page.locator("[data-kept=first] input")).to_be_checked()
    answers: list[str] = []
    page.on("response", lambda answer: answers.append(answer.url))
    for key in ("CANCEL", "REPLACE"):
        page.get_by_label("IMPORT").set_input_files(file)
        asked = page.get_by_role("dialog", name="REPLACE")
        expect(asked).to_contain_text("first is there already")
        asked.get_by_role("button", name=key).click()
        expect(asked).to_have_count(0)
    until(page, lambda: any("replace=true" in url for url in answers))
    assert sum("replace=true" in url for url in answers) == 1
    other = tmp_path / "other.json"
    other.write_text("{}")
    page.get_by_label("IMPORT").set_input_files(other)
    expect(page.locator("#prompt")).to_contain_text(
        "other is no measurement: Object missing required field"
    )
    page.complaints.clear()  # type: ignore[attr-defined]


def test_on_a_slow_link_the_last_choice_counts(page: Page) -> None:
    page.reload()
    open_pane_again(page)
    held: list[Route] = []
    page.route("**/api/kept/file*", lambda route: held.append(route))
    box = page.locator("[data-kept=first] input")
    box.check()
    until(page, lambda: held)
    box.uncheck()
    page.locator("[data-kept=soft] input").check()
    until(page, lambda: len(held) == 2)
    for each in reversed(held):
        let_through(page, each)
    page.unroute("**/api/kept/file*")
    expect(page.locator("[data-chart='Magnitude, dB'][aria-label$=': soft']")).to_have_count(1)
    expect(box).not_to_be_checked()
    assert page.complaints == []  # type: ignore[attr-defined]


def test_all_charts_are_beside_each_other_without_scrolling_and_by_tabs_where_it_is_narrow(
    page: Page, browser: Browser, served: Served, pictures: Path
) -> None:
    give(page, "control.release")
    with browser.new_context(viewport={"width": 1366, "height": 768}) as context:
        wide = open_page(context, f"{served.url}/bench")
        until_model(wide, "model.hello.value.client")
        wide.get_by_role("button", name="TUNE", exact=True).click()
        tune = wide.locator("[data-pane=tune]")
        tune.get_by_role("textbox", name="Time, s").fill("0.3")
        for key, said in (("MEASURE", "is measured"), ("STEP", "overshoot")):
            tune.get_by_role("button", name=key, exact=True).click()
            wide.get_by_role("dialog").get_by_role("button", name=key, exact=True).click()
            expect(wide.locator("#prompt")).to_contain_text(said)
        expect(wide.locator("[data-chart='Step, pulses']")).to_have_count(1)
        all_charts_are_seen(wide, pictures)
    give(page, "control.take")


def all_charts_are_seen(page: Page, pictures: Path) -> None:
    view = page.locator(".tune-view.is-wide")
    expect(view).to_have_count(1)
    expect(page.get_by_role("radio", name="CHARTS")).to_be_checked()
    parts = [page.locator(f"[data-part={name}]") for name in ("bode", "step", "simulation")]

    def are_beside() -> bool:
        boxes = [part.bounding_box() for part in parts]
        if not all(boxes):
            return False
        edges = [(box["x"], box["x"] + box["width"], box["y"]) for box in boxes if box]
        return (
            edges[0][1] <= edges[1][0]
            and edges[1][1] <= edges[2][0]
            and len({y for *_, y in edges}) == 1
        )

    until(page, are_beside)
    low = "e => e.scrollHeight <= e.clientHeight && e.getBoundingClientRect().bottom"
    bottom = view.evaluate(low)
    assert bottom
    until(page, lambda: page.evaluate(INSIDE, bottom))
    picture(page, pictures / "tuning-wide.png")
    page.set_viewport_size({"width": 1024, "height": 768})
    expect(page.get_by_role("radio", name="BODE")).to_be_checked()
    expect(parts[1]).to_be_hidden()
    page.get_by_role("radio", name="STEP").click()
    expect(parts[1]).to_be_visible()
    expect(parts[0]).to_be_hidden()
    assert page.complaints == []  # type: ignore[attr-defined]


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
    page.get_by_role("button", name="MEASURE", exact=True).click()
    page.get_by_role("dialog").get_by_role("button", name="MEASURE").click()
    shown = page.locator(".tune-resonance")
    expect(shown).to_contain_text("antiresonance", timeout=60_000)
    found = re.match(r"Resonance: ([\d.]+) Hz", shown.inner_text())
    assert found is not None
    assert float(found[1]) == pytest.approx(RESONANCE_HZ, rel=0.02)
    rows = page.locator(".tune-side .tune-table tbody tr")
    notch = rows.filter(has_text="NOTCH, Hz").locator("td").last.inner_text()
    assert float(notch) == pytest.approx(RESONANCE_HZ, rel=0.02)
    expect(rows.filter(has_text="Load swings")).to_have_count(1)
    picture(page, pictures / "tuning-resonance.png")
    page.get_by_role("button", name="SET THESE GAINS").click()
    dialog = page.get_by_role("dialog")
    expect(dialog).to_contain_text(f"NOTCH ({notch},")
    dialog.get_by_role("button", name="CANCEL").click()
    assert page.complaints == []  # type: ignore[attr-defined]
