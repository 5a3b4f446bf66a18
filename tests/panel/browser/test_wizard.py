"""The configuration wizard of the workspace: from nothing to code, and back from code."""

from pathlib import Path

import pytest
from playwright.sync_api import BrowserContext, Page, expect
from tests.panel.bench import Served
from tests.panel.browser.conftest import open_page
from tests.panel.browser.test_bench import again, open_pane

from openacr.configure import parse_answers
from openacr.controller import Controller

GANTRY = Path(__file__).parents[3] / "examples" / "gantry"


@pytest.fixture(scope="module")
def workspace(context: BrowserContext, served: Served) -> Page:
    """The workspace with the wizard."""
    page = open_page(context, f"{served.url}/bench")
    page.set_viewport_size({"width": 1280, "height": 800})
    open_pane(page, "Configuration")
    return page


@pytest.fixture
def page(workspace: Page) -> Page:
    """The wizard with the answers it begins with."""
    workspace.get_by_role("button", name="NEW", exact=True).click()
    expect(workspace.locator(".wizard-title")).to_have_text(["Card", "Axis 0: X", "Master 0"])
    return workspace


def dialog(page: Page, where: str) -> None:
    page.locator(f"#wizard-{where}").click()
    expect(page.locator(f"#wizard-{where}")).to_have_attribute("aria-current", "true")


def answer(page: Page, key: str, text: str) -> None:
    field = page.locator(f"#wizard-{key}")
    field.fill(text)
    field.press("Tab")


def downloaded(page: Page, name: str) -> str:
    page.get_by_role("tab", name=name, exact=True).click()
    with page.expect_download() as begun:
        page.get_by_role("button", name=f"DOWNLOAD {name}").click()
    assert begun.value.suggested_filename == name
    return begun.value.path().read_text()


def test_two_axes_and_a_master_become_code_that_runs(page: Page, tmp_path: Path) -> None:
    page.get_by_role("button", name="ADD AXIS").click()
    dialog(page, "axis-1")
    expect(page.locator("#wizard-name")).to_have_value("Y")
    answer(page, "units_per_rev", "10")
    dialog(page, "axis-1-limits")
    answer(page, "soft", "0, 24.5")
    expect(page.locator(".wizard-code .notice.bad")).to_have_text(
        "Axis 1: Y, the positive limit is not above the negative"
    )
    answer(page, "soft", "24,5, 0")  # a decimal comma
    expect(page.locator(".wizard-code .notice.bad")).to_have_count(0)
    page.locator("#wizard-soft_is_enabled").select_option("0")
    dialog(page, "master-0")
    expect(page.locator(".wizard-code .notice")).to_contain_text("axis Y has no master")
    answer(page, "axes", "X Y")
    expect(page.locator(".wizard-code .notice")).to_have_count(0)
    text = downloaded(page, "configure.toml")
    (tmp_path / "setup.8k").write_text(downloaded(page, "setup.8k"))
    answers = parse_answers(text)
    assert [(axis.name, axis.units_per_rev) for axis in answers.axis] == [("X", 5.0), ("Y", 10.0)]
    assert (answers.axis[1].limits.soft, answers.axis[1].limits.soft_is_enabled) == (
        (24.5, 0.0), False,
    )  # fmt: skip
    assert answers.master[0].axes == ("X", "Y")
    card = Controller.from_project(tmp_path)
    assert card.send("ECHO 4\rSYS\rAXIS1 SLM\r").split()[-1] == "24.5,0"


def test_a_wrong_answer_is_marked_at_its_dialog_and_its_field(page: Page) -> None:
    dialog(page, "axis-0")
    answer(page, "units_per_rev", "-1")
    expect(page.locator("#wizard-units_per_rev")).to_have_attribute("aria-invalid", "true")
    expect(page.locator(".wizard-form .refusal")).to_contain_text("expected `float` > 0.0")
    expect(page.locator("#wizard-axis-0 .bad-text")).to_be_visible()
    expect(page.locator("#wizard-axis-0-gains .bad-text")).to_have_count(0)
    expect(page.get_by_role("tab", name="setup.8k")).to_have_count(0)
    answer(page, "units_per_rev", "2,5")
    expect(page.locator(".wizard-form .refusal")).to_have_count(0)
    expect(page.get_by_role("region", name="setup.8k")).to_contain_text("AXIS0 PPU 3200.000000")


def test_answers_outlive_the_page_and_end_with_new(page: Page) -> None:
    dialog(page, "axis-0-gains")
    answer(page, "pgain", "0.5")
    expect(page.get_by_role("region", name="setup.8k")).to_contain_text("AXIS0 PGAIN 0.5")
    again(page)
    expect(page.get_by_role("region", name="setup.8k")).to_contain_text("AXIS0 PGAIN 0.5")
    page.get_by_role("button", name="NEW", exact=True).click()
    expect(page.get_by_role("region", name="setup.8k")).to_contain_text("AXIS0 PGAIN 0.002441")


def test_code_that_is_opened_becomes_answers_with_notes(page: Page, tmp_path: Path) -> None:
    text = (GANTRY / "setup.8k").read_text() + "\nSYS\nAXIS0 JOG VEL 7\n"
    (tmp_path / "setup.8k").write_text(text)
    page.locator(".pane-head input[type=file]").set_input_files(tmp_path / "setup.8k")
    expect(page.locator("#prompt")).to_contain_text("Answers were read from setup.8k")
    expect(page.locator(".wizard-title")).to_have_text(
        ["Card", "Axis 0: X", "Axis 1: Y", "Axis 2: Z", "Master 0", "Master 1"]
    )
    expect(page.locator(".wizard-code .notice")).to_contain_text("AXIS0 JOG VEL is 7")
    dialog(page, "axis-2")
    page.get_by_role("button", name="REMOVE Axis 2: Z").click()
    expect(page.locator(".wizard-title")).to_have_count(5)
    expect(page.locator(".wizard-code .notice.bad")).to_have_text(
        "Master 1, Z is no axis of this file"
    )
