"""The bench on a project: its texts are kept in its folder."""

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, BrowserContext, Locator, Page, expect
from tests.panel.bench import Served
from tests.panel.browser.conftest import open_page, picture, until_model
from tests.panel.browser.test_bench import open_pane, show_pane

from openacr.client import Level
from openacr.panel.machine.project import of_project

EXAMPLES = Path(__file__).parents[3] / "examples"
ONE = "PROGRAM\n_more\n' as fast as it can\nP5 = P5+1\nGOTO more\nENDP\n"

HELD = """() => import('/js/core/app.js').then(({ link }) => {
  window.pressed = [];
  const command = link.command;
  link.command = (name, args) => {
    if (name.startsWith('jog.press')) window.pressed.push(name);
    return command.call(link, name, args);
  };
})"""


@pytest.fixture(scope="module")
def gantry(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = shutil.copytree(EXAMPLES / "gantry", tmp_path_factory.mktemp("project") / "gantry")
    (folder / "prog1.8k").write_text(f"' Z\n{ONE}")
    return folder


@pytest.fixture(scope="module")
def served(gantry: Path) -> Iterator[Served]:
    parts = gantry.parent / "parts"
    installation = of_project(gantry, store=None, programs=None, otherwise=parts)
    panel = Served(gantry.parent, installation=installation)
    yield panel
    panel.close()


@pytest.fixture(scope="module")
def workspace(context: BrowserContext, served: Served) -> Page:
    context.set_default_timeout(60_000)
    page = open_page(context, f"{served.url}/bench")
    page.set_viewport_size({"width": 1366, "height": 768})
    until_model(page, "model.hello.value.client")
    return page


@pytest.fixture
def page(workspace: Page) -> Iterator[Page]:
    yield workspace
    assert workspace.complaints == []  # type: ignore[attr-defined]


def programs(page: Page) -> Locator:
    return page.locator("[data-pane=programs]")


def listed(page: Page, name: str) -> Locator:
    return programs(page).locator(f"[data-name={name}]")


def download(served: Served, text: str) -> None:
    served.call(lambda station: station.link.machine.card.download(text, to=Level.program(1)))


def test_a_changed_program_is_signed_and_saved_into_the_project(
    page: Page, served: Served, gantry: Path
) -> None:
    size = listed(page, "PROG1").locator(".number")
    before = size.inner_text()
    show_pane(page, "editor")
    editor = page.locator("[data-pane=editor]")
    editor.get_by_label("Program or file").select_option("PROG1")
    expect(editor.locator(".cm-line").nth(2)).to_have_text("' as fast as it can")
    foot = editor.locator(".text-foot .hint")
    expect(foot).not_to_contain_text("differs")
    editor.locator(".cm-line").nth(3).click()
    page.keyboard.press("End")
    page.keyboard.insert_text(":P6 = 100000")
    editor.get_by_role("button", name="DOWNLOAD", exact=True).click()
    expect(foot).to_contain_text("the card differs from prog1.8k of the project")
    page.locator(".bench-tab-text", has_text="Programs").click()
    expect(listed(page, "PROG1").locator(".program-differs")).to_have_text("≠ project")
    expect(size).not_to_have_text(before)  # without READ
    page.locator(".bench-tab-text", has_text="Editor").click()
    editor.get_by_role("button", name="SAVE INTO PROJECT", exact=True).click()
    expect(foot).not_to_contain_text("differs")
    text = f"' Z\n{ONE}".replace("P5+1", "P5+1:P6 = 100000")
    assert (gantry / "prog1.8k").read_text() == text
    page.locator(".bench-tab-text", has_text="Programs").click()
    expect(listed(page, "PROG1").locator(".program-differs")).to_be_empty()


def test_the_text_of_the_project_is_opened_beside_another_one_of_the_card(
    page: Page, served: Served, gantry: Path
) -> None:
    page.locator(".bench-tab-text", has_text="Editor").click()
    editor = page.locator("[data-pane=editor]")
    theirs = editor.get_by_role("button", name="PROJECT'S TEXT")
    expect(theirs).to_be_hidden()
    download(served, "PROGRAM\nP5 = 9\nENDP\n")
    editor.get_by_role("button", name="READ", exact=True).click()
    expect(editor.locator(".cm-line").nth(1)).to_have_text(" P5 = 9")
    theirs.click()
    expect(editor.locator(".cm-line").nth(2)).to_have_text("' as fast as it can")
    editor.get_by_label("Program or file").select_option("PROG0")
    dialog = page.get_by_role("dialog")
    expect(dialog.get_by_role("button")).to_have_text(
        ["CANCEL", "DROP", "SAVE INTO PROJECT", "DOWNLOAD"]
    )
    dialog.get_by_role("button", name="DOWNLOAD").click()
    expect(editor.locator(".text-foot .hint")).to_contain_text("PROG0")
    assert "100000" in served.call(
        lambda station: station.link.machine.card.upload(Level.program(1))
    )


def test_an_axis_is_measured_with_the_fields_as_they_are(page: Page, served: Served) -> None:
    served.call(lambda station: station.link.machine.card.command("AXIS0 DRIVE ON"))
    open_pane(page, "Tuning")
    page.get_by_role("button", name="MEASURE").click()
    dialog = page.get_by_role("dialog", name="MEASURE")
    expect(dialog).to_contain_text("for 1.5 s at most")
    dialog.get_by_role("button", name="MEASURE").click()
    expect(page.locator(".tune-chart canvas")).to_have_count(5)
    tune = page.locator("[data-pane=tune]")
    expect(tune).to_contain_text("Measured for 0.55 s")
    worse = tune.locator("[data-worse=overshoot_percent]")
    expect(worse).to_contain_text("overshoot of a step, % 22")


def test_an_axis_that_only_the_card_has_is_seen_in_the_loop_and_gets_gains(
    page: Page, served: Served
) -> None:
    show_pane(page, "servo")
    loop = page.locator("[data-pane=servo]")
    loop.get_by_role("radio", name="Z (AXIS2)").click()
    served.call(
        lambda station: station.link.machine.machine.write(12288 + 512 + 8, 321)
    )  # gear offset
    expect(loop.locator("[data-box=gear] .value")).to_have_text("321")
    served.call(lambda station: station.link.machine.machine.write(12288 + 512 + 8, 0))
    open_pane(page, "Gains")
    gains = page.locator("[data-pane=gain]")
    gains.get_by_role("radio", name="Z (AXIS2)").click()
    field = gains.get_by_label("P Gain")
    field.fill("0.0021")
    field.press("Enter")
    expect(page.locator("#prompt")).to_contain_text("0.0021")
    gain = served.call(lambda station: station.link.machine.card.read("axis2.proportional gain"))
    assert gain == pytest.approx(0.0021)


def test_arrow_keys_jog_while_the_focus_is_in_the_pane_and_never_from_another(page: Page) -> None:
    open_pane(page, "Jog")
    jog = page.locator("[data-pane=jog]")
    key = jog.get_by_role("button", name="X plus")
    show_pane(page, "editor")
    page.locator("[data-pane=editor] .cm-line").first.click()
    page.evaluate(HELD)
    page.keyboard.press("ArrowRight")
    assert page.evaluate("window.pressed") == []
    page.locator(".bench-tab-text", has_text="Jog").click()
    key.focus()
    page.keyboard.press("ArrowRight")
    page.wait_for_function("window.pressed.length")
    assert page.evaluate("window.pressed") == ["jog.press"]
    page.get_by_role("button", name="CLOSE PANE").click()
    expect(jog).to_have_count(0)


# --- a mouse, and keys ----------------------------------------------------------------


def test_a_mouse_has_the_dense_form_in_which_lines_and_values_are_seen(
    browser: Browser, served: Served, pictures: Path
) -> None:
    with browser.new_context(viewport={"width": 1366, "height": 768}) as context:
        page = open_page(context, f"{served.url}/bench")
        until_model(page, "model.hello.value.client")
        key = page.locator("[data-pane=terminal] .pane-head .key").first
        box = key.bounding_box()
        assert box is not None
        assert box["height"] == 28
        line = page.get_by_label("Line for the card")
        pane = page.locator("[data-pane=terminal]")
        assert bottom(line) <= bottom(pane)
        show_pane(page, "editor")
        page.locator("[data-pane=editor]").get_by_label("Program or file").select_option("PROG0")
        expect(page.locator("[data-pane=editor] .cm-line").first).to_have_text("PROGRAM")
        picture(page, pictures / "bench_dense.png")
        code = page.locator("[data-pane=editor] .editor-host").bounding_box()
        assert code is not None
        assert code["height"] > 100
        assert page.complaints == []  # type: ignore[attr-defined]


def bottom(place: Locator) -> float:
    box = place.bounding_box()
    assert box is not None
    return box["y"] + box["height"]


def test_keys_show_panes_and_run_and_step_a_program(page: Page, served: Served) -> None:
    download(served, "PROGRAM\nP7 = 1\nP8 = 2\nENDP\n")
    page.locator(".bench-tab-text", has_text="Programs").click()
    listed(page, "PROG1").click()
    page.locator(".bench-tab-text", has_text="PLC").click()
    page.keyboard.press("Alt+r")  # first the pane is shown
    expect(programs(page)).to_be_visible()
    page.keyboard.press("Alt+r")
    dialog = page.get_by_role("dialog", name="Start PROG1?")
    page.keyboard.press("Alt+p")  # not over a dialog
    expect(page.get_by_role("dialog")).to_have_count(1)
    dialog.get_by_role("button", name="RUN").click()
    until_model(page, "model.programs.value.programs.length")
    programs(page).get_by_role("button", name="BLOCK").click()
    expect(programs(page).get_by_role("button", name="STEP")).to_have_attribute("title", "Alt+S")
    page.keyboard.press("Alt+p")
    expect(page.get_by_role("dialog", name="PANES")).to_be_visible()
    page.keyboard.press("Escape")
    page.keyboard.press("Alt+2")
    expect(page.locator("[data-pane=plc]")).to_be_visible()
    page.keyboard.press("Alt+9")
