"""The scope of the workspace: its arithmetic against NumPy and SciPy, its pane on a card."""

import re
import time
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import BrowserContext, Locator, Page, expect
from pyarrow import parquet
from scipy import integrate, signal
from tests.panel.bench import Served
from tests.panel.browser.conftest import LONGEST_MS, left_over, open_page, until_model

from openacr.client.names import named
from openacr.panel.control.engineer.pyramid import Pyramid
from openacr.panel.control.engineer.scope import Capture
from openacr.panel.control.station import Station
from openacr.sysvar.tabs import OFFSETS

pytestmark = pytest.mark.evidence("oracle", "numpy.fft, numpy.gradient, scipy.signal and integrate")
RNG = np.random.default_rng(7)
NOISE = RNG.normal(size=1000)
ARRAYS = """([place, name, args]) => import(place).then((module) => {
  const found = module[name](...args.map((each) => Array.isArray(each) && typeof each[0] === 'number' ? Float64Array.from(each) : each));
  const plain = (each) => ArrayBuffer.isView(each) || Array.isArray(each) ? [...each].map(plain)
    : each && typeof each === 'object' ? Object.fromEntries(Object.entries(each).map(([k, v]) => [k, plain(v)])) : each;
  return plain(found);
})"""  # noqa: E501


def call(page: Page, place: str, name: str, *args: Any) -> Any:
    """Call a function of a module of the scope; arrays of numbers are arrays of doubles there."""
    plain = [each.tolist() if isinstance(each, np.ndarray) else each for each in args]
    return page.evaluate(ARRAYS, [f"/js/scope/{place}.js", name, plain])


@pytest.fixture(scope="module")
def page(context: BrowserContext, served: Served) -> Page:
    """The scope in the engineer's workspace, opened once for the file."""
    page = open_page(context, f"{served.url}/bench")
    show_scope(page)
    return page


def show_scope(page: Page) -> None:
    """The scope alone in its place; a window that has just changed its size lays out late."""
    rows, looks = page.locator("[data-pane=scope] .scope-rows"), 0
    while looks < 2:
        page.evaluate("import('/js/bench/workspace.js').then((each) => each.openPane('scope'))")
        page.wait_for_timeout(100)
        looks = looks + 1 if rows.is_visible() else 0


# --- spectrum -------------------------------------------------------------------------


@pytest.mark.parametrize("size", [2, 3, 64, 97, 1000])
def test_the_transform_is_that_of_numpy_at_any_length(page: Page, size: int) -> None:
    values, others = NOISE[:size], NOISE[::-1][:size].copy()
    real, imaginary = call(page, "spectrum", "transformed", values, others)
    expected = np.fft.fft(values + 1j * others)
    np.testing.assert_allclose(np.array(real) + 1j * np.array(imaginary), expected, atol=1e-10)


@pytest.mark.parametrize("name", ["hann", "hamming", "blackman", "flattop"])
def test_windows_are_those_of_scipy(page: Page, name: str) -> None:
    np.testing.assert_allclose(
        call(page, "spectrum", "windowOf", name, 50), signal.get_window(name, 50), atol=1e-15
    )


@pytest.mark.parametrize("name", ["rectangle", "hann", "hamming", "blackman", "flattop"])
@pytest.mark.parametrize("size", [1000, 1024])
def test_a_sine_at_a_bin_has_its_amplitude_there(page: Page, name: str, size: int) -> None:
    at = np.arange(size)
    values = (
        0.25
        + 3.0 * np.sin(2 * np.pi * 40 * at / size + 0.7)
        + 0.5 * np.cos(2 * np.pi * 90 * at / size)
    )
    found = call(page, "spectrum", "spectrum", values, 0.0002, name)
    assert found["step"] == pytest.approx(5000.0 / size, rel=1e-12)
    amplitudes = np.array(found["amplitudes"])
    assert len(amplitudes) == size // 2 + 1
    assert amplitudes[[0, 40, 90]] == pytest.approx([0.25, 3.0, 0.5], abs=1e-9)
    assert call(page, "spectrum", "peaks", amplitudes, 2) == [40, 90]


def test_the_highest_bin_is_counted_once(page: Page) -> None:
    found = call(page, "spectrum", "spectrum", np.array([2.0, -2.0] * 8), 0.5, "rectangle")
    assert found["amplitudes"] == pytest.approx([0.0] * 8 + [2.0], abs=1e-12)
    odd = call(page, "spectrum", "spectrum", NOISE[:9], 0.5, "rectangle")
    expected = 2.0 * np.abs(np.fft.rfft(NOISE[:9])) / 9
    assert odd["amplitudes"][1:] == pytest.approx(expected[1:].tolist(), abs=1e-12)


def test_peaks_are_those_of_scipy_the_highest_first(page: Page) -> None:
    places, _ = signal.find_peaks(NOISE[:200])
    ordered = sorted((int(p) for p in places), key=lambda p: -NOISE[p])
    assert call(page, "spectrum", "peaks", NOISE[:200], 12) == ordered[:12]


# --- measures -------------------------------------------------------------------------


@pytest.mark.parametrize(("first", "last"), [(0, 999), (3, 3), (10, 500), (-5, 2000)])
def test_measures_are_of_the_samples_between_the_cursors(page: Page, first: int, last: int) -> None:
    part = NOISE[max(0, first) : last + 1]
    assert call(page, "measures", "measured", NOISE, first, last) == pytest.approx(
        {
            "count": len(part), "min": part.min(), "max": part.max(), "mean": part.mean(),
            "rms": np.sqrt(np.mean(part**2)), "span": np.ptp(part),
        }, rel=1e-12
    )  # fmt: skip


