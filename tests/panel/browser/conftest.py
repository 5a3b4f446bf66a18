"""A Chromium for each process of tests, a panel and a page for each file of them.

Playwright keeps an event loop running in the thread of the tests for as long as its browser is
open. Other tests of the process start loops of their own: between files of browsers it is
taken for one that does not run.
"""

import asyncio
import json
import os
import time
from collections.abc import Callable, Generator, Iterator
from contextlib import suppress
from pathlib import Path

import pytest
from playwright.sync_api import (
    Browser,
    BrowserContext,
    Error,
    Page,
    Route,
    expect,
    sync_playwright,
)
from tests import waiting
from tests.panel.bench import Served
from tests.panel.browser.chromium import MISSING, OPTIONS, found
from tests.panel.browser.latency import slow_link

from openacr.mill.manual import controls
from openacr.panel.control.operator import hand_motion, presses
from openacr.panel.server import hello

LONGEST_MS = 60_000  # of any wait: a machine may be busy
SETTLED_S = LONGEST_MS / 1000.0  # until a page is laid out
expect.set_options(timeout=LONGEST_MS)
READY = (
    "() => document.querySelector('body:not(.is-stale) #menu .menu-key')"
    " && !document.querySelector('#status:not([aria-busy=false])')"
)

# How late a browser, and who holds a key, may be.
LATENESS = (
    (hello, "LONGEST_AGE_S"), (hello, "DEAD_MAN_S"), (hand_motion, "LONGEST_AGE_S"),
    (presses, "DEAD_MAN_S"), (controls, "SILENCE_S"),
)  # fmt: skip

SHOWN = """() => {
  const text = (selector) => document.querySelector(selector)?.innerText ?? '';
  return { prompt: text('#prompt'), banner: text('#banner'), dialog: text('dialog[open]'),
    menu: document.querySelector('#menu')?.dataset.shown, screen: text('#screen:not([hidden])'),
    classes: document.body.className, sent: window.sent };
}"""


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(
    item: pytest.Item,
) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """What the pages showed when a test failed."""
    report = yield
    for name, page in getattr(item, "funcargs", {}).items() if report.failed else ():
        if isinstance(page, Page) and not page.is_closed():
            with suppress(Error):
                report.sections.append((f"page {name}", json.dumps(page.evaluate(SHOWN), indent=1)))
    return report


@pytest.fixture(scope="session")
def chromium() -> Iterator[tuple[Browser, asyncio.AbstractEventLoop]]:
    """The browser of the machine, and the loop that it runs in."""
    path = found()
    if path is None:
        pytest.fail(MISSING)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=path, args=OPTIONS)
        loop = asyncio.get_running_loop()
        yield browser, loop
        asyncio._set_running_loop(loop)
        browser.close()


@pytest.fixture(scope="module")
def browser(chromium: tuple[Browser, asyncio.AbstractEventLoop]) -> Iterator[Browser]:
    """The browser for the tests of a file."""
    browser, loop = chromium
    asyncio._set_running_loop(loop)
    yield browser
    asyncio._set_running_loop(None)


@pytest.fixture(scope="module")
def stale_ms() -> int:
    """The age from which values are taken for old; a busy machine comes to half a second."""
    return LONGEST_MS


@pytest.fixture(scope="module", autouse=True)
def patience(stale_ms: int) -> Iterator[None]:
    """No key is refused, and none is let go, because a busy machine is late."""
    longer = stale_ms / hello.STALE_MS
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(hello, "STALE_MS", stale_ms)
        for module, name in LATENESS:
            patch.setattr(module, name, longer * getattr(module, name))
        yield


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    """A panel in real time for all tests of a file."""
    panel = Served(tmp_path_factory.mktemp("panel"))
    yield panel
    panel.close()


@pytest.fixture(scope="module")
def context(browser: Browser) -> Iterator[BrowserContext]:
    """A fresh profile with a touch screen of 1024 x 768."""
    context = browser.new_context(viewport={"width": 1024, "height": 768}, has_touch=True)
    yield context
    context.close()


@pytest.fixture(scope="module")
def workspace(context: BrowserContext, served: Served) -> Page:
    """The operator's workspace, opened once for a file."""
    return open_page(context, served.url)


@pytest.fixture
def page(workspace: Page) -> Page:
    """The workspace with live values, no screen open, at the main menu."""
    to_main_menu(workspace)
    return workspace


def to_main_menu(page: Page) -> None:
    """Close dialogs and screens, and go back to the main menu."""
    page.bring_to_front()
    while page.locator("dialog[open], #screen:not([hidden])").count():
        drop = page.get_by_role("dialog").get_by_role("button", name="DROP")
        if drop.count():
            drop.click()
        else:
            page.keyboard.press("Escape")
        page.wait_for_timeout(20)
    while page.locator("#menu").get_attribute("data-shown") != "main":
        page.keyboard.press("F10")


