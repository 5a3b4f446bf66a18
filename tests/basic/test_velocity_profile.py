"""The profile commands of a master, and the moves they shape: times to the tick."""

import pytest
from tests.basic.motion_bench import Bench, ticks

from openacr.basic.language.registry import Level
from openacr.map.rows import masters

IN_MOTION = 516
LENGTH = masters.vector_length[0]


def bench(*lines: str, axes: tuple[str, ...] = ("X", "Y")) -> Bench:
    """A card with axes of 1000 pulses per unit, after some lines."""
    made = Bench(*axes)
    made.type("PPU " + " ".join(f"{name}1000" for name in axes))
    for line in lines:
        assert made.type(line) == ""
    return made


# values


@pytest.mark.parametrize(
    "word", ["ACC", "DEC", "STP", "VEL", "F", "JRK", "FVEL", "IVEL", "FOV", "ROV", "VECTOR"]
)
def test_a_negative_profile_value_is_refused_and_changes_nothing(word: str) -> None:
    made = Bench("X")
    made.type(f"{word} 3")
    assert made.type(f"{word} -1") == "Invalid argument"
    assert made.type(f"{word} (0-1)") == "Invalid argument"
    assert made.type(word) == "3"


def test_profile_commands_need_a_master_or_a_level() -> None:
    made = Bench()
    assert made.type("ACC 5") == "No master attached"
    assert made.type("ACC") == "No master attached"
    assert made.at(Level.SYS).type("ACC 5") == "Unknown command"
    assert made.type("MASTER99 ACC 5") == "Invalid argument"


# the profiles of one move


def test_weights_scale_the_length_of_a_move() -> None:
    made = bench("VECDEF X1 Y1 A0", "X3 Y4 A90", axes=("X", "Y", "A"))
    made.ticks(1)
    assert made.p(LENGTH) == 5.0
    assert made.type("VECDEF X Y A") == "1|1|0"
    assert made.type("VECDEF X-1") == "Invalid argument"


def test_weights_need_a_master() -> None:
    assert Bench("X").type("VECDEF AXIS5 1") == "No master attached"


def test_without_weight_and_vector_the_longest_displacement_counts() -> None:
    made = bench("VECDEF X0 Y0", "X3 Y-4")
    made.ticks(1)
    assert made.p(LENGTH) == 4.0


def test_velocity_0_waits_for_the_first_velocity_above_it() -> None:
    made = bench("ACC 0 STP 0 VEL 0", "X1")
    made.ticks(100)
    assert (made.bit(IN_MOTION), made.p(12288)) == (True, 0)
    made.type("VEL 10")
    assert made.until_clear(IN_MOTION) == ticks(0.1)
    assert made.p(12288) == 1000


# what the master profile does not touch
