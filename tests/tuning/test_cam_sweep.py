"""Sweeps that the card plays from a cam table at its servo rate."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from tests.tuning.test_measure import SET_UP

import openacr
from openacr.client import Card, Level
from openacr.errors import UserError
from openacr.tuning import measure as measuring
from openacr.tuning.cam_sweep import points
from openacr.tuning.excitation import Excitation
from openacr.tuning.measure import Measurement, stop

T = 0.0005
FAST = Excitation(high_hz=400.0, duration_s=0.8)
CAM_OFFSET, SMOOTH, CAM_ON = 12544 + 10, 12544 + 113, 790 + 32
OWN_CAM = ["DIM LA1", "DIM LA0(2)", "CAM DIM Y1", "CAM SEG Y(0,100,LA0)"]


@pytest.fixture
def card(host: openacr.Controller) -> Iterator[Card]:
    with Card.open(host) as found:
        for line in SET_UP:
            found.command(line)
        host.p[SMOOTH] = 7
        found.pause(0.1)
        yield found


def measure(card: Card, excitation: Excitation, **more: Any) -> Measurement:
    return card.perform(lambda talk: measuring.measure(talk, 1, excitation, **more))


def assert_left_as_it_was(host: openacr.Controller, card: Card) -> None:
    assert (host.p[CAM_OFFSET], host.p[SMOOTH], host.bit[CAM_ON]) == (0, 7, False)
    assert card.command("AXIS1 CAM DIM") == ["0"]
    assert card.command("SAMP") == ["SAMP PERIOD 0"]


def swept(t: np.ndarray, excitation: Excitation) -> np.ndarray:
    """The sweep as its definition: its frequency by the square of the time, without the table."""
    part = t / excitation.duration_s
    # as near to the band as whole turns allow
    span = 3.0 * (round(0.8 * (400.0 - 2.0) / 3.0 + 1.6) - 1.6) / 0.8
    hz = excitation.low_hz + span * part**2
    turns = np.concatenate(([0.0], np.cumsum((hz[1:] + hz[:-1]) / 2.0 * np.diff(t))))
    return excitation.height_cnt * np.minimum(1.0, 60.0 / hz) * np.sin(2.0 * np.pi * turns)


def test_the_setpoint_is_the_sweep_at_every_servo_interrupt(
    card: Card, host: openacr.Controller
) -> None:
    found = measure(card, FAST)
    setpoint = found.record.setpoint_cnt
    begin = int(np.nonzero(setpoint)[0][0])
    count = points(FAST.duration_s, T)
    assert (count, begin < 60) == (1600, True)
    fine = swept(np.arange(count * 20 + 1) * T / 20.0, FAST)[::20]
    # the table has whole pulses, towards 0; its first point is 0 and comes at the very begin
    lead = next(k for k in range(1, 20) if abs(fine[k]) >= 1.0)
    played = setpoint[begin - lead : begin - lead + count + 1]
    assert np.abs(played - fine).max() < 1.05
    # 2 pi 60 Hz x 100 pulses is 18.8 in a period: no faster above that, and no step at the end
    assert np.abs(np.diff(played)).max() <= 20.0
    assert not setpoint[begin - lead + count :].any()
    assert_left_as_it_was(host, card)


def test_frequencies_are_measured_up_to_the_end_of_the_band(card: Card) -> None:
    from openacr.tuning.identify import spectrum

    found = spectrum(measure(card, Excitation(high_hz=400.0)).record)
    assert found.measured_to_hz((2.0, 400.0)) > 380.0


@pytest.mark.parametrize(
    ("bounds", "reason"),
    [
        ({"error_cnt": 100.0}, "the following error exceeded 100 pulses"),
        ({"travel_cnt": 100.0}, "the axis went further than 100 pulses"),
    ],
)
def test_a_bound_ends_the_sweep(
    card: Card, host: openacr.Controller, bounds: dict[str, float], reason: str
) -> None:
    card.command("AXIS1 DGAIN 0.00001")  # it overshoots
    with pytest.raises(UserError, match=f"axis 1: ended, because {reason}"):
        measure(card, Excitation(high_hz=400.0, duration_s=0.8, **bounds))  # type: ignore[arg-type]
    assert_left_as_it_was(host, card)


def test_a_stop_and_a_kill_end_the_sweep(card: Card, host: openacr.Controller) -> None:
    with Card.open(host) as other, pytest.raises(UserError, match="it was stopped"):
        measure(card, FAST, progress=lambda done, count: other.perform(stop))
    assert_left_as_it_was(host, card)

    def kill(done: int, count: int) -> None:
        host.bit[8499] = True

    with pytest.raises(UserError, match="its motion was killed"):
        measure(card, FAST, progress=kill)
    assert_left_as_it_was(host, card)


@pytest.mark.parametrize("is_halted", [False, True])
def test_a_lost_host_and_a_halted_program_leave_an_axis_that_comes_back(
    card: Card, host: openacr.Controller, is_halted: bool
) -> None:
    card.download(FAST.checked().program(1, T), to=Level.program(7))
    card.command("RUN", program=7)
    for _ in range(500):
        card.pause(0.01)
        if host.bit[CAM_ON]:
            break
    card.pause(0.2)
    assert host.p[CAM_OFFSET] != 0
    if is_halted:
        card.command("HALT", program=7)
    card.close()
    host.advance(seconds=5.0)
    assert (host.p[CAM_OFFSET], host.bit[CAM_ON]) == (0, False)  # the cam ends by itself
    assert (host.p[SMOOTH] == 7) is not is_halted


def test_a_cam_that_is_stopped_is_off_within_some_rounds_of_the_program(
    card: Card, host: openacr.Controller
) -> None:
    card.download(FAST.checked().program(1, T), to=Level.program(7))
    card.command("RUN", program=7)
    for _ in range(500):
        card.pause(0.01)
        if host.bit[CAM_ON]:
            break
    card.pause(0.1)
    host.bit[104] = False
    host.advance(seconds=0.05)
    assert (host.p[CAM_OFFSET], host.bit[CAM_ON]) == (0, False)


def test_an_axis_with_a_cam_of_its_own_keeps_it(card: Card) -> None:
    for line in OWN_CAM:
        card.command(line)
    with pytest.raises(UserError) as refused:
        measure(card, FAST)
    assert str(refused.value) == (
        "axis 1 has a cam, which a sweep above 150 Hz needs: AXIS1 CAM CLEAR, or a lower frequency"
    )
    assert card.command("AXIS1 CAM DIM") == ["1"]
    measure(card, Excitation(high_hz=150.0, duration_s=0.5))  # written by a program
    assert card.command("AXIS1 CAM DIM") == ["1"]


def test_frequencies_are_at_most_four_tenths_of_the_servo_rate(card: Card) -> None:
    Excitation(high_hz=800.0).require_rate(T)
    Excitation(high_hz=150.0).require_rate(1.0)
    with pytest.raises(UserError) as refused:
        measure(card, Excitation(high_hz=801.0))
    assert str(refused.value) == "highest frequency [Hz] 801: at most 800 with this servo rate"


def test_the_program_has_the_memory_it_says_it_needs() -> None:
    slow, fast = Excitation(high_hz=150.0), Excitation(high_hz=151.0)
    assert (slow.is_cam, fast.is_cam) == (False, True)
    assert fast.memory_bytes(T) - slow.memory_bytes(T) == 4 * 3001
    assert fast.memory_bytes(T) <= 65536  # of a program of the default memory
