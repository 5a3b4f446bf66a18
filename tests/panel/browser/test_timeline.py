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
    page.get_by_label("Parameters to compare").fill("P0")
    page.get_by_role("button", name="COMPARE").click()
    expect(page.locator(".time-chart[data-parameters='1'] canvas")).to_be_visible()
    expect(page.locator(".time-found [data-count]")).to_be_visible()
    assert page.complaints == []  # type: ignore[attr-defined]
