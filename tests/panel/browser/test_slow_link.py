"""A slow link: every pane opens, a key that is pressed is answered in sight, and acts once."""

import re
from collections.abc import Callable, Iterator

import pytest
from playwright.sync_api import Browser, Locator, Page, expect
from tests.panel.bench import Served
from tests.panel.browser.conftest import (
    hold_answers,
    open_page,
    release_answers,
    until,
    until_model,
)
from tests.proxy import Proxy

from openacr.panel.control.station import Station

LATE_S = 0.15  # in each direction: 300 ms from a key to its answer
BYTES_PER_S = 400_000.0
OPEN = "(name) => import('/js/bench/workspace.js').then((each) => each.openPane(name))"
COUNT = """() => import('/js/core/app.js').then(({ link, model }) => {
  const send = link.send;
  [window.given, window.known] = [[], model];
  link.isLate.watch((isLate) => { window.waited ||= isLate; });
  link.send = (message) => { if (message.cmd) window.given.push(message.cmd); return send.call(link, message); };
})"""  # noqa: E501


@pytest.fixture(scope="module")
def page(browser: Browser, served: Served) -> Iterator[Page]:
    """The workspace over a slow link."""
    context = browser.new_context(viewport={"width": 1366, "height": 768})
    with Proxy(f"127.0.0.1:{served.port}") as proxy:
        proxy.slow(LATE_S, BYTES_PER_S)
        page = open_page(context, f"{proxy.url}/bench")
        page.evaluate(COUNT)
        until_model(page, "model.hello.value.client")
        yield page
        context.close()


def key(pane: Locator, name: str) -> Locator:
    return pane.get_by_role("button", name=name, exact=True).first


def mark(page: Page, pane: Locator) -> None:
    pane.get_by_label("Text of a bookmark").fill("here")
    key(pane, "MARK").dblclick()


def command(page: Page, pane: Locator) -> None:
    pane.get_by_label("Line for the card").fill("P0=P0+1")
    pane.get_by_label("Line for the card").press("Enter")


def watch(page: Page, pane: Locator) -> None:
    pane.get_by_label("P12288, BIT516 or axis0.actual position").fill("P0")
    key(pane, "ADD").click()


def throw(_page: Page, pane: Locator) -> None:
    pane.locator("button", has_text=re.compile("^ON$")).first.click()


def press(name: str) -> Callable[[Page, Locator], None]:
    return lambda _page, pane: key(pane, name).click()


# What is pressed in a pane, what the pane or the prompt then shows, and which command it gives.
KEYS: dict[str, tuple[Callable[[Page, Locator], None], str, str]] = {
    "terminal": (command, r"P0=P0\+1", "term.line"),
    "programs": (press("READ"), r"PROG0", ""),
    "variables": (press("READ"), r"No level is open", ""),
    "drives": (press("ALL OFF"), r"All drives are off", "stop.drives"),
    "watch": (watch, r"User Variable", ""),
    "uses": (press("READ"), r"names", ""),
    "world": (throw, r"RELEASE", "world.input"),
    "scope": (press("START"), r"samples", "scope.arm"),
    "timeline": (mark, r"here", "timeline.mark"),
}


def test_every_pane_opens_and_loses_nothing(page: Page) -> None:
    names = page.evaluate("import('/js/bench/panes.js').then(({ PANES }) => Object.keys(PANES))")
    for name in names:
        page.evaluate(OPEN, name)
        expect(
            page.locator(f"[data-pane={name}] .pane-body:not([inert]) > *").first
        ).to_be_visible()
    assert set(KEYS) <= set(names)
    assert page.complaints == []  # type: ignore[attr-defined]


@pytest.mark.parametrize("name", KEYS)
def test_a_key_is_answered_in_sight_and_acts_once(page: Page, name: str) -> None:
    act, shown, given = KEYS[name]
    page.evaluate(OPEN, name)
    pane = page.locator(f"[data-pane={name}]")
    expect(pane.locator(".pane-body:not([inert]) > *").first).to_be_visible()
    page.evaluate("window.given.length = 0; window.waited = false")
    act(page, pane)
    if given:
        page.wait_for_function("() => window.waited", polling=20)
    expect(page.locator("#prompt:not(.is-waiting)")).to_be_visible()
    expect(
        page.locator(f"[data-pane={name}], #prompt").filter(has_text=re.compile(shown)).first
    ).to_be_visible()
    assert page.evaluate("window.given").count(given) == (1 if given else 0)


def test_a_search_finds_over_a_slow_link(page: Page) -> None:
    page.keyboard.press("Control+k")
    page.get_by_role("dialog").get_by_role("combobox").fill("axis0 actual position")
    expect(page.get_by_role("dialog").get_by_role("option").first).to_contain_text(
        re.compile("actual position", re.I)
    )
    page.keyboard.press("Escape")


def test_lines_that_are_typed_quickly_arrive_each_once(page: Page, served: Served) -> None:
    def p0(station: Station) -> float:
        return station.times.history.read_rows([0])[0]

    before = served.call(p0)
    page.evaluate(OPEN, "terminal")
    field = page.locator("[data-pane=terminal]").get_by_label("Line for the card")
    page.evaluate("window.given.length = 0")
    for line in ("PROG5", *["P0=P0+1"] * 5):
        field.fill(line)
        field.press("Enter")
    until(page, lambda: served.call(p0) >= before + 5)
    page.wait_for_function("import('/js/core/app.js').then(({ link }) => !link.waiting.size)")
    assert served.call(p0) == before + 5
    assert page.evaluate("window.given").count("term.line") == 6


def test_an_answer_that_is_waited_for_is_seen_at_the_prompt(page: Page) -> None:
    prompt = page.locator("#prompt")
    hold_answers(page)
    page.evaluate("import('/js/core/app.js').then(({ give }) => void give('name', { name: 'a' }))")
    expect(prompt).to_have_class(re.compile("is-waiting"))
    sign = "(each) => getComputedStyle(each, '::after').content"
    assert "waiting for the answer" in prompt.evaluate(sign)
    release_answers(page)
    expect(prompt).not_to_have_class(re.compile("is-waiting"))
    until(page, lambda: prompt.evaluate(sign) == "none")
