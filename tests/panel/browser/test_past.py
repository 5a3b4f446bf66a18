"""A moment of the past, pane by pane: each shows it, or says what it shows instead."""

import re
from collections.abc import Callable, Iterator
from functools import partial

import pytest
from playwright.sync_api import Browser, Page, expect
from tests.panel.bench import Served
from tests.panel.browser.conftest import at_rest, give, open_page, until, until_model

from openacr.client import Level
from openacr.mill.card.alarms import USER_MESSAGE
from openacr.panel.control.station import Station

OPEN = "(name) => import('/js/bench/workspace.js').then((each) => each.openPane(name))"
# What a pane shows at the first moment and at the second one. X is at 1 and 2 mm, P0 and LV0 of
# PROG5 are 11 and 22, an alarm is active at the second one, the texts of PROG5 and PLC0 are others,
# output 40 is on and off.
SHOWS = {
    "status": ("160800", "161600"),
    "programs": ("LV0 = 11", "LV0 = 22"),
    "variables": (r"LV0\s+11", r"LV0\s+22"),
    "plc": (r"41\s+50", r"42\s+50"),
    "servo": ("160800", "161600"),
    "drives": (r"201\.00\d", r"202\.00\d"),
    "uses": ("LD 41", "LD 42"),
    "tree": (r"P0\s+User Variable\s+11", r"P0\s+User Variable\s+22"),
    "watch": (r"\s11\s", r"\s22\s"),
    "io": (r"40\s+on", r"40\s+off"),
    "board": (r"P0\s.*\s11\s", r"P0\s.*\s22\s"),
    "world": (r"X 321\.00\d", r"X 322\.00\d"),
    "alarms": ("No alarm is active", "User message 22"),
    "timeline": ("{:.4f} s", "{:.4f} s"),  # its time
}
SAYS = {
    "terminal": "was printed before",
    "editor": "stays as it was opened",
    "project": "This card has no project",  # else it compares the programs of the moment
    "jog": "no axis is moved",
    "gain": "as they are stored now",
    "tune": "nothing is measured",
    "scope": "of the time when they were taken",
    "wizard": "answers for files",
    "bus": "the bus of the present",
}


def watch_p0(page: Page) -> None:
    name = page.get_by_label("P12288, BIT516 or axis0.actual position")
    name.fill("P0")
    name.press("Enter")


# How a pane comes to show what is looked for: an object is chosen, a value is named.
BEFORE: dict[str, Callable[[Page], object]] = {
    "programs": lambda page: page.locator("[data-pane=programs] [data-name=PROG5]").click(),
    "variables": lambda page: page.locator("[data-pane=variables] select").select_option("5"),
    "tree": lambda page: page.get_by_label("Words of a name, or a number").fill("p0"),
    "watch": watch_p0,
}


def dimension(station: Station) -> None:
    card = station.link.machine.card
    card.go(Level())
    card.command("DIM PLC0(2000)")
    card.command("DIM LV(2)", program=5)


def set_card(station: Station, number: int) -> None:
    """Have the card as it is at one of the moments, but for the axes, which begin to move."""
    card = station.link.machine.card
    card.download(f"10 LV0={11 * number}\n20 P0={11 * number}\n30 END\n", to=Level.program(5))
    card.download(f"10 LD {40 + number}\n20 OUT 50\n", to=Level.plc(0))
    card.command("RUN", program=5)
    card.write_bit(40, number == 1)
    station.typed.put([f"G0 X{number}"])


def place(station: Station) -> float:
    """Where X is: a busy page may miss that it moves."""
    return float(station.link.machine.card.read(12288))


def alarm(station: Station, text: str) -> None:
    station.link.machine.runner.alarms.raise_alarm(USER_MESSAGE, text, 0.0)


@pytest.fixture(scope="module")
def moments(page: Page, served: Served) -> tuple[int, int]:
    """The ticks of both moments; the card is at the second one now."""
    served.call(dimension)
    found = []
    for number in (1, 2):
        before = served.call(place)
        served.call(partial(set_card, number=number))
        until(page, lambda: served.call(place) != before)  # noqa: B023 - at once
        at_rest(page, served)
        if number == 2:
            served.call(partial(alarm, text="22"))
            until_model(page, "model.alarms.value.history.length === 1")
        served.call(lambda station: station.link.machine.card.pause(0.3))
        found.append(served.call(lambda station: station.times.history.lived_tk) - 20)
    return found[0], found[1]


@pytest.fixture(scope="module")
def page(browser: Browser, served: Served) -> Iterator[Page]:
    """The workspace on a desk."""
    context = browser.new_context(viewport={"width": 1366, "height": 768})
    page = open_page(context, f"{served.url}/bench")
    until_model(page, "model.hello.value.client")
    yield page
    context.close()


def go(page: Page, tick: int) -> None:
    """Show a moment of the past."""
    give(page, "timeline.seek", tick=tick)
    until_model(page, f"model.timeline.value.away && model.moment.value.tick === {tick}")


def test_every_pane_is_one_of_both_kinds(page: Page) -> None:
    panes = page.evaluate("import('/js/bench/panes.js').then(({ PANES }) => Object.keys(PANES))")
    assert sorted([*SHOWS, *SAYS]) == sorted(panes)


@pytest.mark.parametrize("name", SHOWS)
def test_a_pane_shows_the_moment(page: Page, moments: tuple[int, int], name: str) -> None:
    period_s = page.evaluate("window.known.timeline.value.period_s")
    early, late = (
        shown.format(tick * period_s) for shown, tick in zip(SHOWS[name], moments, strict=True)
    )
    page.evaluate(OPEN, name)
    pane = page.locator(f"[data-pane={name}]")
    go(page, moments[1])
    if name in BEFORE:
        BEFORE[name](page)
    expect(pane).to_contain_text(re.compile(late), use_inner_text=True)
    go(page, moments[0])
    expect(pane).to_contain_text(re.compile(early), use_inner_text=True)
    expect(pane).not_to_contain_text(re.compile(late), use_inner_text=True)
    go(page, moments[1])
    expect(pane).to_contain_text(re.compile(late), use_inner_text=True)
    expect(pane.locator(".refusal, .is-refused")).to_have_count(0)


@pytest.mark.parametrize("name", SAYS)
def test_any_other_pane_says_what_it_shows(page: Page, moments: tuple[int, int], name: str) -> None:
    go(page, moments[0])
    page.evaluate(OPEN, name)
    expect(page.locator(f"[data-pane={name}]")).to_contain_text(SAYS[name])


def test_what_a_pane_says_of_the_past_is_gone_where_the_machine_is_operated(
    page: Page, moments: tuple[int, int]
) -> None:
    go(page, moments[0])
    page.evaluate(OPEN, "jog")
    note = page.locator("[data-pane=jog] .pane-past")
    expect(note).to_be_visible()
    give(page, "timeline.operate")
    expect(note).to_be_hidden()
