"""The frame of the engineer's workspace for a mouse: three jobs, shortcuts."""

from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser, Locator, Page, expect
from tests.panel.bench import Served
from tests.panel.browser.conftest import open_page, until, until_model

JOBS = {
    "PROGRAM": ["Programs", "PLC", "Editor", "Variables", "Watch list", "Terminal", "Values",
                "ALARMS"],
    "TUNE": ["Tuning", "Gains", "Servo loop", "Jog", "Watch list", "ALARMS", "Scope"],
    "WATCH": ["Status", "Values", "Watch list", "I/O", "ALARMS", "Scope", "Servo loop", "Timeline",
              "PLC"],
}  # fmt: skip
SIZES = ((1366, 768), (1920, 1080))
FORGET = """() => import('/js/bench/workspace.js').then(async ({ arrange, chooseJob }) => {
  localStorage.clear();
  await chooseJob('program');
  localStorage.clear();
  arrange(null);
})"""


@pytest.fixture(scope="module")
def desk(browser: Browser, served: Served) -> Iterator[Page]:
    """The workspace on a desk: a mouse, no touch screen."""
    context = browser.new_context(viewport={"width": 1366, "height": 768})
    yield open_page(context, f"{served.url}/bench")
    context.close()


@pytest.fixture
def page(desk: Page) -> Page:
    """The first layout of PROGRAM, with no dialog open."""
    while desk.get_by_role("dialog").count():
        desk.keyboard.press("Escape")
    desk.set_viewport_size({"width": 1366, "height": 768})
    desk.evaluate(FORGET)
    expect(panes(desk)).to_have_text(JOBS["PROGRAM"])
    return desk


def panes(page: Page) -> Locator:
    return page.locator(".bench-tab-text")


def job(page: Page, name: str) -> Locator:
    return page.get_by_role("group", name="Layouts for three jobs").get_by_role("button", name=name)


# --- jobs -----------------------------------------------------------------------------


def test_each_job_has_a_first_layout_chosen_by_its_key_or_shortcut(page: Page) -> None:
    for n, (name, shown) in enumerate(JOBS.items(), 1):
        job(page, name).click()
        expect(panes(page)).to_have_text(shown)
        expect(job(page, name)).to_have_attribute("aria-pressed", "true")
        expect(page.locator(".jobs [aria-pressed=true]")).to_have_count(1)
        page.keyboard.press("Control+Alt+1" if n > 1 else "Control+Alt+3")
        expect(panes(page)).to_have_text(JOBS["PROGRAM" if n > 1 else "WATCH"])
        page.keyboard.press(f"Control+Alt+{n}")
        expect(panes(page)).to_have_text(shown)


def test_a_job_is_left_as_it_is_and_first_layout_is_its_own(page: Page) -> None:
    job(page, "TUNE").click()
    page.locator(".dv-tab", has_text="Gains").locator(".bench-close").click()
    without = [name for name in JOBS["TUNE"] if name != "Gains"]
    expect(panes(page)).to_have_text(without)
    job(page, "WATCH").click()
    expect(panes(page)).to_have_text(JOBS["WATCH"])
    job(page, "TUNE").click()
    expect(panes(page)).to_have_text(without)
    page.reload()
    page.wait_for_selector("body:not(.is-stale) #menu .menu-key")
    until_model(page, "model.hello.value.client")
    expect(panes(page)).to_have_text(without)
    page.get_by_role("button", name="LAYOUTS").click()
    page.get_by_role("button", name="FIRST LAYOUT").click()
    expect(panes(page)).to_have_text(JOBS["TUNE"])


def test_a_pane_of_both_jobs_goes_on_and_one_with_changes_may_stay(page: Page) -> None:
    job(page, "TUNE").click()
    page.wait_for_selector("[data-pane=scope] .u-over")
    page.evaluate("document.querySelector('[data-pane=scope]').isTheOne = true")
    job(page, "WATCH").click()
    expect(panes(page)).to_have_text(JOBS["WATCH"])
    assert page.evaluate("document.querySelector('[data-pane=scope]').isTheOne")
    job(page, "PROGRAM").click()
    page.locator("[data-pane=editor] .cm-content").click()
    page.keyboard.type("PROG1")
    job(page, "TUNE").click()
    page.get_by_role("dialog").get_by_role("button", name="CANCEL").click()
    expect(panes(page)).to_have_text(JOBS["PROGRAM"])
    expect(page.locator("[data-pane=editor] .cm-content")).to_contain_text("PROG1")
    job(page, "TUNE").click()
    page.get_by_role("dialog").get_by_role("button", name="DROP").click()
    expect(panes(page)).to_have_text(JOBS["TUNE"])


