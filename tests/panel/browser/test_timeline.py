"""The timeline of the workspace: dragged back, on as another branch, STOP while time is still."""

from collections.abc import Iterator

import pytest
from playwright.sync_api import BrowserContext, Page, expect
from tests.panel.bench import Served
from tests.panel.browser.conftest import open_page, until_model

from openacr.panel.control.station import Station


def prepare(station: Station) -> None:
    """Program 5 counts in P0."""
    for line in ("10 P0=P0+1", "20 DWL 0.01", "30 GOTO 10", "RUN"):
        station.machine.card.command(line, program=5)


def lived(station: Station) -> int:
    return station.times.history.lived_tk


def counted(station: Station) -> float:
    return station.times.history.read_rows([0])[0]


def is_still(station: Station) -> bool:
    return station.times.is_still


@pytest.fixture(scope="module")
def page(context: BrowserContext, served: Served) -> Iterator[Page]:
    """The workspace with the pane, on a card that counts."""
    served.call(prepare)
    page = open_page(context, f"{served.url}/bench")
    until_model(page, "model.hello.value.client")
    page.get_by_role("button", name="PANES").click()
    page.get_by_role("dialog").get_by_role("button", name="Timeline", exact=True).click()
    expect(page.get_by_role("slider", name="Moment")).to_be_visible()
    yield page


def test_stop_ends_a_pause(page: Page, served: Served) -> None:
    page.get_by_role("button", name="PAUSE", exact=True).click()
    run = page.locator("[data-pane=timeline]").get_by_role("button", name="RUN", exact=True)
    expect(run).to_be_visible()
    tick = served.call(lived)
    page.locator(".stop-key").click()
    expect(
        page.locator("[data-pane=timeline]").get_by_role("button", name="PAUSE", exact=True)
    ).to_be_visible()
    until_model(page, f"model.moment.value.last > {tick + 1000}")
    assert not served.call(is_still)


def test_the_moment_is_dragged_back_and_the_machine_operated_from_there_on_another_branch(
    page: Page, served: Served
) -> None:
    until_model(page, "model.moment.value.last > 3000")
    slider = page.get_by_role("slider", name="Moment")
    before = served.call(counted)
    slider.evaluate(
        "(slider) => { slider.value = String(Number(slider.max) - 2000);"
        " slider.dispatchEvent(new Event('input')); }"
    )
    until_model(page, "model.timeline.value.away && model.timeline.value.still")
    tick = int(slider.input_value())
    until_model(page, f"model.moment.value.tick === {tick}")
    assert served.call(lived) == tick
    assert served.call(counted) < before
    slider.focus()
    page.keyboard.press("ArrowLeft")
    until_model(page, f"model.moment.value.tick === {tick - 1}")
    page.get_by_role("button", name="OPERATE FROM HERE").click()
    until_model(page, "!model.timeline.value.away && model.timeline.value.branches.length === 2")
    expect(page.locator("[data-branch='1'] strong")).to_contain_text("branch 1")
    expect(page.locator("#state")).to_contain_text("CARD RUNS")
    assert page.complaints == []  # type: ignore[attr-defined]


def compare(page: Page, parameters: str) -> None:
    page.get_by_label("Parameters to compare").fill(parameters)
    page.get_by_role("button", name="COMPARE").click()


def test_every_parameter_is_compared_on_a_scale_of_its_own(page: Page) -> None:
    compare(page, "P0, BIT81; system.global system clock")
    charts = page.locator(".time-chart[data-parameters='3'] [data-parameter]")
    expect(charts).to_have_count(3)
    names = charts.evaluate_all("(all) => all.map((each) => each.dataset.parameter)")
    assert names == ["P0", "BIT81", "P6916"]
    expect(charts.first).to_contain_text("branch 1")
    expect(charts.first).to_contain_text("first")
    expect(page.locator(".time-found [data-count]")).to_contain_text("differ")
    pane = page.locator("[data-pane=timeline] .scroll").first
    wide = page.evaluate("""() => [...document.querySelectorAll('[data-pane=timeline] .scroll, .time-chart, .time-legend')]
      .filter((each) => each.scrollWidth > each.clientWidth + 1).map((each) => each.className)""")  # noqa: E501
    assert wide == []
    expect(pane).to_be_visible()


def test_a_comparison_that_is_refused_says_why_in_the_pane(page: Page) -> None:
    refused = page.locator(".time-found [role=alert]")
    for parameters, why in (
        ("P0, nonsense", "no parameter and no flag is named 'nonsense'"),
        (",".join(f"P{n}" for n in range(9)), "9 parameters: 1 to 8 are sampled"),
    ):
        compare(page, parameters)
        expect(refused).to_have_text(why)
        expect(page.locator(".time-chart canvas")).to_have_count(0)
    compare(page, "P0")
    expect(refused).to_have_count(0)
    page.complaints.clear()  # type: ignore[attr-defined]  # the browser names the refusals


def test_labels_of_an_axis_have_room_and_a_curve_that_is_constant_a_height(page: Page) -> None:
    found = page.evaluate("""() => import('/js/bench/charts.js').then((m) => [
      m.axisSize(['100000', '0']) - m.axisSize(['0', '1']), m.axisSize(null), m.valueText(-75000),
      m.valueText(null), m.endsOf([[1, 1], [1]]), m.endsOf([[0, 100], [-100]]), m.endsOf([[NaN], []]),
    ])""")  # noqa: E501
    assert found == [37, 18, "\u221275000", "\u2013", [0.5, 1.5], [-116, 116], [0, 1]]