# --- files ----------------------------------------------------------------------------


def test_a_file_is_named_after_its_second(page: Page) -> None:
    assert (
        page.evaluate(
            "import('/js/scope/export.js')"
            ".then((m) => m.fileName('csv', new Date(2026, 0, 7, 9, 5, 3)))"
        )
        == "scope-2026-01-07-090503.csv"
    )


# --- maths ----------------------------------------------------------------------------

T = np.arange(200) * 0.0005
CH1, CH2 = np.sin(40.0 * T), 1.5 + np.cos(7.0 * T)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("CH1 + 2*CH2", CH1 + 2 * CH2),
        ("ch1 - ch2 - 1", CH1 - CH2 - 1),
        ("-(CH1)/CH2/2", -CH1 / CH2 / 2),
        ("sqrt(abs(CH1)) * pi", np.sqrt(np.abs(CH1)) * np.pi),
        ("max(CH1, 0.5) + min(CH2, CH1)", np.maximum(CH1, 0.5) + np.minimum(CH2, CH1)),
        ("sin(CH1)+cos(CH2)*tan(CH1)-atan(CH2)",
         np.sin(CH1) + np.cos(CH2) * np.tan(CH1) - np.arctan(CH2)),
        ("exp(CH1) + log(CH2) - log10(CH2)", np.exp(CH1) + np.log(CH2) - np.log10(CH2)),
        ("d(CH1)", np.gradient(CH1, 0.0005)),
        ("d(d(CH2 * CH1))", np.gradient(np.gradient(CH2 * CH1, 0.0005), 0.0005)),
        ("i(CH2)", integrate.cumulative_trapezoid(CH2, dx=0.0005, initial=0.0)),
        ("i(d(CH1)) - 3", integrate.cumulative_trapezoid(np.gradient(CH1, 0.0005), dx=0.0005,
                                                         initial=0.0) - 3),
        ("7", np.full(200, 7.0)),
    ],
)  # fmt: skip
def test_the_maths_channel_computes_as_numpy_does(
    page: Page, text: str, expected: np.ndarray
) -> None:
    channels = [CH1.tolist(), CH2.tolist()]
    np.testing.assert_allclose(
        call(page, "maths", "computed", text, channels, 0.0005), expected, rtol=1e-12, atol=1e-12
    )


# --- the pane -------------------------------------------------------------------------

RECORD = """() => import('/js/scope/screen.js').then(({ shown }) => shown.value)"""


def capture_of(station: Station) -> Capture:
    """The capture that was begun last."""
    found = [own.scope.capture for own in station.captures._all.values() if own.scope.capture]
    return max(found, key=lambda each: each.number)


def write(station: Station, value: float) -> None:
    station.link.machine.card.write(7, value)


def press(page: Page, name: str) -> None:
    page.locator("[data-pane=scope] .pane-head").get_by_role("button", name=name).click()


def fill(page: Page, values: dict[str, str]) -> None:
    for label, value in values.items():
        field = page.get_by_label(label, exact=True)
        field.fill(value)
        field.press("Tab")


def test_a_single_sweep_of_a_flag_and_a_parameter_is_measured_and_exported(
    page: Page, served: Served
) -> None:
    served.call(lambda station: station.link.machine.card.write(7, 0.0))
    served.call(lambda station: station.link.machine.card.write_bit(1920, True))
    fill(page, {
        "CH1 source": "P7", "CH2 source": "BIT1920", "CH3 source": "", "CH8 source": "p6916",
        "M source": "2*CH1 + CH2", "CH1 units/div": "2", "CH1 unit": "mm",
        "Sweep, ms/div": "5", "Sampling, ms": "0.5", "Trigger level": "1", "Pre-trigger, %": "20",
    })  # fmt: skip
    page.get_by_label("Trigger", exact=True).select_option("single")
    press(page, "START")
    until_model(page, "model.capture.value.running")
    served.call(lambda station: station.link.machine.card.pause(0.1))
    served.call(lambda station: station.link.machine.card.write(7, 3.5))
    expect(page.locator("[data-pane=scope] [role=status]")).to_contain_text("Stopped at")
    press(page, "CURSORS")
    row = page.locator("[data-trace=CH1] td")
    expect(row).to_have_text(["3.5", "3.5", "3.5", "3.5", "3.5", "3.5", "0", "\u2013"])
    expect(page.locator("[data-cursors]")).to_have_text(
        "t1 2.5 ms, t2 27.5 ms, \u0394t 25 ms, 1/\u0394t 40 Hz"
    )
    shown = page.evaluate(RECORD)
    assert shown["times"] == pytest.approx([0.5 * (n - 20) for n in range(100)], abs=1e-9)
    assert shown["x"] == [-10, 40]
    assert shown["channels"][0] == [0.0] * 20 + [1.75] * 80  # 20 % before it: at the sample
    assert shown["channels"][3] == [float(7 * (n >= 20)) + 1.0 for n in range(100)]
    ticks = shown["channels"][2]
    assert ticks == sorted(ticks)
    press(page, "CURSORS")
    with page.expect_download() as saved:
        press(page, "EXPORT")
        page.get_by_role("dialog").get_by_role("button", name="CSV").click()
    lines = saved.value.path().read_text().splitlines()
    assert lines[0] == (
        "time_s,CH1 P7 USER User Variable [mm],CH2 BIT1920 USER4 User Defined,"
        "CH8 P6916 SYSTEM Global System Clock [ms],M 2*CH1 + CH2"
    )
    assert [lines[1][:6], lines[21][:2]] == ["-0.01,", "0,"]
    assert [line.split(",")[1] for line in lines[1:]] == ["0"] * 20 + ["3.5"] * 80
    with page.expect_download() as saved:
        press(page, "EXPORT")
        page.get_by_role("dialog").get_by_role("button", name="PARQUET").click()
    table = parquet.read_table(saved.value.path())
    assert table.column("CH1 P7 USER User Variable [mm]").to_pylist() == [0.0] * 20 + [3.5] * 80
    with page.expect_download() as saved:
        press(page, "EXPORT")
        page.get_by_role("dialog").get_by_role("button", name="PNG").click()
    assert saved.value.path().read_bytes().startswith(b"\x89PNG")
    assert page.complaints == []  # type: ignore[attr-defined]


