"""SERVO LOOP of DIAGNOSTICS: every value of the loop of one axis, as the card has it."""

from collections.abc import Callable

import pytest
from playwright.sync_api import Page, expect
from tests.panel.bench import Served

from openacr.panel.control.station import Station

# Places in the block of an axis that each box shows, with decimals; None: six digits.
LOOP: dict[str, list[tuple[int, int | None]]] = {
    "current": [(0, 0)], "gear": [(8, 0)], "jog": [(9, 0)], "cam": [(10, 0)],
    "backlash": [(12, 0)], "primary": [(6, 0)], "ballscrew": [(11, 0)], "secondary": [(7, 0)],
    "actual": [(2, 0)], "error": [(3, 0)],
    "p": [(24, 4), (16, None)],
    "i": [(25, 4), (17, None), (18, None), (19, None)],
    "d": [(26, 4), (20, None), (21, None)],
    "ffvel": [(66, 4), (22, None), (27, 0)],
    "ffacc": [(67, 4), (23, None), (28, 0)],
    "fbvel": [(65, 4), (64, None)],
    "sum": [(29, 4)],
    "filter0": [(48, None), (49, None), (50, None), (51, None), (52, None)],
    "filter1": [(53, None), (54, None), (55, None), (56, None), (57, None)],
    "filtered": [(30, 4)], "limits": [(40, None), (41, None)], "output": [(31, 4)],
}  # fmt: skip
GIVEN = {  # gains, limits, and coefficients of filters that are off
    16: 0.0025, 17: 1e-06, 18: 1.5, 19: 0.25, 20: 1e-05, 21: 0.002, 22: 3e-05, 23: 2e-06,
    40: 9.5, 41: -9.25, 64: 1e-06,
    **{48: 0.1, 49: 0.2, 50: 0.3, 51: 0.4, 52: 0.5, 53: 0.6, 54: 0.7, 55: 0.8, 56: 0.9, 57: 1.1},
}  # fmt: skip
BOXES = """(root) => Object.fromEntries([...root.querySelectorAll('[data-box]')].map((box) =>
  [box.dataset.box, [...box.querySelectorAll('[text-anchor=end]')].map((each) => Number(each.textContent))]))"""  # noqa: E501
SHOWN = f"() => ({BOXES})(document.querySelector('.loop-picture'))"
# The boxes of a drawing whose every value is its place and a quarter.
PLACES = f"""() => import('/js/draw/loop.js').then(({{ drawLoop }}) => {{
  const loop = drawLoop('');
  loop.update((place) => place + 0.25);
  return ({BOXES})(loop.element);
}})"""


def boxes(values: Callable[[int], float]) -> dict[str, list[float]]:
    """What the boxes show of values by their places."""
    return {
        box: [
            float(f"{values(place):.6g}") if decimals is None else round(values(place), decimals)
            for place, decimals in rows
        ]
        for box, rows in LOOP.items()
    }


@pytest.mark.req("MILL-DIAG-SERVO")
def test_the_servo_loop_of_the_chosen_axis_is_drawn_with_all_its_values(
    page: Page, served: Served
) -> None:
    for press in ("F8", "F5", "F6"):
        page.keyboard.press(press)
    first = 12288 + 256  # of Y

    def values() -> dict[int, float]:
        def read(station: Station) -> dict[int, float]:
            places = {place for box in LOOP.values() for place, _ in box}
            return {place: float(station.machine.card.read(first + place)) for place in places}

        return served.call(read)

    def write(new: dict[int, float]) -> None:
        def do(station: Station) -> None:
            for place, value in new.items():
                station.machine.card.write(first + place, value)

        served.call(do)

    expect(page.locator(".loop-picture [data-box] .title")).to_have_count(22)
    assert page.evaluate(PLACES) == boxes(lambda place: place + 0.25)
    expect(page.locator("[data-box=p] .gain").nth(1)).to_have_text("0.002441")  # of X
    page.get_by_role("radio", name="Y").click()
    before = values()
    write({**GIVEN, 8: 250})  # a gear offset moves the setpoints
    for _ in range(400):
        card, shown = values(), page.evaluate(SHOWN)
        expected = boxes(card.__getitem__)
        if shown == expected:
            break
        page.wait_for_timeout(20)
    assert shown == expected
    assert {place: card[place] for place in GIVEN} == pytest.approx(GIVEN, rel=1e-6)
    assert card[6] == before[6] + 250
    assert card[7] == before[7] + 250
    assert card[2] != before[2]
    expect(page.locator("#screen [role=status]")).to_have_text("Loop closed \u00b7 filters off")
    page.get_by_role("radio", name="X").click()
    expect(page.locator("[data-box=p] .gain").nth(1)).to_have_text("0.002441")
    expect(page.locator("[data-box=gear] .value")).to_have_text("0")
    write({place: before[place] for place in (*GIVEN, 8)})
