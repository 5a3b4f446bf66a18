"""Devices of the library, each against what its description says, step by step."""

import math
from collections.abc import Mapping
from typing import Any

import pytest

from openacr.plant.devices.conveyor import Conveyor
from openacr.plant.devices.device import Device, ramp
from openacr.plant.devices.gripper import Gripper
from openacr.plant.devices.kinds import LIBRARY
from openacr.plant.devices.light_curtain import LightCurtain
from openacr.plant.devices.spindle import Spindle
from openacr.plant.devices.tool_changer import ToolChanger
from openacr.plant.devices.vacuum import VacuumCup

DT_S = 0.001


class Bench:
    """A device whose commands keep their values from step to step."""

    def __init__(self, device: Device) -> None:
        self.device = device
        self.commands: dict[str, Any] = {name: kind() for name, kind in device.COMMANDS.items()}
        self.signals: Mapping[str, Any] = {}

    def run(self, steps: int = 1, **commands: Any) -> Mapping[str, Any]:
        self.commands.update(commands)
        for _ in range(steps):
            self.signals = self.device.step(DT_S, self.commands)
        return self.signals

    def steps_until(self, signal: str, is_: bool = True, **commands: Any) -> int:
        """The number of the step that ends with a signal in a state."""
        self.commands.update(commands)
        for step in range(1, 100_000):
            if self.run()[signal] is is_:
                return step
        raise AssertionError(f"{signal} never came")


@pytest.mark.parametrize("name", LIBRARY)
def test_every_device_gives_all_its_signals_in_its_first_step(name: str) -> None:
    bench = Bench(LIBRARY[name]())
    signals = bench.run()
    assert {key: type(value) for key, value in signals.items()} == LIBRARY[name].SIGNALS


def test_a_device_without_a_step_says_so() -> None:
    with pytest.raises(NotImplementedError, match="Device has no step"):
        Device().step(DT_S, {})


@pytest.mark.parametrize(
    ("value", "goal", "change", "next_value"),
    [(0.0, 1.0, 0.25, 0.25), (0.75, 1.0, 0.25, 1.0), (0.7, 1.0, 0.25, 0.95),
     (1.0, 0.0, 0.25, 0.75), (0.2, 0.0, 0.25, 0.0), (0.5, 0.5, 0.25, 0.5),
     (0.0, 0.3 - 1e-12, 0.1 * 3, 0.3 - 1e-12), (0.0, 1.0 + 1e-8, 1.0, 1.0)],
)  # fmt: skip
def test_a_ramp_ends_on_its_goal(
    value: float, goal: float, change: float, next_value: float
) -> None:
    assert ramp(value, goal, change) == next_value


# --- gripper --------------------------------------------------------------------------


def test_a_gripper_closes_and_opens_in_its_times() -> None:
    bench = Bench(Gripper(close_s=0.3, open_s=0.2))
    assert bench.run() == {"opened": True, "closed": False, "gripped": False}
    assert bench.run(1, close=True) == {"opened": False, "closed": False, "gripped": False}
    assert bench.steps_until("closed") == 299
    assert bench.run(1, close=False) == {"opened": False, "closed": False, "gripped": False}
    assert bench.steps_until("opened") == 199


def test_a_part_stops_the_jaws_and_is_gripped() -> None:
    bench = Bench(Gripper(close_s=0.4, open_s=0.2, part_at=0.25))
    assert bench.steps_until("gripped", close=True, part=True) == 100
    assert bench.run(1000) == {"opened": False, "closed": False, "gripped": True}
    assert bench.steps_until("gripped", is_=False, part=False) == 1  # it is pulled out
    assert bench.steps_until("closed") == 299


def test_a_part_that_comes_beside_closed_jaws_is_not_gripped() -> None:
    bench = Bench(Gripper(close_s=0.1))
    bench.run(100, close=True)
    assert bench.run(10, part=True) == {"opened": False, "closed": True, "gripped": False}
    assert not bench.run(1, close=False)["gripped"]


# --- conveyor -------------------------------------------------------------------------