def until_model(page: Page, holds: str) -> None:
    """Wait until something holds of `model`, what the browser knows of the machine."""
    page.evaluate("import('/js/core/app.js').then(({ model }) => { window.known = model; })")
    page.wait_for_function(
        f"() => {{ const model = window.known; return Boolean({holds}); }}", polling=20
    )


def until(page: Page, holds: Callable[[], object]) -> None:
    """Wait until something holds outside the browser, whose events are heard meanwhile."""
    waiting.until(holds, limit_s=SETTLED_S, step=lambda: page.wait_for_timeout(20))


def at_rest(page: Page, served: Served) -> None:
    """Wait until the machine rests, and the page knows it."""
    until_model(page, "!model.state.value.busy")
    until(page, lambda: not served.call(lambda station: station.link.machine.runner.is_busy))


def left_over(page: Page, *checks: str) -> list[str]:
    """What checks of the page still find when it has come to rest: a busy browser lays out late."""
    end_s = time.monotonic() + SETTLED_S
    while True:
        found: list[str] = [each for check in checks for each in page.evaluate(check)]
        if not found or time.monotonic() > end_s:
            return found
        page.wait_for_timeout(50)


def give(page: Page, command: str, **args: object) -> object:
    """Give a command as the screens do; its result, None if it is refused."""
    return page.evaluate(
        "([cmd, args]) => import('/js/core/app.js').then((app) => app.give(cmd, args))",
        [command, args],
    )


def hold_answers(page: Page) -> None:
    """Hold the answers to commands back, as a slow link does."""
    page.evaluate("""() => import('/js/core/app.js').then(({ link }) => {
      const answered = link.answered;
      window.heldAnswers = [];
      link.answered = (message) => message.event ? answered.call(link, message) : window.heldAnswers.push(message);
    })""")  # noqa: E501


def release_answers(page: Page, change: str = "") -> None:
    """Let the held answers through, each changed before; returns when they were worked on."""
    page.wait_for_function("() => window.heldAnswers.length")
    page.evaluate(
        """() => import('/js/core/app.js').then(({ link }) => {
      delete link.answered;
      for (const each of window.heldAnswers) { CHANGE; link.answered(each); }
      return new Promise((done) => setTimeout(done));
    })""".replace("CHANGE", change)
    )


def let_through(page: Page, held: Route) -> None:
    """Let a request through that was held back; returns when its answer was worked on."""
    with page.expect_response(lambda answer: answer.request == held.request) as late:
        held.continue_()
    late.value.finished()
    page.evaluate("() => new Promise((done) => setTimeout(done, 50))")


def load_file(page: Page, name: str) -> None:
    """LOAD PROG of a file of the part folder, which leads to the menu RUN PROG."""
    to_main_menu(page)
    page.keyboard.press("F5")
    page.keyboard.press("F3")
    page.get_by_role("option", name=name).click()
    page.get_by_role("button", name="LOAD FILE").click()
    expect(page.locator("#alarms .none")).to_have_text(name)
    expect(page.locator("#screen")).to_be_hidden()
    expect(page.locator("#menu")).to_have_attribute("data-shown", "run")


def begin_run(page: Page) -> None:
    """START of the menu RUN PROG, from line 1."""
    page.keyboard.press("F2")
    dialog = page.get_by_role("dialog", name="RUN")
    expect(dialog.get_by_role("textbox", name="Start line")).to_have_value("1")
    page.keyboard.press("Enter")
    until_model(page, "model.state.value.running")


def open_page(context: BrowserContext, url: str) -> Page:
    """Open the workspace; whatever the browser complains about is kept in `page.complaints`."""
    page = context.new_page()
    page.set_default_timeout(LONGEST_MS)
    page.complaints = complaints = []  # type: ignore[attr-defined]
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.on(
        "console",
        lambda message: complaints.append(message.text) if message.type == "error" else None,
    )
    page.add_init_script(slow_link())
    page.goto(url)
    page.wait_for_function(READY)
    return page


def picture(page: Page, path: Path) -> None:
    """Keep what the page shows for people to look at: with OPENACR_TEST_PICTURES=1, 300 of them."""
    if os.environ.get("OPENACR_TEST_PICTURES"):
        page.screenshot(path=path)


@pytest.fixture(scope="session")
def pictures() -> Path:
    """Where screenshots go."""
    folder = Path(__file__).parents[3] / "build" / "panel-screens"
    folder.mkdir(parents=True, exist_ok=True)
    return folder
