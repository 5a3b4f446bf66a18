"""Keys that move the machine: every path of release, by finger, mouse and keyboard."""

from collections.abc import Callable
from contextlib import suppress
from functools import partial

import pytest
from playwright.sync_api import BrowserContext, CDPSession, Error, Page, expect
from tests.panel.bench import Served
from tests.panel.browser.conftest import open_page, until

from openacr.sysvar.tabs import JOG

AFTER_MS = 60  # a move that was not asked for would have begun


def x_of(served: Served) -> float:
    return served.station.snapshot.commanded[0]


def is_jogging(served: Served) -> bool:
    return served.call(lambda station: bool(station.link.machine.runner.jogging.is_active))


def rest_of(served: Served, page: Page) -> float:
    """Where X has come to rest."""
    until(page, lambda: not is_jogging(served))
    return served.call(lambda station: float(station.link.machine.runner.stream.host.position()[0]))


@pytest.fixture
def jog(page: Page, served: Served) -> Page:
    page.keyboard.press("F7")
    page.keyboard.press("F2")
    page.get_by_role("button", name="X plus").wait_for()
    until(page, lambda: not is_jogging(served))
    return page


def centre(page: Page, name: str) -> dict[str, float]:
    key = page.get_by_role("button", name=name)
    expect(key).to_be_visible()
    box = key.bounding_box()
    assert box is not None
    return {"x": box["x"] + box["width"] / 2, "y": box["y"] + box["height"] / 2}


@pytest.fixture
def finger(jog: Page) -> CDPSession:
    """One finger on the glass."""
    return jog.context.new_cdp_session(jog)


def touch(finger: CDPSession, kind: str, *points: dict[str, float]) -> None:
    finger.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": list(points)})


def hold(page: Page, served: Served, press: Callable[[], object]) -> None:
    """Hold the plus key of X until the axis moves."""
    beyond = x_of(served) + 0.02
    press()
    until(page, lambda: x_of(served) > beyond)
    expect(page.locator(".jog-key.is-held")).to_have_accessible_name("X plus")


def moves_and_stops(
    page: Page,
    served: Served,
    press: Callable[[], object],
    lift: Callable[[], object],
    end: Callable[[], object] | None = None,
) -> None:
    """The axis moves while the key is held, and rests after what ends it."""
    hold(page, served, press)
    (end or lift)()
    rest = rest_of(served, page)
    expect(page.locator(".is-held")).to_have_count(0)
    page.wait_for_timeout(AFTER_MS)
    assert x_of(served) == pytest.approx(rest, abs=1e-9)


def test_a_mouse_moves_an_axis_as_long_as_it_holds_the_key(jog: Page, served: Served) -> None:
    jog.get_by_role("button", name="X plus").hover()
    moves_and_stops(jog, served, jog.mouse.down, jog.mouse.up)


def test_a_finger_moves_an_axis_as_long_as_it_holds_the_key(
    jog: Page, served: Served, finger: CDPSession
) -> None:
    point = centre(jog, "X plus")
    moves_and_stops(
        jog,
        served,
        lambda: touch(finger, "touchStart", point),
        lambda: touch(finger, "touchEnd"),
    )


def test_a_touch_that_the_system_takes_away_stops_the_axis(
    jog: Page, served: Served, finger: CDPSession
) -> None:
    point = centre(jog, "X plus")
    moves_and_stops(
        jog,
        served,
        lambda: touch(finger, "touchStart", point),
        lambda: touch(finger, "touchCancel"),
    )


def test_a_finger_that_slides_off_its_key_still_holds_it_until_it_is_lifted(
    jog: Page, served: Served, finger: CDPSession
) -> None:
    point = centre(jog, "X plus")

    def press() -> None:
        touch(finger, "touchStart", point)
        touch(finger, "touchMove", {"x": point["x"], "y": point["y"] - 150})

    moves_and_stops(jog, served, press, lambda: touch(finger, "touchEnd"))


@pytest.mark.parametrize("key", [" ", "Enter"])
def test_the_keyboard_holds_the_key_that_has_the_focus(jog: Page, served: Served, key: str) -> None:
    jog.get_by_role("button", name="X plus").focus()
    moves_and_stops(jog, served, lambda: jog.keyboard.down(key), lambda: jog.keyboard.up(key))


def test_the_arrow_key_moves_x(jog: Page, served: Served) -> None:
    jog.locator(".hint").last.click()
    moves_and_stops(
        jog,
        served,
        lambda: jog.keyboard.down("ArrowRight"),
        lambda: jog.keyboard.up("ArrowRight"),
    )


@pytest.mark.parametrize(
    "what",
    [
        "window.dispatchEvent(new Event('blur'))",
        "window.dispatchEvent(new Event('pagehide'))",
        "document.dispatchEvent(new Event('visibilitychange'))",
        "document.activeElement.blur()",
    ],
)
def test_what_takes_the_key_from_the_operator_stops_the_axis(
    jog: Page, served: Served, what: str
) -> None:
    jog.get_by_role("button", name="X plus").hover()
    moves_and_stops(jog, served, jog.mouse.down, jog.mouse.up, lambda: jog.evaluate(what))
    jog.mouse.up()