def test_a_part_passes_the_sensor_and_falls_over_the_end() -> None:
    belt = Conveyor(length_mm=200.0, part_mm=20.0, sensor_mm=100.0, speed_mm_s=125.0)
    bench = Bench(belt)
    assert bench.run(1, place=True) == {"entry": True, "part": False}
    bench.commands["run"] = True  # an eighth of a millimetre in a step; its front is at 20
    assert bench.steps_until("entry", is_=False) == 160  # its rear at 20
    assert bench.steps_until("part") == 641 - 160  # its front beyond 100
    assert bench.steps_until("part", is_=False) == 160  # its rear beyond 100
    bench.run(1600 - 801 - 2)
    assert len(belt._fronts_mm) == 1
    bench.run(2)
    assert belt._fronts_mm == []  # its rear at 200


def test_parts_need_a_free_place_and_a_new_edge() -> None:
    belt = Conveyor(part_mm=10.0, speed_mm_s=125.0)
    bench = Bench(belt)
    bench.run(5, place=True)
    assert belt._fronts_mm == [10.0]
    bench.run(1, place=False)
    bench.run(1, place=True)  # on the other part
    assert belt._fronts_mm == [10.0]
    bench.run(80, run=True, place=False)
    bench.run(1, run=False, place=True)
    assert belt._fronts_mm == [20.0, 10.0]


def test_a_part_at_the_sensor_is_taken_away_and_only_that_one() -> None:
    belt = Conveyor(part_mm=10.0, sensor_mm=15.0, speed_mm_s=125.0)
    bench = Bench(belt)
    bench.run(1, place=True)
    bench.run(88, run=True, place=False)
    bench.run(1, run=False, place=True)
    assert belt._fronts_mm == [21.0, 10.0]
    assert bench.run(2, take=True) == {"entry": True, "part": False}
    assert belt._fronts_mm == [10.0]
    bench.run(48, run=True)  # `take` is still given: no new edge
    assert bench.signals == {"entry": True, "part": True}
    assert belt._fronts_mm == [16.0]


def test_volts_add_to_the_speed_and_a_jam_holds_the_parts() -> None:
    belt = Conveyor(part_mm=10.0, speed_mm_s=125.0, mm_s_per_volt=250.0)
    bench = Bench(belt)
    bench.run(1, place=True)
    bench.run(8, run=True, speed=0.5)
    assert belt._fronts_mm == [12.0]
    bench.run(8, jam=True)
    assert belt._fronts_mm == [12.0]
    bench.run(8, jam=False, run=False, speed=-0.5)
    assert belt._fronts_mm == [11.0]


# --- light curtain --------------------------------------------------------------------


def test_a_light_curtain_switches_off_after_its_response_time() -> None:
    bench = Bench(LightCurtain(response_s=0.02))
    assert bench.run()["clear"]
    assert bench.steps_until("clear", is_=False, interrupted=True) == 20
    assert bench.run(1, interrupted=False)["clear"]
    assert bench.run(19, interrupted=True)["clear"]
    bench.run(1, interrupted=False)
    assert bench.run(19, interrupted=True)["clear"]  # each interruption counts from 0


def test_an_interlock_wants_a_new_edge_of_reset_in_a_clear_field() -> None:
    bench = Bench(LightCurtain(interlock=True))
    assert not bench.run(5)["clear"]  # after power-up
    assert not bench.run(1, reset=True, interrupted=True)["clear"]
    assert not bench.run(5, interrupted=False)["clear"]  # a key that is held
    bench.run(1, reset=False)
    assert bench.run(1, reset=True)["clear"]
    assert bench.run(5, reset=False)["clear"]
    bench.run(20, interrupted=True)
    assert not bench.run(5, interrupted=False)["clear"]


def test_a_reset_that_was_on_at_power_up_is_no_edge() -> None:
    bench = Bench(LightCurtain(interlock=True))
    assert not bench.run(5, reset=True)["clear"]


# --- tool changer ---------------------------------------------------------------------


def code(signals: Mapping[str, Any]) -> int:
    return sum(bit for bit in (1, 2, 4, 8) if signals[f"code{bit}"])