def test_a_channel_is_called_by_its_alias_else_by_the_name_of_the_machine(
    page: Page, served: Served
) -> None:
    def name(station: Station) -> None:
        card = station.times.history.card
        card.send("SYS\rDIM DEF(10)\r#DEFINE speed P7\r#DEFINE lamp BIT37\rPROG0\r")
        station.installation.store.write_text(OFFSETS.output_name[36], "COOLANT")

    served.call(name)
    fill(page, {
        "CH1 source": "P7", "CH2 source": "BIT36", "CH3 source": "BIT37", "CH8 source": "",
        "M source": "", "Sweep, ms/div": "5", "Sampling, ms": "0.5",
    })  # fmt: skip
    page.get_by_label("Trigger", exact=True).select_option("free")
    press(page, "START")
    for label, text in (
        ("CH1", "speed (USER User Variable)"),
        ("CH2", "COOLANT (OUTPUT OUT 36)"),
        ("CH3", "lamp (OUTPUT OUT 37)"),
    ):
        expect(page.locator(f"[data-trace={label}]")).to_contain_text(text)
    press(page, "STOP SCOPE")
    served.call(lambda station: station.times.history.card.send("SYS\rDEF CLEAR\rPROG0\r"))
    assert page.complaints == []  # type: ignore[attr-defined]


def status(page: Page) -> Locator:
    return page.locator("[data-pane=scope] [role=status]")


def switch(station: Station, flag: int, on: bool) -> None:
    station.link.machine.card.write_bit(flag, on)


def arm_on_flag(page: Page, flag: int, mode: str, **more: str) -> None:
    """START with P7 and a flag, which triggers with its rising edge."""
    fill(page, {
        "CH1 source": "P7", "CH2 source": f"BIT{flag}", "CH3 source": "", "CH8 source": "",
        "M source": "", "Sweep, ms/div": "5", "Sampling, ms": "0.5", "Trigger level": "0.5",
        "Pre-trigger, %": "20", **more,
    })  # fmt: skip
    page.get_by_label("Trigger", exact=True).select_option(mode)
    page.get_by_label("Trigger source", exact=True).select_option("CH2")
    page.get_by_label("Flags", exact=True).select_option("curves")
    press(page, "START")
    until_model(
        page, f"model.capture.value.running && model.capture.value.channels[1] === 'BIT{flag}'"
    )


@pytest.mark.parametrize("mode", ["normal", "single"])
def test_a_sweep_without_a_trigger_is_not_shown_and_the_pane_says_that_it_waits(
    page: Page, served: Served, mode: str
) -> None:
    served.call(partial(switch, flag=1922, on=False))
    arm_on_flag(page, 1922, mode)
    expect(status(page)).to_have_text(re.compile(r"^WAITING for a trigger, [1-9]\d{2,} samples$"))
    empty = until(page, lambda: page.evaluate(RECORD), lambda found: not found["times"])
    assert empty["x"] == [-10, 40]  # 0 is where the trigger will be
    press(page, "STOP SCOPE")
    expect(status(page)).to_contain_text("Stopped at")


def test_the_last_whole_sweep_stays_with_its_measures_until_the_next_one_is_whole(
    page: Page, served: Served
) -> None:
    served.call(partial(write, value=1.0))
    served.call(partial(switch, flag=1922, on=False))
    arm_on_flag(page, 1922, "normal")
    cells = page.locator("[data-trace=CH1] td")
    whole = [0.0] * 20 + [1.0] * 80
    for value in (1.0, 2.0):
        served.call(partial(write, value=value))
        served.call(lambda station: station.link.machine.card.pause(0.1))
        served.call(partial(switch, flag=1922, on=True))
        until(page, lambda: page.evaluate(RECORD)["channels"][1], lambda found: found == whole)
        expect(cells.nth(1)).to_have_text(f"{value:g}")
        served.call(partial(switch, flag=1922, on=False))
        expect(status(page)).to_contain_text("WAITING")
        served.call(lambda station: station.link.machine.card.pause(0.2))
        assert page.evaluate(RECORD)["channels"][1] == whole
    press(page, "REFERENCE")
    press(page, "STOP SCOPE")
    expect(cells.last).to_have_text("0")  # it kept the whole sweep
    press(page, "REFERENCE")


