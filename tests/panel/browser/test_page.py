"""Parts of the operator's page: numbers and their pad, the tour, what its top says of a machine."""

import pytest
from playwright.sync_api import Page, expect
from tests.panel.bench import Served
from tests.panel.browser.conftest import READY, to_main_menu

# --- numbers --------------------------------------------------------------------------

CALLED = """([place, name, all]) => import(`/js/core/${place}.js`)
  .then((module) => all.map((args) => module[name](...args)))"""


def called(page: Page, place: str, name: str, arguments: list[tuple[object, ...]]) -> list[object]:
    """What a function of the screens makes of each of several lists of arguments."""
    found: list[object] = page.evaluate(CALLED, [place, name, [list(each) for each in arguments]])
    return found


def test_the_pad_computes_sums_and_refuses_what_is_none(page: Page) -> None:
    sums: dict[str, float | None] = {
        "12": 12, "-3.5": -3.5, ".5": 0.5, "1,25": 1.25, "25.4*3/8": 9.525, "2+3*4": 14,
        "(2+3)*4": 20, "10-4-3": 3, "8/4/2": 1, "-(1+2)": -3, "2*-3": -6, " 1 + 1 ": 2,
        "\u22125": -5, "3\u00d72\u00f74": 1.5, "": None, "1+": None, "1 2": None, "(1": None,
        "1)": None, "x": None, "1/0": None, "1e3": None, "*2": None, "0/0": None,
    }  # fmt: skip
    found = called(page, "arithmetic", "evaluate", [(text,) for text in sums])
    assert dict(zip(sums, found, strict=True)) == sums
    entered = called(page, "arithmetic", "tidy", [(0.1 + 0.2,), (9.525,), (-0.0,), (1e-7,)])
    assert entered == ["0.3", "9.525", "0", "1e-7"]  # without the tail of binary fractions


def test_a_position_keeps_a_place_for_its_sign_and_never_shows_a_negative_zero(page: Page) -> None:
    found = called(page, "format", "position", [(1.5, 3), (-1.5, 3), (-0.0004, 3), (0.0, 2)])
    assert found == ["\u20071.500", "\u22121.500", "\u20070.000", "\u20070.00"]


def test_a_duration_shows_hours_only_where_there_are_some(page: Page) -> None:
    found = called(page, "format", "duration", [(0,), (59.6,), (61,), (3600,), (3725,)])
    assert found == ["0:00", "1:00", "1:01", "1:00:00", "1:02:05"]


def test_the_pad_enters_by_keys_and_keeps_a_wrong_text_open(page: Page) -> None:
    page.evaluate("""import('/js/frame/number_pad.js').then((pad) => { window.chosen =
        pad.askNumber({ title: 'Depth', value: 5, check: (n) => n > 9 ? 'at most 9' : '' }) })""")
    dialog = page.get_by_role("dialog", name="Depth")
    for key in ("clear", "1", "2", "+"):
        dialog.get_by_role("button", name=key, exact=True).click()
    dialog.get_by_role("button", name="OK").click()
    expect(dialog).to_contain_text("Not a number")
    dialog.get_by_role("button", name="1", exact=True).click()
    page.keyboard.press("Enter")
    expect(dialog).to_contain_text("at most 9")
    field = dialog.get_by_role("textbox")
    field.fill("2*3")
    expect(dialog).to_contain_text("= 6")
    field.press("Enter")
    expect(dialog).to_have_count(0)
    assert page.evaluate("window.chosen") == 6


def speak(page: Page, language: str) -> None:
    page.evaluate("(it) => localStorage.setItem('openacr.panel.language', it)", language)
    page.reload()
    page.wait_for_function(READY)


def test_help_speaks_the_language_of_the_screens(page: Page) -> None:
    for language, title, said in (
        ("de", "REFERENZ", "solche mit Priorität 0 nie"), ("en", "HOME", "priority 0 are never"),
    ):  # fmt: skip
        speak(page, language)
        to_main_menu(page)
        page.keyboard.press("F9")
        text = page.locator("#screen .help-text")
        expect(text.locator("h2")).to_have_text(title)
        expect(text).to_contain_text(said)


# --- the tour -------------------------------------------------------------------------

