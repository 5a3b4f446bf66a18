"""Global objects: AXISn, MASTERm, encoders, steppers and analog channels by number."""

from __future__ import annotations

from functools import partial

from openacr.basic.commands.value_commands import (
    ObjectValue,
    check_number,
    object_values,
    value_text,
)
from openacr.basic.language import registry
from openacr.basic.language.grammar import Num
from openacr.basic.language.registry import ANY
from openacr.basic.vm.run import Run
from openacr.map.rows import adcs as adc_rows
from openacr.map.rows import dacs as dac_rows
from openacr.map.rows import encoders as encoder_rows
from openacr.map.rows import steppers
from openacr.motion.axis import encoders, settings
from openacr.motion.axis.settings import Setting, fp32, long
from openacr.motion.card import Card

GROUP = "Global Objects"
REF = "PG Global Objects"
command = partial(registry.command, group=GROUP, ref=REF)
WORD_BITS = 32


def axes(card: Card) -> int:
    """How many axes, and stepper outputs, the card has."""
    return card.model.axes


def encoder_count(card: Card) -> int:
    """How many encoders the card has."""
    return card.model.encoders


def dacs(card: Card) -> int:
    """How many analog outputs the card has."""
    return card.model.dacs


def adcs(card: Card) -> int:
    """How many analog inputs the card has."""
    return card.model.adcs


def pulse_source(value: float) -> bool:
    """Quadrature, step and direction, or clockwise and counter-clockwise pulses."""
    return value in (0, 1, 2)


def word_width(value: float) -> bool:
    """As many bits as a position has."""
    return 0 <= value <= WORD_BITS and value == int(value)


ENCODER_SOURCE = long(encoder_rows.source, pulse_source)
SERIAL_CLOCK = long(encoder_rows.clock_hz, settings.not_negative)
SERIAL_WIDTH = long(encoder_rows.width, word_width)
STEPPER_COUNT = long(steppers.stepper_count)

object_values(
    (
        ObjectValue("ENC # SRC", ENCODER_SOURCE, encoder_count,
                    "Choose the pulses of an encoder: 0 quadrature, 1 step, 2 CW and CCW."),
        ObjectValue("ENC # MULT", settings.ENCODER_MULTIPLIER, encoder_count,
                    "Set edges counted and direction of an encoder.", "", "1"),
        ObjectValue("ENC # CLOCK", SERIAL_CLOCK, encoder_count,
                    "Set the clock with which an absolute encoder is read.", "Hz"),
        ObjectValue("ENC # WIDTH", SERIAL_WIDTH, encoder_count,
                    "Set the bits of an absolute encoder.", "bits"),
        ObjectValue("DAC # GAIN", fp32(dac_rows.dac_gain), dacs,
                    "Set the counts an analog output has per volt.", "counts/V", "3276.8"),
        ObjectValue("DAC # OFFSET", fp32(dac_rows.dac_offset), dacs,
                    "Set what is added to an analog output.", "V"),
        ObjectValue("ADC # GAIN", fp32(adc_rows.adc_gain), adcs,
                    "Set the voltage of an analog input at full scale.", "V", "10"),
        ObjectValue("ADC # OFFSET", fp32(adc_rows.adc_offset), adcs,
                    "Set what is added to an analog input.", "V"),
    ),
    group=GROUP,
    ref=REF,
)  # fmt: skip


@command("AXIS # ON", levels=ANY, default="ON", saved=True)
def axis_on(run: Run, number: int) -> None:
    """Compute an axis: feedback, motion, servo."""
    check_number(number, axes(run.card))
    settings.set_axis_on(run.card, number, True)


@command("AXIS # OFF", levels=ANY, default="ON", saved=True)
def axis_off(run: Run, number: int) -> None:
    """Leave an axis alone: no feedback, no motion, output 0 V."""
    check_number(number, axes(run.card))
    settings.set_axis_on(run.card, number, False)


@command("AXIS #", levels=ANY)
def axis_report(run: Run, number: int) -> None:
    """Report whether an axis is on."""
    check_number(number, axes(run.card))
    run.print("ON" if settings.is_axis_on(run.card, number) else "OFF")


@command("MASTER #", levels=ANY)
def master_report(run: Run, number: int) -> None:
    """Report which program a master is attached to."""
    check_number(number, run.card.model.masters)
    program = run.card.attachments.program(number)
    run.print(f"MASTER{number}" if program is None else f"MASTER{number} PROG{program}")


@command("ENC #", levels=ANY, units="pulses")
def encoder_report(run: Run, number: int) -> None:
    """Report the position of an encoder."""
    check_number(number, encoder_count(run.card))
    run.print(str(encoders.position(run.card, number)))


@command("ENC # RES", levels=ANY, grammar=(Num("position", optional=True),), units="pulses")
def encoder_res(run: Run, number: int, position: float | None) -> None:
    """Set the position of an encoder (0) and clear its fault flags."""
    check_number(number, encoder_count(run.card))
    encoders.reset(run.card, number, position or 0.0)


@command("STEPPER #", levels=ANY, units="pulses")
def stepper_report(run: Run, number: int) -> None:
    """Report the count of a stepper output."""
    _report(run, STEPPER_COUNT, number, axes(run.card))


@command("STEPPER # RES", levels=ANY, grammar=(Num("count", optional=True),), units="pulses")
def stepper_res(run: Run, number: int, count: float | None) -> None:
    """Set the count of a stepper output (0)."""
    check_number(number, axes(run.card))
    STEPPER_COUNT.write(run.card, number, count or 0.0)


@command("DAC #", levels=ANY, units="V")
def dac_report(run: Run, number: int) -> None:
    """Report the voltage of an analog output."""
    _report(run, fp32(dac_rows.dac_output), number, dacs(run.card))


@command("ADC #", levels=ANY, units="V")
def adc_report(run: Run, number: int) -> None:
    """Report the voltage of an analog input."""
    _report(run, fp32(adc_rows.adc_input), number, adcs(run.card))


def _report(run: Run, setting: Setting, number: int, count: int) -> None:
    check_number(number, count)
    run.print(value_text(setting, setting.read(run.card, number)))