def test_two_browsers_sample_their_own_channels_at_once(
    page: Page, context: BrowserContext, served: Served
) -> None:
    served.call(partial(write, value=4.0))
    arm_on_flag(page, 1922, "auto")
    other = open_page(context, f"{served.url}/bench")
    show_scope(other)
    fill(other, {"CH1 source": "BIT1921", "CH2 source": "", "CH3 source": "P6916"})
    other.get_by_label("Trigger", exact=True).select_option("roll")
    press(other, "START")
    for each, names in ((page, ["P7", "BIT1922"]), (other, ["BIT1921", "P6916"])):
        until_model(each, f"model.capture.value.channels?.join() === '{','.join(names)}'")
        before = str(status(each).text_content())
        expect(status(each)).not_to_have_text(before)  # both go on
        expect(status(each)).to_contain_text("samples")
    expect(page.locator("[data-trace=CH1] td").first).to_have_text("4")
    expect(other.locator("[data-trace=CH1] td").first).to_have_text("0")
    other.evaluate("import('/js/core/app.js').then(({ link }) => link.renew())")
    until_model(other, "model.capture.value.running && model.capture.value.number > 0")
    before = str(status(other).text_content())
    expect(status(other)).not_to_have_text(before)  # it goes on after a connection that was cut
    press(other, "STOP SCOPE")
    expect(status(other)).to_contain_text("Stopped at")
    expect(status(page)).not_to_contain_text("Stopped")
    press(page, "STOP SCOPE")
    other.close()


