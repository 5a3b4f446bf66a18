"""Interpreted and compiled steps give the same bits; nothing a user configures makes a NaN."""

import math
from collections.abc import Callable

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from openacr import compiled
from openacr.map.memory import Memory
from openacr.map.rows import axes, encoders, motors, stepper_outputs
from openacr.map.rows import dacs as dac_rows
from openacr.plant.build.apply import apply_world
from openacr.plant.describe.schema import (
    LOADLESS,
    Analog,
    Axis,
    ExactDrive,
    HomeSwitch,
    IdealDrive,
    LimitSwitch,
    Load,
    Motor,
    PhaseDrive,
    StepperDrive,
    TorqueDrive,
    VelocityDrive,
    Wire,
    World,
)
from openacr.plant.physics.step_cy import plant_step

positive = st.floats(1e-6, 1e6)
friction = st.one_of(st.just(0.0), st.floats(1e-9, 1e6))
resonances = st.one_of(st.none(), st.floats(1e-3, 1e4))
volts = st.one_of(
    st.sampled_from([0.0, 10.0, -10.0, math.nan, math.inf]), st.floats(-11, 11, width=32)
)
drives = st.one_of(
    st.builds(
        TorqueDrive,
        amps_per_volt=positive,
        peak_amps=positive,
        supply_v=st.one_of(st.none(), positive),
        offset_v=st.floats(-1, 1),
    ),
    st.builds(
        VelocityDrive, revs_per_s_per_volt=positive, peak_amps=positive, lag_s=st.floats(0, 10)
    ),
    st.builds(
        PhaseDrive,
        amps_per_volt=positive,
        peak_amps=positive,
        supply_v=st.one_of(st.none(), positive),
        offset_v=st.floats(-1, 1),
        dacs=st.permutations(range(8)).map(lambda dacs: (dacs[0], dacs[1])),
    ),
    st.builds(IdealDrive, revs_per_s_per_volt=positive, lag_s=st.floats(0, 10)),
    st.builds(
        StepperDrive,
        output=st.integers(0, 15),
        steps_per_rev=st.integers(4, 100_000),
        torque_nm=st.sampled_from([((0.0, 1.0),), ((0.0, 1.0), (3.0, 0.5), (9.0, 0.0))]),
        full_steps_per_rev=st.sampled_from([4, 48, 200, 500]),
        damping=st.floats(0, 2),
    ),
    st.just(ExactDrive()),
)


@st.composite
def worlds(draw: st.DrawFn) -> World:
    drive = draw(drives)
    coulomb = draw(friction)
    motor = Motor(
        inertia_kgm2=draw(positive),
        torque_nm_per_a=draw(positive),
        resistance_ohm=draw(positive),
        pole_pairs=draw(st.integers(1, 1000)),
        phases=draw(st.sampled_from([2, 3])),
        electrical_zero_deg=draw(st.floats(-360, 360)),
    )
    axis = Axis(
        number=draw(st.integers(0, 7)),
        name="X",
        drive=drive,
        motor=None if isinstance(drive, LOADLESS) else motor,
        load=Load(
            inertia_kgm2=draw(positive),
            viscous_nms=draw(friction),
            coulomb_nm=coulomb,
            static_nm=coulomb * 1.25,
            resonance_hz=draw(resonances) if isinstance(drive, TorqueDrive) else None,
            damping_ratio=draw(st.floats(0.0, 0.9)),
        ),
        counts_per_rev=draw(st.integers(4, 100_000)),
        travel=draw(st.sampled_from([None, (-3.0, 5.0)])),
        marker=0.5,
        positive_limit=LimitSwitch(at=4.0, input=0),
        negative_limit=LimitSwitch(at=-2.0, input=31),
        home=HomeSwitch(between=(0.1, 0.2), input=2),
    )
    wires = (
        Wire(input=10, region={"X": (1.0, 2.0)}),
        Wire(input=260, output=32, delay_s=0.002),
    )
    analogs = (
        Analog(input=3, axis=axis.number, volts_per_unit=draw(st.floats(1e-3, 10)), volts=0.1),
        Analog(input=7, dac=draw(st.integers(0, 15)), volts=draw(st.floats(-10, 10))),
    )
    return World(axis=(axis,), wire=wires, analog=analogs)


def play(step: Callable[..., None], world: World, journal: list[float]) -> Memory:
    memory = Memory()
    apply_world(world, memory)
    n = world.axis[0].number
    for tick, value in enumerate(journal):
        memory.I[motors.drive_enabled[n]] = int(tick % 9 < 7)
        memory.set_bit(32, tick % 7 < 5)
        commanded = min(max(value, -100.0), 100.0) if math.isfinite(value) else 0.0
        for output in range(16):
            row = stepper_outputs.pulses[output]
            memory.F[row] += round(commanded * (output + 1))
        memory.I[axes.on[n]] = 1
        memory.I[axes.position_index[n]] = n
        memory.I[encoders.mult[n]] = 3
        memory.F[axes.ssp_cnt[n]] = commanded * 7
        for dac in range(8):
            memory.S[dac_rows.dac_output[dac]] = value * (n - dac + 1)
        step(memory.F, memory.I, memory.S, 8, 0.0005)
    return memory


@pytest.mark.skipif(not compiled.is_compiled, reason="needs the compiled core")
@settings(max_examples=60, deadline=None)
@given(worlds(), st.lists(volts, min_size=1, max_size=40))
def test_interpreted_and_compiled_steps_give_the_same_bits(
    world: World, journal: list[float]
) -> None:
    plain = play(plant_step, world, journal)
    fast = play(compiled.counterpart(plant_step), world, journal)
    assert plain.snapshot() == fast.snapshot()


@settings(max_examples=80, deadline=None)
@given(worlds(), st.lists(volts, min_size=1, max_size=40))
def test_no_configuration_and_no_output_makes_a_value_that_is_no_number(
    world: World, journal: list[float]
) -> None:
    memory = play(compiled.pick(plant_step), world, journal)
    base = motors.reals[world.axis[0].number]
    assert all(math.isfinite(value) for value in memory.F[base : base + motors.REALS_SIZE])


@settings(max_examples=80, deadline=None)
@given(worlds(), st.floats(-1e6, 1e6), st.integers(1, 40))
def test_a_motor_without_torque_never_gains_speed(world: World, speed: float, ticks: int) -> None:
    memory = Memory()
    apply_world(world, memory)
    at_speed = motors.velocity_cps[world.axis[0].number]
    memory.F[at_speed] = speed
    for _ in range(ticks):
        old = memory.F[at_speed]
        compiled.pick(plant_step)(memory.F, memory.I, memory.S, 8, 0.0005)
        assert abs(memory.F[at_speed]) <= abs(old)
        assert memory.F[at_speed] * old >= 0