def test_a_carousel_reports_its_pockets_in_both_directions() -> None:
    bench = Bench(ToolChanger(pockets=5, pocket_s=0.25))
    assert code(bench.run()) == 1
    found = [code(bench.run(250, forward=True)) for _ in range(6)]
    assert found == [2, 3, 4, 5, 1, 2]
    found = [code(bench.run(250, forward=False, backward=True)) for _ in range(3)]
    assert found == [1, 5, 4]
    bench.run(250, forward=True)
    assert code(bench.signals) == 4  # both directions: it rests


def test_between_pockets_nothing_is_in_place() -> None:
    bench = Bench(ToolChanger(pockets=8, pocket_s=0.512))
    assert bench.steps_until("in_place", is_=False, forward=True) == 26  # a twentieth of a pocket
    assert code(bench.signals) == 0
    assert bench.steps_until("in_place") == 487 - 26
    assert code(bench.signals) == 2


def test_the_clamp_opens_and_closes_in_its_time() -> None:
    bench = Bench(ToolChanger(clamp_s=0.2))
    assert (bench.run()["clamped"], bench.signals["unclamped"]) == (True, False)
    bench.run(1, unclamp=True)
    assert (bench.signals["clamped"], bench.signals["unclamped"]) == (False, False)
    assert bench.steps_until("unclamped") == 199
    assert bench.steps_until("clamped", unclamp=False) == 200


# --- spindle --------------------------------------------------------------------------


def test_a_spindle_runs_up_and_brakes_along_its_ramp() -> None:
    bench = Bench(Spindle(rpm_per_volt=1000.0, rpm_per_s=8000.0, at_speed_share=0.02))
    assert bench.run(1, speed=4.0) == {"at_speed": False, "stopped": True, "speed": 0.0}
    assert bench.run(1, forward=True) == {"at_speed": False, "stopped": False, "speed": 0.008}
    assert bench.steps_until("at_speed") == 489  # 3920 of 4000 rpm
    assert bench.run(10)["speed"] == 4.0
    assert bench.steps_until("stopped", forward=False) == 500


def test_reverse_is_negative_and_both_directions_brake() -> None:
    bench = Bench(Spindle(rpm_per_volt=1000.0, rpm_per_s=8000.0))
    assert bench.run(500, reverse=True, speed=2.0) == {
        "at_speed": True, "stopped": False, "speed": -2.0,
    }  # fmt: skip
    assert bench.run(250, forward=True) == {"at_speed": False, "stopped": True, "speed": 0.0}


def test_negative_volts_are_no_speed() -> None:
    assert Bench(Spindle()).run(9, forward=True, speed=-1.0) == {
        "at_speed": False, "stopped": True, "speed": 0.0,
    }  # fmt: skip


# --- vacuum cup -----------------------------------------------------------------------


def test_the_vacuum_follows_its_lags() -> None:
    cup = VacuumCup(closed_bar=0.8, evacuate_s=0.1, vent_s=0.05, volts_per_bar=10.0)
    bench = Bench(cup)
    bench.run(100, on=True, part=True)
    assert bench.signals["vacuum"] == pytest.approx(8.0 * (1.0 - math.exp(-1.0)), rel=1e-12)
    bench.run(25, on=False)
    expected = 8.0 * (1.0 - math.exp(-1.0)) * math.exp(-0.5)
    assert bench.signals["vacuum"] == pytest.approx(expected, rel=1e-12)


def test_a_part_is_held_from_one_level_and_lost_at_another() -> None:
    bench = Bench(VacuumCup())
    on = bench.steps_until("held", on=True, part=True)
    assert on == math.ceil(-0.1 * math.log(1.0 - 0.6 / 0.8) / DT_S)
    assert bench.signals["vacuum"] >= 6.0
    bench.run(2000)
    off = bench.steps_until("held", is_=False, on=False)
    assert off == math.ceil(-0.05 * math.log(0.5 / 0.8) / DT_S)


def test_without_a_part_nothing_is_held() -> None:
    bench = Bench(VacuumCup(open_bar=0.1))
    assert not bench.run(5000, on=True)["held"]
    assert bench.signals["vacuum"] == pytest.approx(1.0, rel=1e-9)
