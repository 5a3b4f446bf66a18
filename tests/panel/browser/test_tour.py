"""The tour of the operator's screen: begun from HELP, by keyboard, in both languages."""

import pytest
from playwright.sync_api import Page, expect
from tests.panel.browser.conftest import READY, to_main_menu

STEPS = """() => import('/js/tour/steps.js').then(({ STEPS }) => STEPS.map(([place]) => place))"""
TEXTS = """(language) =>
  Promise.all([import('/js/tour/steps.js'), import(`/js/catalog/${language}.js`)])
  .then(([{ STEPS }, texts]) => STEPS.map(([, key]) => texts.default[key]))"""
COVERED = """() => {
  const [box, stop] = ['.tour', '.stop-key']
    .map((each) => document.querySelector(each).getBoundingClientRect());
  const found = document.elementFromPoint(stop.x + stop.width / 2, stop.y + stop.height / 2);
  return !found.closest('.stop-key') || box.top < 0 || box.bottom > stop.top;
}"""


def reload(page: Page) -> None:
    page.reload()
    page.wait_for_function(READY)


def begin(page: Page, title: str = "TOUR") -> None:
    to_main_menu(page)
    page.keyboard.press("F9")
    page.locator("#screen").get_by_role("button", name=title, exact=True).click()
    expect(page.locator(".tour")).to_be_visible()
    expect(page.locator("#screen")).to_be_hidden()


def is_framed(page: Page, place: str) -> bool:
    return bool(page.evaluate(
        "(place) => { const all = [...document.querySelectorAll('.is-framed')];"
        " return all.length === 1 && all[0].matches(place); }", place,
    ))  # fmt: skip


@pytest.mark.parametrize("language", ["en", "de"])
def test_the_tour_frames_one_part_after_the_other_and_escape_ends_it(
    page: Page, language: str
) -> None:
    page.evaluate("(it) => localStorage.setItem('openacr.panel.language', it)", language)
    reload(page)
    begin(page, "TOUR" if language == "en" else "RUNDGANG")
    places, texts = page.evaluate(STEPS), page.evaluate(TEXTS, language)
    assert len(places) == len(set(places)) == len(set(texts)) == 6
    for place, text in zip(places, texts, strict=True):
        assert is_framed(page, place), place
        expect(page.locator(".tour p")).to_have_text(text)
        page.keyboard.press("ArrowRight")
    assert is_framed(page, places[-1]), "the arrow ends nothing"
    page.keyboard.press("ArrowLeft")
    assert is_framed(page, places[-2])
    page.keyboard.press("Escape")
    expect(page.locator(".tour")).to_have_count(0)
    expect(page.locator(".is-framed")).to_have_count(0)
    page.evaluate("localStorage.setItem('openacr.panel.language', 'en')")
    reload(page)


def test_next_after_the_last_part_ends_the_tour_and_stop_is_never_covered(page: Page) -> None:
    for width, height in ((1024, 768), (360, 640)):
        page.set_viewport_size({"width": width, "height": height})
        begin(page)
        for _ in page.evaluate(STEPS):
            assert not page.evaluate(COVERED)
            page.locator(".tour").get_by_role("button", name="NEXT").click()
        expect(page.locator(".tour")).to_have_count(0)
    page.set_viewport_size({"width": 1024, "height": 768})
