"""Sums of the number pad and numbers as the screens show them."""

import pytest
from playwright.sync_api import Page

MODULE = "([place, name, args]) => import(place).then((module) => module[name](...args))"


def call(page: Page, place: str, name: str, *args: object) -> object:
    return page.evaluate(MODULE, [f"/js/core/{place}.js", name, list(args)])


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("12", 12), ("-3.5", -3.5), (".5", 0.5), ("1,25", 1.25), ("25.4*3/8", 9.525), ("2+3*4", 14),
        ("(2+3)*4", 20), ("10-4-3", 3), ("8/4/2", 1), ("-(1+2)", -3), ("2*-3", -6), (" 1 + 1 ", 2),
        ("−5", -5), ("3×2÷4", 1.5), ("", None), ("1+", None), ("1 2", None), ("(1", None),
        ("1)", None), ("x", None), ("1/0", None), ("1e3", None), ("*2", None), ("0/0", None),
    ],
)  # fmt: skip
def test_the_pad_computes_sums_and_refuses_what_is_none(
    page: Page, text: str, value: float | None
) -> None:
    assert call(page, "arithmetic", "evaluate", text) == value


@pytest.mark.parametrize(
    ("value", "text"), [(0.1 + 0.2, "0.3"), (9.525, "9.525"), (-0.0, "0"), (1e-7, "1e-7")]
)
def test_a_sum_is_entered_without_the_tail_of_binary_fractions(
    page: Page, value: float, text: str
) -> None:
    assert call(page, "arithmetic", "tidy", value) == text


@pytest.mark.parametrize(
    ("value", "decimals", "text"),
    [
        (1.5, 3, "\u20071.500"),
        (-1.5, 3, "−1.500"),
        (-0.0004, 3, "\u20070.000"),
        (0.0, 2, "\u20070.00"),
    ],
)
def test_a_position_keeps_a_place_for_its_sign_and_never_shows_a_negative_zero(
    page: Page, value: float, decimals: int, text: str
) -> None:
    assert call(page, "format", "position", value, decimals) == text


@pytest.mark.parametrize(
    ("seconds", "text"),
    [(0, "0:00"), (59.6, "1:00"), (61, "1:01"), (3600, "1:00:00"), (3725, "1:02:05")],
)
def test_a_duration_shows_hours_only_where_there_are_some(
    page: Page, seconds: float, text: str
) -> None:
    assert call(page, "format", "duration", seconds) == text


def test_the_pad_enters_by_keys_and_keeps_a_wrong_text_open(page: Page) -> None:
    page.evaluate("""import('/js/frame/number_pad.js').then((pad) => { window.chosen =
        pad.askNumber({ title: 'Depth', value: 5, check: (n) => n > 9 ? 'at most 9' : '' }) })""")
    dialog = page.get_by_role("dialog", name="Depth")
    dialog.wait_for()
    for key in ("clear", "1", "2", "+"):
        dialog.get_by_role("button", name=key, exact=True).click()
    dialog.get_by_role("button", name="OK").click()
    assert "Not a number" in dialog.inner_text()
    dialog.get_by_role("button", name="1", exact=True).click()
    page.keyboard.press("Enter")
    assert "at most 9" in dialog.inner_text()
    field = dialog.get_by_role("textbox")
    field.fill("2*3")
    assert "= 6" in dialog.inner_text()
    field.press("Enter")
    dialog.wait_for(state="detached")
    assert page.evaluate("window.chosen") == 6
