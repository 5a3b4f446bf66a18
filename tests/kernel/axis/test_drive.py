"""Drive enable, faults, the motion enable input, and the excess error response."""

from collections.abc import Callable

import pytest
from tests.kernel.rig import Rig

from openacr.map.rows import axes, motors
from openacr.map.words import af4
from openacr.motion.axis import attach, drive
from openacr.motion.axis.attach import Feedback, Signal

FAULT_INPUT, INVERT = 8448, 8453
ENABLED, RESET_REQUEST, KAMR, IO, EXC_RESPONSE = 8465, 8466, 8467, 8468, 8469
ON_KILL, FAULT, EXCESS = 8471, 8477, 8479


def driven() -> Rig:
    rig = Rig(ppu=[1000.0])
    rig.bit(IO, True)
    rig.ticks(2)
    return rig


def enabled() -> Rig:
    rig = driven()
    drive.on(rig.card, 0)
    return rig.ticks(20)


def test_the_flag_follows_the_command_after_ten_milliseconds() -> None:
    rig = driven()
    drive.on(rig.card, 0)
    rig.ticks(19)
    assert not rig.bit(ENABLED)
    rig.ticks()
    assert rig.bit(ENABLED)
    drive.off(rig.card, 0)
    assert not rig.bit(ENABLED)


def test_a_fault_flag_set_by_hand_stays_without_a_fault_line() -> None:
    world = """
[[axis]]
number = 0
counts_per_rev = 4000
drive = { mode = "ideal", revs_per_s_per_volt = 25.0, lag_s = 0.001 }
"""
    rig = Rig(world=world)
    rig.bit(FAULT_INPUT, True)
    assert rig.ticks(3).bit(FAULT_INPUT)
    wired = world.replace("lag_s = 0.001", "lag_s = 0.001, fault_input = 20")
    rig = Rig(world=wired)
    rig.bit(FAULT_INPUT, True)
    assert not rig.ticks(3).bit(FAULT_INPUT)
    rig.bit(20, True)
    assert rig.ticks(3).bit(FAULT_INPUT)


def test_an_active_fault_silently_bars_enabling_and_its_level_can_be_inverted() -> None:
    rig = driven()
    rig.bit(INVERT, True)  # an absent signal is a fault now
    drive.on(rig.card, 0)
    rig.ticks(30)
    assert not rig.bit(ENABLED)
    rig.bit(FAULT_INPUT, True)
    drive.on(rig.card, 0)
    rig.ticks(30)
    assert rig.bit(ENABLED)


def test_a_written_flag_starts_enabling() -> None:
    rig = driven()
    rig.bit(ENABLED, True)
    rig.ticks(2)
    assert rig.bit(ENABLED)
    rig.bit(ENABLED, False)
    rig.ticks(30)
    assert not rig.bit(ENABLED)


def test_reset_clears_the_fault_after_its_pulse() -> None:
    rig = enabled()
    rig.bit(FAULT_INPUT, True)
    rig.ticks().bit(FAULT_INPUT, False)
    rig.bit(RESET_REQUEST, True)
    rig.ticks(99)
    assert rig.bit(RESET_REQUEST)
    rig.ticks(2)
    assert (rig.bit(RESET_REQUEST), rig.bit(FAULT)) == (False, False)


def test_an_open_motion_enable_input_latches_and_kills_everything() -> None:
    rig = enabled()
    rig.bit(5646, True)
    rig.ticks()
    assert (rig.bit(5645), rig.bit(KAMR), rig.bit(ENABLED)) == (True, True, False)
    rig.bit(5646, False)
    rig.ticks(3)
    drive.on(rig.card, 0)
    rig.ticks(30)
    assert (rig.bit(5645), rig.bit(ENABLED)) == (True, False)
    rig.bit(5647, True)
    rig.ticks()
    assert (rig.bit(5645), rig.bit(5647)) == (False, False)
    drive.on(rig.card, 0)
    assert rig.ticks(21).bit(ENABLED)


def test_a_kill_disables_the_drive_where_asked() -> None:
    for asked in (True, False):
        rig = enabled()
        rig.bit(ON_KILL, asked)
        rig.bit(KAMR, True)
        assert rig.ticks().bit(ENABLED) != asked


