"""What `openacr tune` prints: the motor, and present and proposed gains side by side."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from openacr.tuning.advice import Advice, Outlook
    from openacr.tuning.filters import Filters
    from openacr.tuning.measure import Measurement
    from openacr.tuning.predict import StepFigures
    from openacr.tuning.propose import Proposal
    from openacr.tuning.resonance import Resonance


def lines(advice: "Advice", *, with_proposal: bool) -> Iterator[str]:
    """The advice as text."""
    from openacr.tuning.excitation import SWEEP_S

    found, measurement = advice.identified, advice.measurement
    motor, volts = found.motor, found.motor.accel_per_volt
    excitation = measurement.excitation
    yield (
        f"axis {measurement.axis}: {len(measurement.record.setpoint_cnt)} samples at"
        f" {1.0 / measurement.settings.period_s:g} Hz, amplitude {excitation.height_cnt:g} pulses,"
        f" {excitation.low_hz:g} to {excitation.high_hz:g} Hz"
    )
    if excitation.is_shortened and excitation.duration_s < SWEEP_S:
        yield (
            f"  a sweep of {excitation.duration_s:g} s: no empty program has room for {SWEEP_S:g} s"
        )
    spread = 100.0 * found.deviations["accel_per_volt"] / volts
    yield f"motor: {volts:.4g} pulses/s2 per V (+-{spread:.1g} %), rate {motor.rate_per_s:.3g} /s,"
    yield (
        f"  friction {motor.coulomb_accel / volts:.3g} V, offset {motor.offset_v:.3g} V,"
        f" delay {motor.delay_tk:.2g} servo periods beside the one of the loop"
    )
    yield _resonance(found.resonance)
    yield (
        f"sure: {'yes' if found.is_sure else 'no'}, {found.error_percent:.1f} % of the response"
        f" is unexplained, coherence {found.coherence:.2f}"
    )
    shown = [("present", advice.present)]
    if with_proposal and advice.proposed is not None:
        shown.append(("proposed", advice.proposed))
    yield f"{'':26}" + "".join(f"{name:>14}" for name, _loop in shown)
    for title, cells in _table([loop for _name, loop in shown]):
        yield f"{title:26}" + "".join(f"{cell:>14}" for cell in cells)
    if with_proposal and advice.proposal is not None:
        if advice.proposal.limited_by:
            yield f"faster is barred: {advice.proposal.limited_by}"
        yield from _worse(advice)
        yield from _setting(advice, advice.proposal)


def _setting(advice: "Advice", proposal: "Proposal") -> Iterator[str]:
    """The lines that set a proposal; filters where they differ from those of the axis."""
    from openacr.tuning.advice import new_filters

    axis = advice.measurement.axis
    if (filters := new_filters(advice)) is not None:
        yield from filters.lines(axis)
    gains = " ".join(f"{word} {value:.7G}" for word, value in proposal.gains.items())
    yield f"AXIS{axis} {gains}"


def _worse(advice: "Advice") -> Iterator[str]:
    """What the proposed gains are predicted to make worse, so that no one sets them unread."""
    from openacr.tuning.advice import worse

    names = {
        "overshoot_percent": "overshoot [%] of a step",
        "rise_s": "rise [ms] of a step",
        "settling_s": "settling [ms] of a step",
        "rms_error_cnt": "RMS error [pulses] of the sweep",
        "phase_deg": "phase margin [deg]",
        "gain_db": "gain margin [dB]",
        "bandwidth_hz": "bandwidth [Hz]",
    }
    for name, (before, after) in worse(advice).items():
        shown = [
            _ms(each) if name.endswith("_s") else "-" if each is None else f"{each:.1f}"
            for each in (before, after)
        ]
        yield (
            f"worse than the present gains: {names[name]} {shown[1]} instead of {shown[0]}"
            " (--phase, --bandwidth ask for calmer ones)"
        )


def _resonance(found: "Resonance") -> str:
    shaft = found.shaft
    if shaft is None:
        return f"resonance: {found.reason}"
    return (
        f"resonance: {shaft.resonance_hz:.4g} Hz (+-{found.deviations['resonance_hz']:.1g}),"
        f" antiresonance {shaft.antiresonance_hz:.4g} Hz, damping {shaft.damping_ratio:.2g}"
        f" (+-{found.deviations['damping_ratio']:.1g}), load {shaft.inertia_ratio:.2g} of the motor"
    )


def step_lines(measurement: "Measurement", found: "StepFigures") -> Iterator[str]:
    """A recorded step as text."""
    height = measurement.excitation.height_cnt
    yield f"axis {measurement.axis}: step of {height:g} pulses with the present gains"
    yield f"{'overshoot [%]':26}{found.overshoot_percent:>14.1f}"
    yield f"{'rise [ms]':26}{_ms(found.rise_s):>14}"
    yield f"{'settling [ms]':26}{_ms(found.settling_s):>14}"


def _table(loops: "list[Outlook]") -> Iterator[tuple[str, list[str]]]:
    for word in loops[0].settings.gains:
        yield word, [f"{loop.settings.gain(word):.5G}" for loop in loops]
    judged = [loop.margins for loop in loops]
    if any(loop.settings.is_filtering for loop in loops):
        yield "LOPASS [Hz]", [_filter(loop.settings.filters, "lopass_hz") for loop in loops]
        yield "NOTCH [Hz]", [_filter(loop.settings.filters, "notch_hz") for loop in loops]
        yield "  width [Hz]", [_filter(loop.settings.filters, "notch_width_hz") for loop in loops]
    yield "stable", ["yes" if each.is_stable else "no" for each in judged]
    yield "crossover [Hz]", [f"{each.crossover_hz:.1f}" for each in judged]
    yield "phase margin [deg]", [f"{each.phase_deg:.1f}" for each in judged]
    yield "gain margin [dB]", [f"{each.gain_db:.1f}" for each in judged]
    yield "bandwidth [Hz]", [f"{each.bandwidth_hz:.1f}" for each in judged]
    steps = [loop.figures for loop in loops]
    yield "step: overshoot [%]", [f"{each.overshoot_percent:.1f}" for each in steps]
    yield "step: rise [ms]", [_ms(each.rise_s) for each in steps]
    yield "step: settling [ms]", [_ms(each.settling_s) for each in steps]
    if steps[0].vibration_cnt is not None:
        yield "step: load swings [pulses]", [f"{each.vibration_cnt:.2g}" for each in steps]
    yield "sweep: RMS error [pulses]", [f"{loop.rms_error_cnt:.1f}" for loop in loops]
    if loops[0].move_error_cnt is not None:
        yield "move: error [pulses]", [f"{loop.move_error_cnt:.0f}" for loop in loops]


def _filter(filters: "Filters | None", name: str) -> str:
    return "by hand" if filters is None else f"{getattr(filters, name):.5G}"


def _ms(value_s: float | None) -> str:
    return "-" if value_s is None else f"{1000.0 * value_s:.1f}"
