"""The scope of the workspace: its arithmetic against NumPy and SciPy, its pane on a card."""

from functools import partial
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import BrowserContext, Page, expect
from pyarrow import parquet
from scipy import integrate, signal
from tests.panel.bench import Served
from tests.panel.browser.conftest import open_page, until_model

from openacr.panel.control.station import Station

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


def test_a_record_with_a_gap_has_no_spectrum(page: Page) -> None:
    evaluated = page.evaluate(
        "import('/js/scope/spectrum.js').then((m) => m.spectrum([1, NaN, 2], 1, 'hann'))"
    )
    assert evaluated is None


@pytest.mark.parametrize(("value", "decibels"), [(1.0, 0.0), (0.1, -20.0), (0.0, -300.0)])
def test_decibels_are_of_one_unit(page: Page, value: float, decibels: float) -> None:
    assert call(page, "spectrum", "decibels", value) == pytest.approx(decibels)


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


def test_missing_samples_are_not_measured(page: Page) -> None:
    assert page.evaluate("""import('/js/scope/measures.js').then(({ measured, deviation }) => [
        measured([NaN, 3, NaN, -4], 0, 3), measured([1, NaN], 1, 1),
        deviation([1, NaN, 5], [2, 9, 3, 100]), deviation([NaN], [1])])""") == [
        {"count": 2, "min": -4, "max": 3, "mean": -0.5, "rms": pytest.approx(12.5**0.5), "span": 7},
        None, 2, None,
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("values", "scale", "offset"),
    [
        ([0, 80], 10, 40), ([-1, 7.1], 2, 4), ([0, 32], 5, 15), ([3, 3], 1, 3),
        ([-4e-6, 4e-6], 1e-6, 0),
    ],
)  # fmt: skip
def test_autoscale_shows_the_whole_in_steps_of_1_2_and_5(
    page: Page, values: list[float], scale: float, offset: float
) -> None:
    assert call(page, "screen", "fitting", values) == {"scale": scale, "offset": offset}
    assert call(page, "screen", "fitting", []) is None


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


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("", ""), ("CH1 +", ""), ("CH3", "CH3"), ("CH1 CH2", "CH2"), ("sqrt CH1", "CH1"),
        ("min(CH1)", ")"), ("abs(CH1, CH2)", ","), ("(CH1", ""), ("CH1)", ")"),
        ("CH1 = 2", "="), ("window", "window"), ("constructor", "constructor"), ("CH1.x", "."),
        ("toString(CH1)", "toString"), ("1e3", "e3"), ("alert(1)", "alert"),
    ],
)  # fmt: skip
def test_a_text_that_is_no_expression_is_refused_with_the_word(
    page: Page, text: str, what: str
) -> None:
    assert page.evaluate(
        """(text) => import('/js/scope/maths.js').then((m) => {
          try { m.computed(text, [[1], [2]], 1); } catch (error) { return [error.constructor.name, error.what]; }
        })""",  # noqa: E501
        text,
    ) == ["ExpressionError", what]


# --- the pane -------------------------------------------------------------------------

RECORD = """() => import('/js/scope/screen.js').then(({ shown }) => shown.value)"""


@pytest.fixture(scope="module")
def bench(context: BrowserContext, served: Served) -> Page:
    """The scope alone in its place, for the tests of the pane."""
    page = open_page(context, f"{served.url}/bench")
    page.evaluate("import('/js/bench/workspace.js').then((each) => each.openPane('scope'))")
    expect(page.locator("[data-pane=scope] .scope-rows")).to_be_visible()
    return page


def write(station: Station, value: float) -> None:
    station.machine.card.write(7, value)


def press(page: Page, name: str) -> None:
    page.locator("[data-pane=scope] .pane-head").get_by_role("button", name=name).click()


def fill(page: Page, values: dict[str, str]) -> None:
    for label, value in values.items():
        field = page.get_by_label(label, exact=True)
        field.fill(value)
        field.press("Tab")


def test_a_single_sweep_of_a_flag_and_a_parameter_is_measured_and_exported(
    bench: Page, served: Served
) -> None:
    page = bench
    served.call(lambda station: station.machine.card.write(7, 0.0))
    served.call(lambda station: station.machine.card.write_bit(1920, True))
    fill(page, {
        "CH1 source": "P7", "CH2 source": "BIT1920", "CH3 source": "", "CH8 source": "p6916",
        "M source": "2*CH1 + CH2", "CH1 units/div": "2", "CH1 unit": "mm",
        "Sweep, ms/div": "5", "Sampling, ms": "0.5", "Trigger level": "1", "Pre-trigger, %": "20",
    })  # fmt: skip
    page.get_by_label("Trigger", exact=True).select_option("single")
    press(page, "START")
    until_model(page, "model.capture.value.running")
    served.call(lambda station: station.machine.card.pause(0.1))
    served.call(lambda station: station.machine.card.write(7, 3.5))
    expect(page.locator("[data-pane=scope] [role=status]")).to_contain_text("Stopped at")
    press(page, "CURSORS")
    row = page.locator("[data-trace=CH1] td")
    expect(row).to_have_text(["3.5", "3.5", "3.5", "3.5", "3.5", "3.5", "0", "\u2013"])
    expect(page.locator("[data-cursors]")).to_have_text(
        "t1 12.5 ms, t2 37.5 ms, \u0394t 25 ms, 1/\u0394t 40 Hz"
    )
    shown = page.evaluate(RECORD)
    assert len(shown["times"]) == 100
    assert shown["channels"][0] == [0.0] * 20 + [1.75] * 80  # 20 % before it: at the sample
    assert shown["channels"][3] == [float(7 * (n >= 20)) + 1.0 for n in range(100)]
    ticks = shown["channels"][2]
    assert ticks == sorted(ticks)
    press(page, "CURSORS")
    with page.expect_download() as saved:
        press(page, "EXPORT")
        page.get_by_role("dialog").get_by_role("button", name="CSV").click()
    lines = saved.value.path().read_text().splitlines()
    assert lines[0].startswith("time_s,CH1 [mm],CH2,CH8")
    assert [line.split(",")[1] for line in lines[1:]] == ["0"] * 20 + ["3.5"] * 80
    with page.expect_download() as saved:
        press(page, "EXPORT")
        page.get_by_role("dialog").get_by_role("button", name="PARQUET").click()
    table = parquet.read_table(saved.value.path())
    assert table.column("CH1 [mm]").to_pylist() == [0.0] * 20 + [3.5] * 80
    with page.expect_download() as saved:
        press(page, "EXPORT")
        page.get_by_role("dialog").get_by_role("button", name="PNG").click()
    assert saved.value.path().read_bytes().startswith(b"\x89PNG")
    assert page.complaints == []  # type: ignore[attr-defined]


def test_a_reference_is_compared_with_the_next_record(bench: Page, served: Served) -> None:
    page = bench
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
        times.seek(tick) if not times.is_away else times.switch(0, tick)
        times.write(7, value, is_flag=False)
        times.history.timeline.advance(120_000 if value == 2.0 else 1)
    times.operate(station.now_s)


def test_another_branch_is_compared_at_the_ticks_of_the_record(bench: Page, served: Served) -> None:
    page = bench
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


def test_xy_and_spectrum_are_views_of_the_same_record(bench: Page) -> None:
    page = bench
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
