"""The axis computed: the servo interrupt of the card itself, with a motor of the world beside it.

Nothing of the loop is modelled anew: `kernel.tick_cy` is what a virtual card executes, the motor is
one of `plant.step_cy`. So limits, filters, converter steps and whole counts are as they are there.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from openacr.compiled import pick
from openacr.kernel.tick_cy import tick
from openacr.map.memory import Memory
from openacr.map.rows import axes, compliant_loads, dacs, encoders, kernel, motors
from openacr.map.words import af1
from openacr.motion.axis import attach
from openacr.motion.axis.settings import activate_derivative_smoothing
from openacr.motion.card import Card
from openacr.plant.build.apply import apply_world
from openacr.plant.describe.load import parse_world
from openacr.plant.physics.step_cy import plant_step
from openacr.tuning.filters import Row
from openacr.tuning.motor import Motor, Reals
from openacr.tuning.settings import LoopSettings
from openacr.tuning.shaft import Shaft

_tick, _plant = pick(tick), pick(plant_step)
_DAC = dacs.dac_output[0]
_NO_LIMIT = 1e30
COUNTS_PER_LINE = 4
MIDDLE = 0.5  # of a count: where a motor begins
_WORLD = """
[[axis]]
number = 0
counts_per_rev = 4000
[axis.drive]
mode = "torque"
amps_per_volt = 1.0
peak_amps = 100.0
[axis.motor]
inertia_kgm2 = 1e-5
torque_nm_per_a = 0.1
"""


@dataclass(frozen=True, slots=True)
class Record:
    """An axis at each servo interrupt: setpoint, actual position [counts] and output [V].

    The position of the load on an elastic shaft is known of computed axes only.
    """

    period_s: float
    setpoint_cnt: Reals
    actual_cnt: Reals
    output_v: Reals
    load_cnt: Reals | None = None

    @property
    def error_cnt(self) -> Reals:
        """Following error [counts]."""
        return self.setpoint_cnt - self.actual_cnt

    @property
    def times_s(self) -> Reals:
        """Times of the samples [s]."""
        return np.arange(len(self.setpoint_cnt), dtype=np.float64) * self.period_s


def run(
    settings: LoopSettings, motor: Motor, setpoint_cnt: Reals, first: Record | None = None
) -> Record:
    """Move an axis that was at rest along a setpoint, one value per period.

    It begins in position 0; or where `first` does, with the integral that its first output shows.
    The setpoint is the jog offset, whole counts, as a program writes it.
    """
    origin = 0 if first is None else round(float(first.actual_cnt[0]))
    wanted = np.rint(setpoint_cnt)
    jogs = (wanted - origin).astype(int).tolist()
    memory = _memory(settings, motor)
    F, I, S = memory.F, memory.I, memory.S
    for row in (axes.psp_cnt, axes.ssp_cnt, axes.error_old_cnt):
        F[row[0]] = jogs[0]
    if first is not None and settings.gain("IGAIN"):
        F[axes.integral_v[0]] = float(first.output_v[0]) - settings.gain("PGAIN") * jogs[0]
    whole = int(motor.delay_tk)
    part = motor.delay_tk - whole
    sent = [0.0 if first is None else float(first.output_v[0])] * (whole + 2)
    S[_DAC] = sent[0]
    # A fit comes here ten million times: places are looked up once.
    plant, tick, period_s, dac = _plant, _tick, settings.period_s, _DAC
    offset, position, signal = axes.jog_offset[0], axes.actual_position[0], axes.output_signal[0]
    actual: list[float] = []
    output: list[float] = []
    turned: list[tuple[float, float]] = []
    for jog in jogs:
        if motor.delay_tk:
            S[dac] = (1.0 - part) * sent[-1 - whole] + part * sent[-2 - whole]
        plant(F, I, S, 1, period_s)
        I[offset] = jog
        tick(F, I, S)
        if motor.delay_tk:
            sent = [*sent[1:], S[dac]]
        actual.append(I[position])
        output.append(S[signal])
        if motor.shaft is not None:
            turned.append((F[motors.position_cnt[0]], F[compliant_loads.flex_cnt[0]]))
    load = None
    if motor.shaft is not None:
        places, flexes = np.array(turned).T
        load = places - (1.0 + 1.0 / motor.shaft.inertia_ratio) * flexes - MIDDLE + origin
    return Record(
        settings.period_s, wanted, np.array(actual, float) + origin, np.array(output), load
    )


def _memory(settings: LoopSettings, motor: Motor) -> Memory:
    """A card with axis 0 alone, its loop closed and its motor at rest."""
    memory = Memory()
    memory.restore(
        _closed_loop(settings.period_s, tuple(settings.rows.items()), settings.is_filtering)
    )
    for place, value in (
        (motors.accel_per_volt, motor.accel_per_volt),
        (motors.peak_accel, _NO_LIMIT),
        (motors.viscous_per_s, motor.rate_per_s),
        (motors.coulomb_accel, motor.coulomb_accel),
        (motors.static_accel, motor.coulomb_accel),
        (motors.offset_v, motor.offset_v),
    ):
        memory.F[place[0]] = value
    if motor.shaft is not None:
        _bend(memory, motor.shaft)
    return memory


@lru_cache(maxsize=4)
def _closed_loop(period_s: float, rows: tuple[tuple[Row, float], ...], is_filtering: bool) -> bytes:
    """The memory of a card whose loop has these settings; a fit tries many motors with one."""
    card = Card()
    memory = card.memory
    apply_world(parse_world(_WORLD), memory)
    card.set_period(period_s)
    attach.master(card, 0, 0)
    attach.slave(card, 0, 0, 0, "X")
    for row, value in rows:
        memory.write(row[0], value)
    activate_derivative_smoothing(card, 0)
    if is_filtering:
        memory.I[af1.word[0]] |= af1.BIQUAD_FILTER_ACTIVATE
    memory.I[encoders.mult[0]] = COUNTS_PER_LINE  # the motor is given in counts of the position
    memory.I[kernel.axes] = 1
    memory.I[kernel.masters] = 1
    return memory.snapshot()


def _bend(memory: Memory, shaft: Shaft) -> None:
    """Put the load of axis 0 on an elastic shaft."""
    for place, value in (
        (compliant_loads.resonance_rad_s, shaft.resonance_rad_s),
        (compliant_loads.damping_per_s, shaft.damping_per_s),
        (compliant_loads.inertia_ratio, shaft.inertia_ratio),
    ):
        memory.F[place[0]] = value
