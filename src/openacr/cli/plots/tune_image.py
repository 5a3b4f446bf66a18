"""Draw what a measurement of an axis shows: record, steps, frequency responses, coherence."""

from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator

from openacr.cli.plots.image import ACTUAL, COMMANDED, ERROR, QUIET, VELOCITY
from openacr.cli.plots.saved import save
from openacr.tuning.advice import Advice, advice_data
from openacr.tuning.curves import curves
from openacr.tuning.measure import Measurement

_STYLE: Any = {"font.size": 8, "axes.grid": True, "grid.color": "#dddddd", "axes.axisbelow": True}
STEP_DB, STEP_DEG = 20.0, 45.0
LOOPS = (("present", ERROR), ("proposed", VELOCITY))


def write_tuning(advice: Advice, path: Path) -> None:
    """Draw an advice into a PNG or SVG file."""
    with mpl.rc_context(_STYLE):
        save(build_figure(advice), path, dpi=110)


def write_step(found: Measurement, path: Path) -> None:
    """Draw a recorded step into a PNG or SVG file."""
    with mpl.rc_context(_STYLE):
        figure = Figure(figsize=(7.0, 4.5), layout="constrained")
        figure.suptitle(f"axis {found.axis}", x=0.01, ha="left")
        panel, record = figure.subplots(), curves(found.record)[0]
        panel.plot(record["time_s"], record["setpoint_cnt"], COMMANDED, label="setpoint")
        panel.plot(record["time_s"], record["actual_cnt"], ACTUAL, label="measured")
        _named(panel, "time [s]", "position [pulses]")
        save(figure, path, dpi=110)


def build_figure(advice: Advice) -> Figure:
    """Record and steps on the left; magnitude, phase and coherence on the right."""
    data = advice_data(advice)
    figure = Figure(figsize=(12.0, 7.5), layout="constrained")
    figure.suptitle(f"axis {data['axis']}", x=0.01, ha="left")
    left, right = figure.subfigures(1, 2, squeeze=False)[0]
    record, steps = left.subplots(2, 1)
    _record(record, data)
    _steps(steps, data)
    magnitude, phase, coherence = right.subplots(
        3, 1, sharex=True, gridspec_kw={"height_ratios": (2.0, 2.0, 1.0)}
    )
    _bode(magnitude, phase, coherence, data["bode"])
    _margins(magnitude, phase, data)
    _resonance(magnitude, data["resonance"])
    return figure


def _record(panel: Axes, data: dict[str, Any]) -> None:
    measured, modelled = data["measured"], data["modelled"]
    panel.plot(measured["time_s"], measured["setpoint_cnt"], COMMANDED, label="setpoint")
    panel.plot(measured["time_s"], measured["actual_cnt"], ACTUAL, label="measured")
    panel.plot(modelled["time_s"], modelled["actual_cnt"], ERROR, lw=0.8, label="modelled")
    _named(panel, "time [s]", "position [pulses]")


def _steps(panel: Axes, data: dict[str, Any]) -> None:
    for name, color in LOOPS:
        if data[name] is not None:
            step = data[name]["step"]
            panel.plot(step["time_s"], step["actual_cnt"], color, label=f"step, {name} gains")
    step = data["present"]["step"]
    panel.plot(step["time_s"], step["setpoint_cnt"], COMMANDED, zorder=0)
    _named(panel, "time [s]", "predicted position [pulses]")


def _bode(magnitude: Axes, phase: Axes, coherence: Axes, bode: dict[str, Any]) -> None:
    measured = bode["measured"]
    for panel, key in ((magnitude, "magnitude_db"), (phase, "phase_deg")):
        panel.semilogx(
            measured["frequency_hz"],
            measured[key],
            ".",
            color=ACTUAL,
            ms=3,
            label="motor, measured",
        )
        panel.semilogx(
            bode["frequency_hz"], bode["motor"][key], QUIET, lw=0.8, label="motor, model"
        )
        for name, color in LOOPS:
            if name in bode:
                panel.semilogx(bode["frequency_hz"], bode[name][key], color, label=f"loop, {name}")
    for panel, step, level in ((magnitude, STEP_DB, 0.0), (phase, STEP_DEG, -180.0)):
        panel.yaxis.set_major_locator(MultipleLocator(step))
        panel.axhline(level, color=QUIET, lw=1.2, zorder=1)  # margins are read from here
    coherence.semilogx(measured["frequency_hz"], measured["coherence"], ACTUAL)
    coherence.set_ylim(0.0, 1.05)
    _named(magnitude, "", "magnitude [dB]")
    phase.set_ylabel("phase [deg]")
    coherence.set_ylabel("coherence")
    coherence.set_xlabel("frequency [Hz]")


def _margins(magnitude: Axes, phase: Axes, data: dict[str, Any]) -> None:
    """Mark the crossover and where the loop would oscillate."""
    for name, color in LOOPS:
        if data[name] is None:
            continue
        found = data[name]["margins"]
        if found["crossover_hz"] and found["phase_deg"] is not None:
            at_deg = found["phase_deg"] - 180.0
            phase.vlines(found["crossover_hz"], -180.0, at_deg, color, lw=2.0)
        if found["gain_db"] is not None:
            magnitude.vlines(found["gain_at_hz"], -found["gain_db"], 0.0, color, lw=2.0)


def _resonance(magnitude: Axes, found: dict[str, Any]) -> None:
    """Mark where the load swings on its shaft."""
    if found["resonance_hz"] is not None:
        magnitude.axvline(found["resonance_hz"], color=QUIET, ls=":", lw=1.0)
        text = f"resonance {found['resonance_hz']:.4g} Hz"
        at = (found["resonance_hz"], 0.98)
        magnitude.text(
            *at, text, fontsize=7, rotation=90, va="top", ha="right",
            transform=magnitude.get_xaxis_transform(),
        )  # fmt: skip


def _named(panel: Axes, x: str, y: str) -> None:
    panel.set_xlabel(x)
    panel.set_ylabel(y)
    panel.legend(loc="best", fontsize=7)
