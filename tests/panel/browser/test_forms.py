"""Forms and the editor keep what the operator has typed until it is saved or dropped."""

import pytest
from playwright.sync_api import Page, Route, expect
from tests.panel.bench import Served
from tests.panel.browser.conftest import let_through, until

from openacr.sysvar.tabs import JOG, SPEEDS

# Type into another field between a save and its answer.
TYPED_MEANWHILE = """([id, text]) => {
  const fetched = window.fetch;
  window.fetch = async (...asked) => {
    const answer = await fetched(...asked);
    if (asked[1]?.method === 'PUT') {
      window.fetch = fetched;
      const field = document.getElementById(id);
      field.value = text;
      field.dispatchEvent(new Event('input'));
    }
    return answer;
  };
}"""

# Store a value as another operator would.
CHANGED_ELSEWHERE = """async ([number, text]) => {
  const { send } = await import('/js/core/api.js');
  await send('PUT', 'forms/SPEEDS', { values: { [number]: text } });
}"""


def parameters(page: Page, tab: str) -> None:
    """Open a tab of the system parameters."""
    page.keyboard.press("F8")
    page.keyboard.press("F1")
    page.get_by_role("tab", name=tab, exact=True).click()


def test_a_refused_value_stays_in_its_field_with_the_reason(page: Page) -> None:
    parameters(page, "Servo")
    field = page.locator("#cell-150003")
    field.fill("11")
    page.get_by_role("button", name="SAVE", exact=True).click()
    expect(page.locator("#cell-150003-refusal")).to_have_text(
        "P150003 I Limit (axis 0) cannot be 11: a number from 0 to 10 [V] (Limit of the integral"
        " term.)"
    )
    expect(page.locator("#prompt")).to_have_text("⚠ Not saved; refused: 1")
    assert field.input_value() == "11"
    assert field.get_attribute("aria-invalid") == "true"
    page.get_by_role("button", name="UNDO").click()
    expect(page.locator("#cell-150003")).to_have_value("0")


def test_a_saved_value_is_in_the_store_and_on_the_screen(page: Page, served: Served) -> None:
    parameters(page, "Jog")
    number = JOG.increments[2][0]
    field = page.locator(f"#cell-{number}")
    field.fill("1.5")
    page.get_by_role("button", name="SAVE", exact=True).click()
    expect(page.locator("#prompt")).to_have_text("Saved: 1")
    assert served.call(lambda station: station.link.machine.runner.settings.real(number)) == 1.5
    expect(page.get_by_role("button", name="SAVE", exact=True)).to_be_disabled()
    expect(page.locator(f"#cell-{number}")).to_have_value("1.5")


def test_what_is_typed_while_a_save_is_under_way_stays_and_so_does_the_focus(
    page: Page, served: Served
) -> None:
    parameters(page, "Speeds")
    store = served.panel.installation.store
    other = store.read(SPEEDS.cut_speed)
    field = page.locator(f"#cell-{SPEEDS.trial_speed}")
    later = page.locator(f"#cell-{SPEEDS.cut_speed}")
    page.evaluate(TYPED_MEANWHILE, [f"cell-{SPEEDS.cut_speed}", "321"])
    field.fill("432")
    field.press("Enter")
    expect(page.locator("#prompt")).to_have_text("Saved: 1")
    expect(page.locator(".form-foot .hint")).to_have_text("Not saved: 1")
    expect(later).to_have_value("321")
    expect(field).to_have_value("432")
    expect(field).to_be_focused()
    assert (store.read(SPEEDS.trial_speed), store.read(SPEEDS.cut_speed)) == (432.0, other)
    field.press("Enter")
    expect(page.locator(".form-foot .hint")).to_have_text("")
    assert store.read(SPEEDS.cut_speed) == 321.0


def test_a_reason_stays_with_its_value_when_an_older_question_is_answered_after_it(
    page: Page,
) -> None:
    parameters(page, "Speeds")
    field = page.locator(f"#cell-{SPEEDS.cut_speed}")
    expect(field).to_be_visible()
    held: list[Route] = []
    page.route(
        "**/api/forms/**",
        lambda route: held.append(route) if route.request.method == "GET" else route.continue_(),
    )
    with page.expect_request(lambda asked: asked.method == "GET" and "/forms/" in asked.url):
        page.evaluate(CHANGED_ELSEWHERE, [str(SPEEDS.trial_speed), "234"])
    field.fill("-1")
    page.get_by_role("button", name="SAVE", exact=True).click()
    reason = page.locator(f"#cell-{SPEEDS.cut_speed}-refusal")
    expect(reason).to_contain_text("cannot be -1")
    for route in held:
        route.continue_()
    expect(page.locator(f"#cell-{SPEEDS.trial_speed}")).to_have_value("234")
    expect(reason).to_contain_text("cannot be -1")
    expect(field).to_have_value("-1")
    expect(field).to_have_attribute("aria-invalid", "true")
    page.unroute("**/api/forms/**")


def test_the_axis_of_a_form_that_was_chosen_last_is_shown(page: Page) -> None:
    """However late the answer for the one before comes."""
    parameters(page, "Servo")
    axis = page.get_by_role("radiogroup", name="Axis").get_by_role("radio")
    expect(axis.filter(has_text="X")).to_be_checked()
    field = page.locator("#screen .form-rows input").first
    of_x = field.get_attribute("id")
    held: list[Route] = []
    asked = "**/api/forms/SERVO?*"
    page.route(asked, lambda route: route.continue_() if held else held.append(route))
    with page.expect_request(asked):
        axis.filter(has_text="Y").click()
    axis.filter(has_text="Z").click()
    expect(axis.filter(has_text="Z")).to_be_checked()
    of_z = field.get_attribute("id")
    until(page, lambda: held)
    let_through(page, held[0])
    expect(axis.filter(has_text="Z")).to_be_checked()
    assert field.get_attribute("id") == of_z != of_x
    page.unroute(asked)