STEPS = """() => import('/js/tour/steps.js').then(({ STEPS }) => STEPS.map(([place]) => place))"""
TEXTS = """(language) =>
  Promise.all([import('/js/tour/steps.js'), import('/js/catalog/operator.js')])
  .then(([{ STEPS }, texts]) => STEPS.map(([, key]) => texts.default[key][language]))"""
COVERED = """() => {
  const [box, stop] = ['.tour', '.stop-key']
    .map((each) => document.querySelector(each).getBoundingClientRect());
  const found = document.elementFromPoint(stop.x + stop.width / 2, stop.y + stop.height / 2);
  return !found.closest('.stop-key') || box.top < 0 || box.bottom > stop.top;
}"""


def begin(page: Page, title: str = "TOUR") -> None:
    to_main_menu(page)
    page.keyboard.press("F9")
    page.locator("#screen").get_by_role("button", name=title, exact=True).click()
    expect(page.locator(".tour")).to_be_visible()
    expect(page.locator("#screen")).to_be_hidden()


def is_framed(page: Page, place: str) -> None:
    """Wait until the tour frames this part alone."""
    page.wait_for_function(
        "(place) => { const all = [...document.querySelectorAll('.is-framed')];"
        " return all.length === 1 && all[0].matches(place); }", arg=place,
    )  # fmt: skip


@pytest.mark.parametrize("language", ["en", "de"])
def test_the_tour_frames_one_part_after_the_other_and_escape_ends_it(
    page: Page, language: str
) -> None:
    if language == "de":
        speak(page, language)
    begin(page, "TOUR" if language == "en" else "RUNDGANG")
    places, texts = page.evaluate(STEPS), page.evaluate(TEXTS, language)
    assert len(places) == len(set(places)) == len(set(texts)) == 6
    for place, text in zip(places, texts, strict=True):
        is_framed(page, place)
        expect(page.locator(".tour p")).to_have_text(text)
        page.keyboard.press("ArrowRight")
    is_framed(page, places[-1])  # the arrow ends nothing
    page.keyboard.press("ArrowLeft")
    is_framed(page, places[-2])
    page.keyboard.press("Escape")
    expect(page.locator(".tour")).to_have_count(0)
    expect(page.locator(".is-framed")).to_have_count(0)
    if language == "de":
        speak(page, "en")


def test_next_after_the_last_part_ends_the_tour_and_stop_is_never_covered(page: Page) -> None:
    for width, height in ((1024, 768), (360, 640)):
        page.set_viewport_size({"width": width, "height": height})
        begin(page)
        for _ in page.evaluate(STEPS):
            page.wait_for_function(f"() => !({COVERED})()")
            page.locator(".tour").get_by_role("button", name="NEXT").click()
        expect(page.locator(".tour")).to_have_count(0)
    page.set_viewport_size({"width": 1024, "height": 768})


# --- modes -----------------------------------------------------------------------------

LACKS = "PROG0 is an ordinary program of the card now"


def test_what_acromill_misses_is_at_the_top_with_the_key_that_sets_it_up(
    page: Page, served: Served
) -> None:
    top = page.locator("#alarms")
    served.call(lambda station: station.hand_over(LACKS))
    expect(top).to_contain_text(LACKS)
    top.get_by_role("button", name="SET UP").click()
    dialog = page.get_by_role("dialog")
    expect(dialog).to_contain_text("what was attached and set there is lost")
    dialog.get_by_role("button", name="SET UP").click()
    expect(top).not_to_contain_text(LACKS)
    expect(page.locator("#prompt")).to_contain_text("AcroMill has set the card up")


def test_a_moment_of_the_past_is_said_at_the_top_without_an_alarm(
    page: Page, served: Served
) -> None:
    top = page.locator("#alarms")
    tick = served.call(lambda station: station.times.history.lived_tk)
    served.call(lambda station: station.times.seek(tick // 2))
    expect(top).to_contain_text("s BEFORE THE END")
    expect(top.get_by_role("button")).to_have_count(0)
    served.call(lambda station: station.times.operate(station.now_s))
    expect(top).not_to_contain_text("BEFORE THE END")
    expect(top).not_to_contain_text("Watchdog")