@pytest.mark.parametrize(
    ("position", "velocity"),
    [
        ((Feedback.ENC, 1), (Feedback.ENC, 1)),
        ((Feedback.ENC, 9), (Feedback.ENC, 1)),  # an encoder on the load, one on the motor
        ((Feedback.ADC, 2), (Feedback.ADC, 2)),  # a sensor: the motor is the one on the output
    ],
)
def test_the_drive_of_an_axis_is_that_of_the_motor_it_drives(
    position: tuple[Feedback, int], velocity: tuple[Feedback, int]
) -> None:
    ideal = 'drive = { mode = "ideal", revs_per_s_per_volt = 5.0 }\n'
    world = f"[[axis]]\nnumber = 1\ndac = 5\ncounts_per_rev = 4000\n{ideal}"
    rig = Rig(1, world=world)
    assert rig.ticks(2).I[motors.drive_enabled[1]] == 0
    attach.axis(rig.card, 0, position, (Signal.DAC, 5), velocity)
    assert rig.ticks(1).I[motors.drive_enabled[1]] == 1
    rig.I[motors.drive_fault[1]] = 1
    rig.ticks(1)
    assert rig.I[af4.word[0]] & af4.DRIVE_FAULT_INPUT


TORQUE = """
[[axis]]
number = 0
counts_per_rev = 4000
drive = { mode = "ideal", revs_per_s_per_volt = 1e-6, lag_s = 0.001 }
"""
OUTPUT, ERROR = axes.output_signal[0], axes.following_error[0]
LINE = motors.drive_enabled[0]


def pushed() -> Rig:
    """An axis under power, 200 pulses from its setpoint; its drive I/O is not used."""
    rig = Rig(ppu=[1.0], world=TORQUE).axis(0, proportional_gain=0.01).ticks(2)
    rig.F[axes.position_cnt[0]] = 200.0
    rig.ticks(5)
    assert rig.S[OUTPUT] == pytest.approx(2.0)
    assert rig.I[LINE] == 1
    return rig


def killed(rig: Rig) -> None:
    rig.bit(ON_KILL, True)
    rig.bit(KAMR, True)


def cleared(rig: Rig) -> None:
    drive.on(rig.card, 0)
    rig.F[axes.position_cnt[0]] += 200.0
    rig.ticks(5)
    assert rig.S[OUTPUT] == pytest.approx(2.0)
    rig.bit(ENABLED, False)


CUTS: dict[str, Callable[[Rig], None]] = {
    "DRIVE OFF": lambda rig: drive.off(rig.card, 0),
    "Ctrl-Z": lambda rig: drive.disable_all(rig.card),
    "kill": killed,
    "cleared flag": cleared,
    "motion enable": lambda rig: rig.memory.set_bit(5646, True),
    "encoder": lambda rig: rig.memory.set_bit(2560, True),
}


@pytest.mark.parametrize("cut", CUTS.values(), ids=CUTS)
def test_a_disabled_axis_puts_out_nothing_until_it_is_enabled(cut: Callable[[Rig], None]) -> None:
    rig = pushed()
    cut(rig)
    rig.ticks(5)
    assert (rig.S[OUTPUT], rig.I[LINE], rig.bit(ENABLED)) == (0.0, 0, False)
    for flag in (KAMR, 5646, 2560):
        rig.bit(flag, False)
    rig.bit(5647, True)  # resets the latch of the motion enable input
    rig.ticks(50)
    assert (rig.S[OUTPUT], rig.I[LINE], rig.bit(ENABLED)) == (0.0, 0, False)
    drive.on(rig.card, 0)
    rig.ticks(5)
    assert (rig.I[LINE], rig.bit(ENABLED), rig.I[ERROR]) == (1, True, 0)
    rig.F[axes.position_cnt[0]] += 100.0
    rig.ticks(5)
    assert rig.S[OUTPUT] == pytest.approx(1.0)


@pytest.mark.parametrize("response", [EXC_RESPONSE, 8470])
def test_excess_error_cuts_the_output_where_it_disables(response: int) -> None:
    rig = pushed()
    rig.bit(response, True)
    rig.axis(0, plus_excess_error=100.0, minus_excess_error=-100.0).seconds(0.3)
    assert (rig.S[OUTPUT], rig.I[LINE], rig.bit(EXCESS)) == (0.0, 0, True)
    assert rig.bit(KAMR) is (response == EXC_RESPONSE)


def test_drive_io_adds_that_an_axis_is_silent_before_its_first_enabling() -> None:
    rig = pushed()
    rig.bit(IO, True)
    rig.ticks(2)
    assert (rig.S[OUTPUT], rig.I[LINE]) == (0.0, 0)
    rig.bit(IO, False)
    rig.ticks(2)
    assert rig.S[OUTPUT] == pytest.approx(2.0)
    assert rig.I[LINE] == 1


def test_the_second_axis_stays_driven_when_the_first_is_disabled() -> None:
    rig = Rig(axes=2, ppu=[1.0, 1.0], world=TORQUE + TORQUE.replace("number = 0", "number = 1"))
    rig.ticks(2)
    drive.off(rig.card, 0)
    rig.ticks(2)
    assert (rig.I[LINE], rig.I[LINE + motors.INTS_SIZE]) == (0, 1)