def test_a_key_that_loses_the_pointer_stops_the_axis(jog: Page, served: Served) -> None:
    point = centre(jog, "X plus")
    jog.mouse.move(point["x"], point["y"])

    def lose() -> None:  # no event of the pointer follows, so the browser does not report the loss
        jog.evaluate(
            """const key = document.querySelector('.jog-key.is-held');
            for (let n = 0; n < 99; n++)
                if (key.hasPointerCapture(n)) key.releasePointerCapture(n)"""
        )

    moves_and_stops(jog, served, jog.mouse.down, jog.mouse.up, lose)
    jog.mouse.up()


def test_a_press_that_has_ended_does_not_come_back_while_the_key_is_still_down(
    jog: Page, served: Served
) -> None:
    jog.get_by_role("button", name="X plus").hover()
    moves_and_stops(
        jog,
        served,
        jog.mouse.down,
        jog.mouse.up,
        lambda: jog.evaluate("window.dispatchEvent(new Event('blur'))"),
    )
    rest = x_of(served)
    jog.wait_for_timeout(5 * AFTER_MS)
    assert x_of(served) == pytest.approx(rest, abs=1e-9)
    jog.mouse.up()


def test_stop_ends_a_held_key(jog: Page, served: Served) -> None:
    jog.get_by_role("button", name="X plus").hover()
    pause = partial(jog.keyboard.press, "Pause")
    moves_and_stops(jog, served, jog.mouse.down, jog.mouse.up, pause)
    jog.mouse.up()


def test_another_speed_while_a_key_is_held_ends_it(jog: Page, served: Served) -> None:
    jog.get_by_role("button", name="X plus").hover()
    moves_and_stops(
        jog,
        served,
        jog.mouse.down,
        jog.mouse.up,
        lambda: jog.evaluate("[...document.querySelectorAll('[role=radio]')][1].click()"),
    )
    jog.mouse.up()


def test_leaving_the_screen_while_a_key_is_held_ends_it(jog: Page, served: Served) -> None:
    jog.get_by_role("button", name="X plus").hover()
    hold(jog, served, jog.mouse.down)
    jog.keyboard.press("Escape")
    until(jog, lambda: not is_jogging(served))
    jog.mouse.up()


def test_a_closed_tab_stops_the_axis(page: Page, context: BrowserContext, served: Served) -> None:
    page.evaluate("import('/js/core/app.js').then((app) => app.give('control.release'))")
    other = open_page(context, served.url)
    other.keyboard.press("F7")
    other.keyboard.press("F2")
    other.get_by_role("button", name="X plus").hover()
    hold(other, served, other.mouse.down)
    other.close()
    until(page, lambda: not is_jogging(served))


def test_a_step_moves_by_its_increment_and_no_further(jog: Page, served: Served) -> None:
    continuous, first = [
        jog.get_by_role("radiogroup").last.get_by_role("radio").nth(n) for n in (0, 1)
    ]
    first.click()
    before = rest_of(served, jog)
    jog.get_by_role("button", name="X plus").click()
    until(jog, lambda: rest_of(served, jog) != before)
    step = served.call(
        lambda station: station.link.machine.runner.settings.real(JOG.increments[0][0])
    )
    assert rest_of(served, jog) - before == pytest.approx(step)
    continuous.click()


# The contrast of the text of an element with its own ground, as WCAG computes it.
CONTRAST = """(element) => {
  const canvas = document.createElement('canvas').getContext('2d', { willReadFrequently: true });
  const light = (color) => {
    canvas.fillStyle = color;
    canvas.fillRect(0, 0, 1, 1);
    const [r, g, b] = [...canvas.getImageData(0, 0, 1, 1).data].map((each) => each / 255)
      .map((each) => each <= 0.04045 ? each / 12.92 : ((each + 0.055) / 1.055) ** 2.4);
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const { color, backgroundColor } = getComputedStyle(element);
  const [dark, bright] = [light(color), light(backgroundColor)].sort((a, b) => a - b);
  return (bright + 0.05) / (dark + 0.05);
}"""
READABLE = 4.5


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_a_key_that_is_held_or_pressed_with_the_mouse_can_be_read(
    jog: Page, served: Served, theme: str
) -> None:
    jog.evaluate("(theme) => { document.documentElement.dataset.theme = theme; }", theme)
    place = centre(jog, "X plus")

    def press() -> None:
        jog.mouse.move(place["x"], place["y"])
        jog.mouse.down()

    hold(jog, served, press)
    assert jog.locator(".jog-key.is-held").evaluate(CONTRAST) >= READABLE
    jog.mouse.up()
    jog.mouse.move(1, 1)
    until(jog, lambda: not is_jogging(served))
    jog.keyboard.press("Escape")
    jog.keyboard.press("F1")
    inspector = jog.context.new_cdp_session(jog)  # a finger presses a key without being over it
    inspector.send("DOM.enable")
    inspector.send("CSS.enable")
    key = jog.locator("#screen .key.main")

    def is_pressed() -> bool:
        root = inspector.send("DOM.getDocument")["root"]["nodeId"]
        asked = {"nodeId": root, "selector": "#screen .key.main"}
        with suppress(Error):  # the screen is just being drawn
            found = inspector.send("DOM.querySelector", asked)
            inspector.send("CSS.forcePseudoState", {**found, "forcedPseudoClasses": ["active"]})
        return bool(key.count()) and key.evaluate("(each) => each.matches(':active:not(:hover)')")

    until(jog, is_pressed)
    assert key.evaluate(CONTRAST) >= READABLE
    inspector.detach()
    jog.evaluate("() => { delete document.documentElement.dataset.theme; }")