def test_a_search_shows_what_was_typed_last(page: Page) -> None:
    """However late the answer to the word before comes."""
    parameters(page, "Servo")
    held: list[Route] = []
    early = "**/api/settings/search?text=feed"
    page.route(early, lambda route: held.append(route))
    field = page.get_by_role("searchbox")
    with page.expect_request(early):
        field.fill("feed")
    field.fill("no such parameter")
    found = page.locator(".search-results")
    expect(found).to_have_text("Nothing found")
    until(page, lambda: held)
    let_through(page, held[0])
    expect(found).to_have_text("Nothing found")
    page.unroute(early)


def test_a_form_with_changes_asks_before_it_is_left(page: Page) -> None:
    parameters(page, "Servo")
    field = page.locator("#cell-150003")
    field.fill("2")
    page.keyboard.press("Escape")
    question = page.get_by_role("dialog", name="Not saved")
    expect(question.locator("p")).to_have_text("Changes that are lost without SAVE: 1")
    question.get_by_role("button", name="CANCEL").click()
    assert field.input_value() == "2"
    page.keyboard.press("Escape")
    question.get_by_role("button", name="DROP").click()
    expect(page.locator("#screen")).to_be_hidden()
    parameters(page, "Servo")
    expect(field).to_have_value("0")


def test_the_editor_marks_an_error_and_asks_before_changes_are_lost(page: Page) -> None:
    page.keyboard.press("F4")
    page.get_by_role("dialog", name="OPEN").get_by_role("button", name="OPEN").click()
    text = page.locator(".cm-content")
    expect(text).to_contain_text("Plate 80 x 50 mm")
    text.click()
    page.keyboard.press("Control+Home")
    page.keyboard.type("G999 X1\n")
    expect(page.locator(".findings .error")).to_have_text("⚠1:1E203 unknown G code: G999")
    expect(page.locator(".cm-lint-marker-error")).to_have_count(1)
    expect(page.locator("#screen-title")).to_have_text("Edit: plate.nc *")
    page.keyboard.press("Escape")
    question = page.get_by_role("dialog", name="Not saved")
    expect(question.locator("p")).to_have_text("plate.nc has changes that are not saved.")
    question.get_by_role("button", name="CANCEL").click()
    expect(text).to_contain_text("G999 X1")
    page.keyboard.press("Escape")
    question.get_by_role("button", name="DROP").click()
    expect(page.locator("#screen")).to_be_hidden()


def test_a_new_text_is_saved_under_the_name_that_is_asked_for(page: Page, served: Served) -> None:
    page.keyboard.press("F4")
    page.get_by_role("dialog", name="OPEN").get_by_role("button", name="OPEN").click()
    expect(page.locator(".cm-content")).to_contain_text("Plate 80 x 50 mm")
    page.get_by_role("button", name="NEW", exact=True).click()
    expect(page.locator("#screen-title")).to_have_text("Edit: new file")
    page.keyboard.type("G0 X1")
    page.get_by_role("button", name="SAVE", exact=True).click()
    page.get_by_label("File name (.TXT)").fill("FIRST.TXT")
    page.keyboard.press("Enter")
    expect(page.locator("#prompt")).to_have_text("FIRST.TXT is saved")
    assert (served.programs / "FIRST.TXT").read_text() == "G0 X1"


@pytest.mark.parametrize("enters", ["click", "tap"])
def test_a_number_field_entered_by_mouse_or_finger_is_selected_so_that_a_digit_replaces_it(
    page: Page, enters: str
) -> None:
    parameters(page, "Speeds")
    field = page.locator(f"#cell-{SPEEDS.cut_speed}")
    field.fill("12")
    page.locator(f"#cell-{SPEEDS.trial_speed}").focus()
    getattr(field, enters)()
    page.keyboard.press("3")
    expect(field).to_have_value("3")
    field.press("ArrowLeft")
    getattr(field, enters)(position={"x": 3, "y": 10})  # in the field already: it places the caret
    page.keyboard.press("4")
    assert sorted(field.input_value()) == ["3", "4"]
    page.locator(f"label[for=cell-{SPEEDS.trial_speed}]").click()
    page.keyboard.press("7")
    expect(page.locator(f"#cell-{SPEEDS.trial_speed}")).to_have_value("7")
    page.get_by_role("button", name="UNDO").click()


def test_what_is_marked_with_the_mouse_in_a_number_field_stays_marked(page: Page) -> None:
    parameters(page, "Speeds")
    field = page.locator(f"#cell-{SPEEDS.cut_speed}")
    field.fill("1234")
    page.locator(f"#cell-{SPEEDS.trial_speed}").focus()
    box = field.bounding_box()
    assert box is not None
    right, middle = box["x"] + box["width"] - 10, box["y"] + box["height"] / 2
    page.mouse.move(right, middle)
    page.mouse.down()
    page.mouse.move(right - 12, middle, steps=4)
    page.mouse.up()
    marked = field.evaluate("(each) => each.selectionEnd - each.selectionStart")
    assert 0 < marked < 4
    page.get_by_role("button", name="UNDO").click()