def share(page: Page, part: str, whole: str) -> float:
    """What part of the area of an element another one has."""
    boxes = [page.locator(each).first.bounding_box() for each in (part, whole)]
    areas = [box["width"] * box["height"] if box else 0.0 for box in boxes]
    return areas[0] / areas[1] if areas[1] else 0.0


@pytest.mark.parametrize(("width", "height"), SIZES)
def test_the_editor_has_twenty_lines_and_the_plot_half_of_its_pane(
    page: Page, width: int, height: int
) -> None:
    page.set_viewport_size({"width": width, "height": height})
    editor = page.locator("[data-pane=editor]")
    lines = (editor.locator(".cm-scroller"), editor.locator(".cm-line").first)

    def is_large() -> bool:
        text, line = (each.bounding_box() for each in lines)
        return bool(text and line and text["height"] >= 20 * line["height"])

    until(page, is_large)
    for name in ("TUNE", "WATCH"):
        job(page, name).click()
        until(page, lambda: share(page, "[data-pane=scope] .uplot", "[data-pane=scope]") >= 0.5)


def test_the_editor_and_the_scope_open_in_the_largest_place(page: Page) -> None:
    page.locator(".bench-tab-text", has_text="ALARMS").click()
    page.evaluate("import('/js/bench/workspace.js').then((each) => each.openPane('scope'))")
    beside = page.locator(".dv-groupview", has=page.locator(".bench-tab-text", has_text="Editor"))
    expect(beside.locator(".bench-tab-text")).to_have_text(["Editor", "Scope"])


def test_the_first_load_is_at_most_450_kilobytes(browser: Browser, served: Served) -> None:
    context = browser.new_context(viewport={"width": 1366, "height": 768})
    sizes: list[int] = []
    page = context.new_page()
    page.on("requestfinished", lambda each: sizes.append(each.sizes()["responseBodySize"]))
    page.goto(f"{served.url}/bench")
    page.wait_for_selector("[data-pane=editor] .cm-line")
    page.wait_for_selector("[data-pane=terminal] .xterm-rows")
    page.wait_for_load_state("networkidle")
    assert len(sizes) > 50
    assert sum(sizes) <= 450_000
    context.close()


# --- shortcuts ------------------------------------------------------------------------


def test_the_list_of_shortcuts_has_each_key_of_the_table_and_opens_by_f1_and_question_mark(
    page: Page,
) -> None:
    rows = page.evaluate(
        "import('/js/bench/actions.js')"
        ".then(({ ACTIONS }) => Object.values(ACTIONS).map((each) => each.keys))"
    )
    assert len(rows) > 9
    page.locator("[data-pane=editor] .cm-content").click()
    page.keyboard.press("?")
    expect(page.get_by_role("dialog")).to_have_count(0)  # it is typed
    page.keyboard.press("Backspace")
    page.keyboard.press("F1")
    shown = page.get_by_role("dialog", name="SHORTCUTS")
    expect(shown.locator("kbd")).to_have_text([*rows, "Alt+1 \u2026 Alt+9", "Pause"])
    page.keyboard.press("Alt+P")  # not over a dialog
    expect(page.get_by_role("dialog")).to_have_count(1)
    page.keyboard.press("Escape")
    page.locator(".bench-tab-text", has_text="ALARMS").click()
    page.keyboard.press("?")
    expect(shown).to_be_visible()


def test_keys_show_their_shortcuts_and_one_that_types_a_sign_is_none(page: Page) -> None:
    expect(page.get_by_role("button", name="PANES")).to_have_attribute("title", "PANES (Alt+P)")
    expect(job(page, "TUNE")).to_have_attribute("aria-keyshortcuts", "Control+Alt+2")
    found = page.evaluate("""() => import('/js/bench/actions.js').then(({ isPressed }) => {
      const event = (more) => new KeyboardEvent('keydown', { code: 'Digit2', ...more });
      const keys = 'Ctrl+Alt+2';
      const both = { ctrlKey: true, altKey: true };
      return [both, { ...both, modifierAltGraph: true }, { altKey: true },
        { ...both, shiftKey: true }, { ...both, metaKey: true }]
        .map((each) => isPressed(event(each), keys));
    })""")
    assert found == [True, False, False, False, False]