def test_of_a_linked_card_a_second_browser_asks_before_it_takes_the_scope_and_the_first_says_so(
    page: Page, context: BrowserContext, served: Served, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(served.station.captures, "is_shared", True)
    arm_on_flag(page, 1922, "auto")
    expect(status(page)).to_contain_text("samples")
    other = open_page(context, f"{served.url}/bench")
    show_scope(other)
    fill(other, {"CH1 source": "P7", "CH2 source": "BIT1921", "CH3 source": ""})
    press(other, "START")
    dialog = other.get_by_role("dialog", name="TAKE THE SCOPE")
    expect(dialog).to_contain_text(re.compile(r"the scope samples for service \d+ \(127.0.0.1\)"))
    other.keyboard.press("Escape")
    expect(other.locator("#prompt")).to_contain_text("wait until it stops, or take it")
    assert page.evaluate(FIRST_NAME) == "BIT1922"
    press(other, "START")
    dialog.get_by_role("button", name="TAKE THE SCOPE").click()
    expect(status(page)).to_contain_text(
        re.compile(r"^TAKEN: the scope samples for service \d+ now")
    )
    expect(status(other)).to_contain_text("samples")
    shown = page.evaluate(RECORD)
    served.call(lambda station: station.link.machine.card.pause(0.1))
    expect(status(other)).not_to_have_text(str(status(other).text_content()))
    assert page.evaluate(RECORD) == shown  # nothing of the other capture
    other.close()
    press(page, "START")  # the one that took it has gone
    expect(status(page)).to_contain_text(re.compile("^(WAITING|TRIGGERED)"))
    press(page, "STOP SCOPE")
    expect(status(page)).to_contain_text("Stopped at")  # before cards are not shared any more


# Numbers that are cut off, and a plot that is less than so wide and high.
CUT = """() => [...document.querySelectorAll('.scope-side input.number')]
  .filter((each) => each.scrollWidth > each.clientWidth).map((each) => each.value)"""
ROOM = """([wide, high]) => {
  const { width, height } = document.querySelector('[data-view=time] .u-over').getBoundingClientRect();
  return width >= wide && height >= high ? [] : [`${innerWidth}: ${width} x ${height}`];
}"""  # noqa: E501
FIRST_NAME = "import('/js/core/app.js').then(({ model }) => model.capture.value.channels[1])"


def until(page: Page, look: Callable[[], Any], holds: Callable[[Any], bool]) -> Any:
    """What a look finds once it holds."""
    end_s = time.monotonic() + LONGEST_MS / 1000.0
    while not holds(found := look()):
        assert time.monotonic() < end_s, found
        page.wait_for_timeout(20)
    return found


def until_shown(page: Page, first_ms: float, last_ms: float) -> None:
    """Wait until the screen shows a part of the record."""
    expected = pytest.approx([first_ms, last_ms], abs=0.1)
    until(page, lambda: page.evaluate(RECORD)["x"], lambda found: bool(found == expected))


def test_a_record_at_rest_is_zoomed_by_the_wheel_and_dragged(page: Page, served: Served) -> None:
    served.call(partial(switch, flag=1922, on=False))
    arm_on_flag(page, 1922, "single")
    served.call(lambda station: station.link.machine.card.pause(0.1))
    served.call(partial(switch, flag=1922, on=True))
    expect(status(page)).to_contain_text("Stopped at")
    over = page.locator("[data-view=time] .u-over")
    over.scroll_into_view_if_needed()
    box = over.bounding_box()
    assert box is not None
    x, y = box["x"] + 0.2 * box["width"], box["y"] + 0.3 * box["height"]
    page.mouse.move(x, y)
    page.mouse.wheel(0, -100)
    until_shown(page, -4, 16)  # about the trigger
    assert len(page.evaluate(RECORD)["times"]) in range(40, 46)
    page.mouse.down()
    page.mouse.move(x + 0.5 * box["width"], y)
    page.mouse.up()
    until_shown(page, -14, 6)
    expect(page.locator("[data-trace=CH2] td").nth(1)).to_have_text("1")
    page.mouse.move(x, y)
    for _ in range(12):
        page.mouse.wheel(0, 100)
    shown = until(page, lambda: page.evaluate(RECORD), lambda found: found["times"][0] < -60.0)
    assert shown["times"][-1] == pytest.approx(39.5)  # all that was sampled
    over.dblclick()
    until_shown(page, -10, 40)
    page.locator("[data-view=time]").press("+")
    until_shown(page, 5, 25)
    page.locator("[data-view=time]").press("ArrowRight")
    until_shown(page, 7, 27)
    page.locator("[data-view=time]").press("0")
    until_shown(page, -10, 40)


def test_the_level_of_the_trigger_is_dragged_and_acts_at_once(page: Page, served: Served) -> None:
    served.call(partial(write, value=1.0))
    arm_on_flag(page, 1922, "normal", **{"CH1 units/div": "1", "CH1 offset": "0"})
    page.get_by_label("Trigger source", exact=True).select_option("CH1")
    press(page, "START")
    expect(status(page)).to_contain_text("WAITING")
    over = page.locator("[data-view=time] .u-over")
    over.scroll_into_view_if_needed()
    box = over.bounding_box()
    assert box is not None
    division = box["height"] / 10.0
    x, middle = box["x"] + 5.0, box["y"] + 5.0 * division
    page.mouse.move(x, middle - 0.5 * division)  # the level is 0.5
    page.mouse.down()
    page.mouse.move(x, middle - 3.0 * division)
    page.mouse.up()
    level = float(page.get_by_label("Trigger level", exact=True).input_value())
    assert level == pytest.approx(3.0, abs=0.05)
    until(page, lambda: served.call(trigger_level), lambda found: found == level)
    for key, by in (("ArrowDown", -0.1), ("Shift+ArrowUp", 1.0), ("ArrowUp", 0.1)):
        page.locator("[data-view=time]").press(key)
        level = float(f"{level + by:.4g}")
        until(page, lambda: served.call(trigger_level), level.__eq__)
    fill(page, {"Trigger level": "3"})
    press(page, "START")
    until(page, lambda: served.call(trigger_level), (3.0).__eq__)
    expect(status(page)).to_contain_text("WAITING")
    served.call(lambda station: station.link.machine.card.pause(0.1))
    served.call(partial(write, value=2.9))
    served.call(lambda station: station.link.machine.card.pause(0.1))
    assert served.call(lambda station: capture_of(station).triggered_at) is None
    served.call(partial(write, value=3.1))
    until_model(page, "model.capture.value.swept !== null")
    press(page, "STOP SCOPE")


def trigger_level(station: Station) -> float | None:
    """The level at which the scope triggers."""
    capture = capture_of(station)
    return None if capture is None or capture.trigger is None else capture.trigger.level


def test_a_reference_is_compared_with_the_next_record(page: Page, served: Served) -> None:
    for value in (1.0, 4.25):
        served.call(partial(write, value=value))
        fill(page, {"CH1 source": "P7", "CH2 source": "", "CH8 source": "", "M source": ""})
        page.get_by_label("Trigger", exact=True).select_option("roll")
        press(page, "START")
        cells = page.locator("[data-trace=CH1] td")
        expect(cells.first).to_have_text(f"{value:g}")
        if value == 1.0:
            press(page, "REFERENCE")
    expect(cells.last).to_have_text("3.25")
    press(page, "REFERENCE")
    expect(cells.last).to_have_text("\u2013")
    press(page, "STOP SCOPE")


def begin_branches(station: Station) -> None:
    """P7 is 2 for a minute on branch 1 and 5 on branch 2, which the machine is operated on."""
    times = station.times
    tick = times.history.lived_tk - 10
    for value in (2.0, 5.0):
        times.seek(tick) if not station.link.is_away else times.switch(0, tick)
        times.write(7, value, is_flag=False)
        times.history.timeline.advance(120_000 if value == 2.0 else 1)
    times.operate(station.now_s)


def test_another_branch_is_compared_at_the_ticks_of_the_record(page: Page, served: Served) -> None:
    served.call(begin_branches)
    until_model(page, "model.timeline.value.branches.length === 3 && !model.timeline.value.away")
    clock, pulse = "P6916", "BIT81"  # equal on all branches at equal ticks only
    fill(page, {"CH1 source": "P7", "CH2 source": clock, "CH3 source": pulse, "M source": "2*CH1"})
    page.get_by_label("Trigger", exact=True).select_option("roll")
    press(page, "START")
    for name, value, reference in (("CH1", "5", "3"), ("M", "10", "6")):
        cells = page.locator(f"[data-trace={name}] td")
        expect(cells.first).to_have_text(value)
        if name == "CH1":
            press(page, "STOP SCOPE")
            expect(page.locator("[data-pane=scope] [role=status]")).to_contain_text("Stopped at")
            press(page, "BRANCH")
            page.get_by_role("dialog").get_by_role("button", name="branch 1").click()
        expect(cells.last).to_have_text(reference)
    for name in ("CH2", "CH3"):
        expect(page.locator(f"[data-trace={name}] td").last).to_have_text("0")
    press(page, "REFERENCE")
    expect(cells.last).to_have_text("\u2013")


def kept_row(page: Page, name: str) -> Locator:
    return page.get_by_role("dialog").locator(f"[data-kept='{name}']")


def test_setups_and_references_are_kept_under_names_and_shared_by_browsers(
    page: Page, served: Served, context: BrowserContext
) -> None:
    served.call(partial(write, value=3.0))
    fill(page, {"CH1 source": "P7", "CH2 source": "", "CH3 source": "", "CH8 source": "",
                "CH1 units/div": "0.5", "M source": "2*CH1", "Sampling, ms": "1"})  # fmt: skip
    page.get_by_label("Trigger", exact=True).select_option("roll")
    press(page, "START")
    expect(page.locator("[data-trace=M] td").first).to_have_text("6")
    press(page, "STOP SCOPE")
    expect(status(page)).to_contain_text("Stopped at")
    press(page, "SET-UPS")
    dialog = page.get_by_role("dialog", name="SET-UPS")
    expect(dialog).to_contain_text("Nothing is kept yet")
    for kind, name in (("SET-UP", "Z axis"), ("REFERENCE", "at three")):
        dialog.get_by_role("button", name=f"KEEP {kind} AS").click()
        page.get_by_role("textbox", name="Name").fill(name)
        page.keyboard.press("Enter")
        expect(page.locator("#prompt")).to_contain_text(f"{name} is kept")
    expect(dialog.get_by_role("listitem")).to_have_count(2)
    page.keyboard.press("Escape")
    fill(page, {"CH1 source": "P6", "CH1 units/div": "4", "M source": ""})
    page.get_by_label("Trigger", exact=True).select_option("free")

    other = open_page(context, f"{served.url}/bench")
    show_scope(other)
    fill(other, {"CH4 source": "P1"})
    press(other, "SET-UPS")
    kept_row(other, "setup Z axis").get_by_role("button", name="Z axis").first.click()
    expect(other.locator("#prompt")).to_contain_text("set-up Z axis is taken")
    shown = {name: other.get_by_label(name, exact=True).input_value() for name in
             ("CH1 source", "CH1 units/div", "CH4 source", "M source", "Trigger")}  # fmt: skip
    assert list(shown.values()) == ["P7", "0.5", "", "2*CH1", "roll"]
    served.call(partial(write, value=4.25))
    press(other, "START")
    expect(other.locator("[data-trace=CH1] td").first).to_have_text("4.25")
    press(other, "SET-UPS")
    kept_row(other, "reference at three").get_by_role("button", name="at three").first.click()
    expect(other.locator("[data-trace=CH1] td").last).to_have_text("1.25")
    expect(other.locator("[data-trace=M] td").last).to_have_text("2.5")
    press(other, "STOP SCOPE")
    other.close()

    press(page, "SET-UPS")
    with page.expect_download() as saved:
        kept_row(page, "setup Z axis").get_by_role("link", name="FILE").click()
    text = saved.value.path().read_bytes()
    assert saved.value.suggested_filename == "Z axis.setup.json"
    files = dialog.locator("input[type=file]")
    files.set_input_files({"name": "notes.json", "mimeType": "text/plain", "buffer": b"{1}"})
    expect(page.locator("#prompt")).to_contain_text("notes is no set-up: JSON is")
    files.set_input_files({"name": "copy.setup (1).json", "mimeType": "text/plain", "buffer": text})
    expect(kept_row(page, "setup copy")).to_be_visible()
    kept_row(page, "setup copy").get_by_role("button", name="DELETE").click()
    page.get_by_role("dialog", name="DELETE").get_by_role("button", name="DELETE").click()
    expect(kept_row(page, "setup copy")).to_have_count(0)
    kept_row(page, "setup Z axis").get_by_role("button", name="RENAME").click()
    page.get_by_role("textbox", name="Name").fill("X axis")
    page.keyboard.press("Enter")
    expect(kept_row(page, "setup X axis")).to_be_visible()
    page.keyboard.press("Escape")
    page.complaints.clear()  # type: ignore[attr-defined]


def test_xy_and_spectrum_are_views_of_the_same_record(page: Page) -> None:
    press(page, "XY")
    expect(page.locator("[data-view=xy] canvas")).to_be_visible()
    press(page, "FFT")
    expect(page.locator("[data-view=spectrum] canvas")).to_be_visible()
    press(page, "TIME")
    expect(page.locator("[data-view=time] canvas")).to_be_visible()
    fill(page, {"M source": "CH1 +* 2"})
    expect(page.locator("#prompt")).to_contain_text("M: * is not understood")
    fill(page, {"M source": ""})
    press(page, "SETTINGS")
    expect(page.locator("[data-pane=scope] .scope-rows")).to_be_hidden()
    press(page, "SETTINGS")
    assert page.complaints == []  # type: ignore[attr-defined]


INK = """() => {
  const canvas = document.querySelector('[data-view=time] canvas');
  const { data } = canvas.getContext('2d').getImageData(0, 0, 40, canvas.height);
  let sum = 0, count = 0;
  for (let n = 0; n < data.length; n += 4) if (data[n + 3] > 200) { sum += data[n]; count++; }
  return count ? sum / count : -1;
}"""  # red of the labels beside the plot


def test_a_record_at_rest_is_drawn_again_in_the_colours_of_another_theme(page: Page) -> None:
    page.emulate_media(color_scheme="light")
    until(page, lambda: page.evaluate(INK), lambda found: 0 <= found < 100)
    page.emulate_media(color_scheme="dark")
    until(page, lambda: page.evaluate(INK), lambda found: found > 150)
    page.emulate_media(color_scheme="light")
    until(page, lambda: page.evaluate(INK), lambda found: 0 <= found < 100)


def test_numbers_of_a_channel_are_shown_whole_and_the_plot_has_room(page: Page) -> None:
    for size, least in (
        ((1366, 768), (530, 170)), ((1920, 1080), (780, 400)), ((390, 844), (250, 120)),
    ):  # fmt: skip
        page.set_viewport_size({"width": size[0], "height": size[1]})
        show_scope(page)
        fill(page, {
            "CH1 units/div": "200000", "CH2 units/div": "0.000125", "CH1 offset": "-1234567",
            "CH2 offset": "40000.25", "Trigger level": "-1234567",
        })  # fmt: skip
        assert left_over(page, CUT, f"() => ({ROOM})([{least[0]}, {least[1]}])") == []


def test_flags_are_in_lanes_below_curves_that_have_axes_of_their_own(
    page: Page, served: Served
) -> None:
    page.set_viewport_size({"width": 1920, "height": 1080})
    show_scope(page)
    fill(page, {
        "CH1 source": "P7", "CH2 source": "P6", "CH3 source": "BIT1921", "CH4 source": "BIT1922",
        "CH1 units/div": "2", "CH1 offset": "0", "CH1 unit": "mm", "CH2 unit": "mm",
        "CH2 units/div": "5", "CH2 offset": "1", "Sweep, ms/div": "5", "Sampling, ms": "0.5",
    })  # fmt: skip
    page.get_by_label("Trigger", exact=True).select_option("free")
    page.get_by_label("Flags", exact=True).select_option("lanes")
    served.call(partial(write, value=4.0))
    served.call(partial(switch, flag=1921, on=True))
    served.call(partial(switch, flag=1922, on=False))
    press(page, "START")
    for axes, places, names in (
        ("divisions", [2.0, -0.2, -3.1, -4.9], []),
        ("own", [2.0, -0.2, -3.1, -4.9], ["CH1 mm", "CH2 mm"]),
        ("unit", [2.0, 0.0, -3.1, -4.9], ["mm"]),
    ):
        page.get_by_label("Y axes", exact=True).select_option(axes)

        def look() -> list[Any]:
            found = page.evaluate(RECORD)
            return [*(round(each[-1], 3) for each in found["channels"] if each), found["axes"]]

        until(page, look, [*places, names].__eq__)
    press(page, "STOP SCOPE")
    expect(status(page)).to_contain_text("Stopped at")
    fill(page, {"CH4 source": "", "CH1 unit": "", "CH2 unit": ""})
    page.get_by_label("Y axes", exact=True).select_option("divisions")


# --- long records ---------------------------------------------------------------------


def an_hour_of_the_clock(station: Station) -> int:
    """A record of the clock of the card every 100 ms, and of a flag; its samples."""
    record = station.records.begin(1, [named("P6916"), named("BIT1921")], 0.1, take=True)
    station.records.end()
    record.samples = Pyramid(2, 1 << 24)
    clock = 100.0 * np.arange(36_000.0)
    record.samples.append(np.array([clock, clock * 0.0]))
    return record.samples.next


def test_any_part_of_an_hour_is_zoomed_dragged_measured_and_exported(
    page: Page, served: Served
) -> None:
    page.set_viewport_size({"width": 1366, "height": 768})
    show_scope(page)
    fill(
        page,
        {
            "Sweep, ms/div": "1000",
            "Sampling, ms": "100",
            "M source": "",
            "CH1 unit": "",
            "CH2 unit": "",
        },
    )
    page.get_by_label("Trigger", exact=True).select_option("record")
    count = served.call(an_hour_of_the_clock)
    assert count == 36_000
    expect(status(page)).to_have_text("Record of 1:00:00")
    expect(page.get_by_label("CH1 source", exact=True)).to_have_value("P6916")
    expect(page.get_by_label("CH2 source", exact=True)).to_have_value("BIT1921")
    strip = page.locator(".scope-overview")
    strip.focus()
    page.keyboard.press("0")  # the whole hour
    row = page.locator("[data-trace=CH1] td")
    span = 100.0 * (count - 1)
    expect(row.last).to_have_text("\u2013")
    expect(row.nth(4)).to_have_text(f"{span:g}" if span < 1e6 else str(int(span)))
    for _ in range(12):
        page.keyboard.press("+")
    page.keyboard.press("End")
    until(page, lambda: page.evaluate(RECORD)["x"], lambda found: found[1] == 100.0 * count)
    clock = until(
        page,
        lambda: page.evaluate(RECORD)["times"],
        lambda found: len(found) > 10 and found[-1] > 3.59e6,
    )
    assert set(np.diff(clock).round()) == {100.0}  # every sample
    box = strip.bounding_box()
    assert box is not None
    middle = box["x"] + box["width"] / 2.0
    page.mouse.move(middle, box["y"] + 9.0)
    page.mouse.down()
    page.mouse.up()
    x = until(page, lambda: page.evaluate(RECORD)["x"], lambda found: found[0] < 1.9e6)
    assert sum(x) / 2.0 == pytest.approx(1.8e6, abs=4000.0)
    with page.expect_download() as saved:
        press(page, "EXPORT")
        page.get_by_role("dialog").get_by_role("button", name="CSV").click()
    lines = saved.value.path().read_text().splitlines()
    assert lines[0].startswith("time_s,CH1 P6916 SYSTEM Global System Clock [ms],CH2 BIT1921")
    values = [float(line.split(",")[1]) for line in lines[1:]]
    assert set(np.diff(values)) == {100.0}
    assert len(values) == pytest.approx((x[1] - x[0]) / 100.0, abs=1.0)
    assert page.complaints == []  # type: ignore[attr-defined]


def test_a_long_part_is_computed_with_compared_and_exported(page: Page, served: Served) -> None:
    strip = page.locator(".scope-overview")
    strip.focus()
    page.keyboard.press("0")
    fill(page, {"M source": "2*CH1"})
    row = page.locator("[data-trace=M] td")
    expect(row.nth(1)).to_have_text("7199800")  # of 36,000 samples, on some hundred pixels
    press(page, "FFT")
    expect(page.locator("[data-trace=CH1] td").first).to_contain_text("Hz")
    press(page, "TIME")
    strip.focus()
    for _ in range(12):
        page.keyboard.press("+")
    page.keyboard.press("Home")
    until(page, lambda: page.evaluate(RECORD)["times"], lambda found: len(found) > 10)
    press(page, "REFERENCE")
    strip.focus()
    page.keyboard.press("ArrowRight")  # the reference begins at the left edge
    x = until(page, lambda: page.evaluate(RECORD)["x"], lambda found: bool(found[0] > 0.0))
    delta = page.locator("[data-trace=CH1] td").last
    expect(delta).to_have_text(f"{x[0]:g}")
    press(page, "CURSORS")
    expect(page.locator("[data-cursors]")).to_contain_text("t1")
    first = 0.75 * x[0] + 0.25 * x[1]
    expect(delta).to_have_text(f"{100.0 * np.ceil(first / 100.0 - 0.5):g}")  # and at a cursor
    with page.expect_download() as saved:
        press(page, "EXPORT")
        page.get_by_role("dialog").get_by_role("button", name="PARQUET").click()
    found = parquet.read_table(saved.value.path())
    clock = found["CH1 P6916 SYSTEM Global System Clock [ms]"].to_numpy()
    assert clock[0] == pytest.approx(first, abs=50.0)
    assert set(np.diff(clock)) == {100.0}
    press(page, "CURSORS")
    press(page, "REFERENCE")


def more_of_the_clock(station: Station) -> None:
    record = station.records.record
    assert record is not None
    record.samples.append(np.zeros((2, 20_000)))


def test_a_part_with_too_many_samples_says_why_nothing_is_computed(
    page: Page, served: Served
) -> None:
    served.call(more_of_the_clock)
    strip = page.locator(".scope-overview")
    strip.focus()

    def end() -> float:
        page.keyboard.press("0")  # until the new end is known
        return float(page.evaluate(RECORD)["x"][1])

    until(page, end, lambda found: found > 5e6)
    why = "56000 samples are on the screen: M, XY and FFT are computed of 50000 at most, 5000 s"
    expect(page.locator("[data-cursors]")).to_have_text(why)
    expect(page.locator("[data-trace=M]")).to_have_count(0)
    press(page, "FFT")
    expect(page.locator("#prompt")).to_contain_text(why)
    expect(page.locator("[data-view=time] canvas")).to_be_visible()
    fill(page, {"M source": ""})
    expect(page.locator("[data-cursors]")).to_have_text("")
    page.complaints.clear()  # type: ignore[attr-defined]


def test_a_cursor_is_moved_by_keys_and_says_what_is_there(page: Page) -> None:
    strip = page.locator(".scope-overview")
    strip.focus()
    for _ in range(14):
        page.keyboard.press("+")
    page.keyboard.press("Home")
    until(page, lambda: page.evaluate(RECORD)["times"], lambda found: 4 < len(found) < 60)
    press(page, "CURSORS")
    (first, last), width = page.evaluate(RECORD)["x"], last_width(page)
    step = max(100.0, (last - first) / width)
    cursors = [page.get_by_role("slider", name=f"Cursor t{n}") for n in (1, 2)]
    times = [first + share * (last - first) for share in (0.25, 0.75)]
    cursors[0].focus()
    for key, by in (
        ("ArrowRight", 1),
        ("ArrowRight", 1),
        ("ArrowLeft", -1),
        ("Shift+ArrowRight", 10),
    ):
        cursors[0].press(key)
        times[0] = min(last, times[0] + by * step)
        expect(page.locator("[data-cursors]")).to_contain_text(f"t1 {times[0]:g} ms")
    page.keyboard.press("Tab")
    expect(cursors[1]).to_be_focused()
    cursors[1].press("ArrowLeft")
    times[1] -= step
    expect(page.locator("[data-cursors]")).to_contain_text(f"t2 {times[1]:g} ms")
    clock = 100 * int(np.floor(times[1] / 100.0 + 0.5))
    said = f"{times[1]:g} ms: CH1 {clock} ms, CH2 0"
    expect(cursors[1]).to_have_attribute("aria-valuetext", said)
    expect(page.locator("[data-trace=CH1] td").nth(1)).to_have_text(str(clock))
    press(page, "CURSORS")
    expect(cursors[1]).to_be_hidden()


def last_width(page: Page) -> float:
    """Pixels of the plot."""
    return float(page.evaluate("document.querySelector('[data-view=time] .u-over').clientWidth"))


def test_the_end_of_a_record_that_grows_stays_on_the_screen_until_it_is_moved(
    page: Page, served: Served
) -> None:
    show_scope(page)
    fill(page, {"CH1 source": "P6916", "CH2 source": "", "Sweep, ms/div": "50",
                "Sampling, ms": "1"})  # fmt: skip
    page.get_by_label("Trigger", exact=True).select_option("record")
    press(page, "START")
    page.get_by_role("dialog").get_by_role("button", name="RECORD").click()  # the hour is dropped
    expect(status(page)).to_contain_text("RECORDING")

    def edge() -> float:
        return float(page.evaluate(RECORD)["x"][0])

    first = until(page, edge, lambda found: found > 0.0)
    until(page, edge, lambda found: found > first)
    page.locator(".scope-overview").focus()
    page.keyboard.press("Home")
    until(page, edge, lambda found: found == 0.0)
    served.call(lambda station: station.link.machine.card.pause(0.2))
    assert edge() == 0.0
    page.keyboard.press("End")
    until(page, edge, lambda found: found > first)
    press(page, "STOP SCOPE")
    expect(status(page)).to_contain_text("Record of")
    assert not served.call(lambda station: station.records.data()["running"])
