"""The profile commands of a master, and the moves they shape: times to the tick."""

import pytest
from tests.basic.motion_bench import Bench, largest, ticks

from openacr.basic.language.registry import Level
from openacr.map import numbers as at

IN_MOTION = 516
ACCELERATING, DECELERATING, STOPPING = 512, 513, 514
MASTER0 = at.MA_BASE
TARGET_VELOCITY = MASTER0 + at.MA_TARGET_VELOCITY
VELOCITY = MASTER0 + at.MA_VECTOR_VELOCITY
LENGTH = MASTER0 + at.MA_VECTOR_LENGTH


def bench(*lines: str, axes: tuple[str, ...] = ("X", "Y")) -> Bench:
    """A card with axes of 1000 pulses per unit, after some lines."""
    made = Bench(*axes)
    made.type("PPU " + " ".join(f"{name}1000" for name in axes))
    for line in lines:
        assert made.type(line) == ""
    return made


def peak(made: Bench) -> float:
    """The highest path speed of the move under way."""
    found = 0.0
    while made.bit(IN_MOTION):
        made.ticks(1)
        found = max(found, made.p(VELOCITY))
    return found


# values


@pytest.mark.parametrize(
    ("word", "default"),
    [
        ("ACC", "20000"), ("DEC", "20000"), ("STP", "20000"), ("VEL", "10000"), ("F", "600000"),
        ("JRK", "0"), ("FVEL", "0"), ("IVEL", "0"), ("FOV", "1"), ("ROV", "1"), ("VECTOR", "0"),
    ],
)  # fmt: skip
@pytest.mark.req("ACR-PROF-07")
def test_a_profile_command_alone_reports_its_default(word: str, default: str) -> None:
    made = Bench("X")
    assert made.type(word) == default
    assert made.type(f"? {word}") == default
    assert made.type(f"{word} 12.5") == ""
    assert made.type(word) == "12.5"
    assert made.type(f"{word} 0") == ""
    assert made.type(word) == "0"


@pytest.mark.parametrize(
    "word", ["ACC", "DEC", "STP", "VEL", "F", "JRK", "FVEL", "IVEL", "FOV", "ROV", "VECTOR"]
)
def test_a_negative_profile_value_is_refused_and_changes_nothing(word: str) -> None:
    made = Bench("X")
    made.type(f"{word} 3")
    assert made.type(f"{word} -1") == "Invalid argument"
    assert made.type(f"{word} (0-1)") == "Invalid argument"
    assert made.type(word) == "3"


@pytest.mark.req("ACR-CMD-ACC", "ACR-CMD-VEL")
def test_acc_is_the_ramp_and_vel_the_speed_of_later_moves() -> None:
    made = bench("ACC 50 DEC 1000 STP 1000 VEL 10", "X100")
    made.seconds(0.1)
    assert made.axis(0, at.AX_VELOCITY) / 1000 == pytest.approx(5.0, rel=0.01)
    made.seconds(0.2)
    assert made.axis(0, at.AX_VELOCITY) / 1000 == pytest.approx(10.0)
    made.all("VEL 4 ACC 8").seconds(0.1)
    assert made.axis(0, at.AX_VELOCITY) / 1000 == pytest.approx(10.0)
    made.until_clear(516)
    made.all("X/10").seconds(0.25)
    assert made.axis(0, at.AX_VELOCITY) / 1000 == pytest.approx(2.0, rel=0.01)
    made.seconds(0.5)
    assert made.axis(0, at.AX_VELOCITY) / 1000 == pytest.approx(4.0)
    assert (made.type("ACC"), made.type("VEL")) == ("8", "4")


@pytest.mark.req("ACR-CMD-ACC", "ACR-CMD-VEL")
def test_several_profile_commands_fit_in_one_line() -> None:
    made = Bench("X")
    assert made.type("ACC500 DEC 400 STP500 VEL(100+5)") == ""
    assert made.type("ACC : DEC : STP : VEL") == "500|400|500|105"


@pytest.mark.req("ACR-CMD-F")
def test_f_is_the_speed_per_minute() -> None:
    made = Bench("X")
    made.type("F 60")
    assert made.type("VEL") == "1"
    made.type("F500")
    assert made.type("VEL") == "8.333333"
    assert made.type("F") == "500"
    made.type("VEL 2")
    assert made.type("F") == "120"


def test_values_with_a_parameter_are_that_parameter() -> None:
    made = Bench("X")
    made.type("FOV 0.75 ROV 0.5 VECTOR 3 VEL 7")
    assert (made.p(8201), made.p(8216), made.p(8202), made.p(8223)) == (0.75, 0.5, 3.0, 7.0)
    made.type("P8201 = 0.25")
    assert made.type("FOV") == "0.25"


@pytest.mark.req("ACR-PROF-06")
def test_the_master_prefix_reaches_a_master_from_anywhere() -> None:
    made = Bench("X")
    assert made.at(Level.PROG, 3).type("MASTER0 VEL500") == ""
    assert made.at(Level.SYS).type("MASTER0 ACC 7 MASTER0 VEL") == "500"
    assert made.at(Level.PROG, 0).type("VEL : ACC") == "500|7"


def test_profile_commands_need_a_master_or_a_level() -> None:
    made = Bench()
    assert made.type("ACC 5") == "No master attached"
    assert made.type("ACC") == "No master attached"
    assert made.at(Level.SYS).type("ACC 5") == "Unknown command"
    assert made.type("MASTER99 ACC 5") == "Invalid argument"


@pytest.mark.req("ACR-PROF-05")
def test_profile_values_stay_in_force() -> None:
    made = bench("ACC 100 STP 100 VEL 50")
    made.type("X1")
    made.until_clear(IN_MOTION)
    made.type("X2")
    made.until_clear(IN_MOTION)
    assert made.type("ACC : STP : VEL") == "100|100|50"


# the profiles of one move


@pytest.mark.parametrize(
    ("profile", "length_u", "top_ups", "time_s"),
    [
        ("ACC 100 STP 100 VEL 50", 10, 31.6228, 0.632456),
        ("ACC 100 STP 100 VEL 50 JRK 1000", 40, 50, 1.4),
        ("ACC 100 STP 100 VEL 50 JRK 1000", 5, 17.9129, 0.558258),
        ("ACC 100 STP 100 VEL 20 FVEL 5", 10, 20, 0.65625),
        ("ACC 100 STP 0 VEL 20", 10, 20, 0.6),
        ("ACC 0 STP 0 VEL 20", 10, 20, 0.5),
        ("ACC 100 STP 100 VEL 20 IVEL 10", 10, 20, 0.1 + 0.2 + (10 - 1.5 - 2) / 20),
        ("ACC 100 STP 100 VEL 20 IVEL 50", 10, 20, 0.2 + (10 - 2) / 20),
    ],
)
def test_a_move_takes_its_time_to_the_tick(
    profile: str, length_u: int, top_ups: float, time_s: float
) -> None:
    made = bench(profile, f"X{length_u}")
    count, top = 0, 0.0
    while made.bit(IN_MOTION):
        made.ticks(1)
        count, top = count + 1, max(top, made.p(VELOCITY))
    assert count == ticks(time_s)
    assert made.p(12288) == length_u * 1000
    assert top == pytest.approx(top_ups, abs=0.11)


@pytest.mark.req("ACR-PROF-01", "ACR-PROF-04")
def test_the_trapezoid_of_the_guide_takes_twelve_seconds() -> None:
    made = bench("PPU X4000", "ACC 10 STP 10 VEL 20", "X200")
    seen: list[list[int]] = []
    for _ in range(ticks(12.0)):
        made.ticks(1)
        flags = [made.bit(flag) for flag in (ACCELERATING, STOPPING)]
        if not seen or seen[-1][1:] != flags:
            seen.append([made.card.tick, *flags])
    assert not made.bit(IN_MOTION)
    assert made.p(12288) == 800000
    assert [row[1:] for row in seen] == [[True, False], [False, False], [False, True],
                                         [False, False]]  # fmt: skip
    assert [row[0] for row in seen] == [1, 4000, 20000, 24000]


@pytest.mark.req("ACR-CMD-STP", "ACR-PROF-02")
def test_without_stp_a_move_ends_without_a_ramp() -> None:
    made = bench("ACC 100 STP 0 VEL 20", "X10")
    made.ticks(ticks(0.6) - 1)
    assert made.p(VELOCITY) == 20.0
    made.ticks(1)
    assert (made.bit(IN_MOTION), made.p(VELOCITY), made.p(12288)) == (False, 0.0, 10000)


@pytest.mark.req("ACR-PROF-03")
def test_without_stp_two_moves_merge_without_stopping() -> None:
    made = bench("ACC 100 STP 0 VEL 20", "X10 : X20")
    made.ticks(ticks(0.2))
    slowest = 20.0
    while made.p(12288) < 19900:
        made.ticks(1)
        slowest = min(slowest, made.p(VELOCITY))
    assert slowest == 20.0
    assert made.until_clear(IN_MOTION) <= 10
    assert made.p(12288) == 20000
    assert made.card.tick == ticks(0.2 + 18 / 20)


@pytest.mark.req("ACR-CMD-DEC", "ACR-PROF-02")
def test_a_slower_merged_move_is_entered_with_dec() -> None:
    made = bench("ACC 100 DEC 100 STP 0 VEL 20", "X10", "VEL 5 STP 100", "X20")
    made.ticks(ticks(0.6) - 1)
    assert not made.bit(DECELERATING)
    made.ticks(1)
    started = made.p(12288)
    count = 0
    while made.p(VELOCITY) > 5.0:
        made.ticks(1)
        assert made.bit(DECELERATING) or made.p(VELOCITY) == 5.0
        count += 1
    assert count == ticks(0.15)
    assert made.p(12288) - started == pytest.approx(1875, abs=1)
    made.until_clear(IN_MOTION)
    assert made.p(12288) == 20000


@pytest.mark.req("ACR-CMD-FVEL", "ACR-PROF-10")
def test_fvel_slows_the_end_of_a_move_but_never_speeds_it_up() -> None:
    made = bench("ACC 100 STP 100 VEL 20 FVEL 5", "X10")
    made.ticks(ticks(0.65625) - 1)
    assert made.p(VELOCITY) == pytest.approx(5.0, abs=0.1)
    made.ticks(1)
    assert (made.p(VELOCITY), made.p(12288)) == (0.0, 10000)
    slow = bench("ACC 100 STP 100 VEL 2 FVEL 5", "X1")
    assert peak(slow) == pytest.approx(2.0)


@pytest.mark.req("ACR-CMD-IVEL")
def test_ivel_is_the_speed_a_move_starts_with() -> None:
    made = bench("ACC 100 STP 100 VEL 20 IVEL 10", "X10")
    made.ticks(1)
    assert made.p(VELOCITY) == pytest.approx(10.05)


@pytest.mark.req("ACR-CMD-JRK", "ACR-PROF-19")
def test_jrk_makes_the_acceleration_a_ramp() -> None:
    straight, curved = bench("ACC 100 STP 100 VEL 50"), bench("ACC 100 STP 100 VEL 50 JRK 1000")
    changes = []
    for made in (straight, curved):
        made.type("X40")
        last = change = 0.0
        while made.bit(IN_MOTION):
            made.ticks(1)
            now = made.p(MASTER0 + at.MA_VECTOR_ACCELERATION)
            if made.bit(IN_MOTION):
                change, last = max(change, abs(now - last)), now
        changes.append(change)
    assert changes[0] == pytest.approx(100.0)
    assert changes[1] == pytest.approx(1000 * 0.0005, rel=1e-3)


@pytest.mark.req("ACR-PROF-16")
def test_a_move_of_two_axes_has_the_length_of_its_vector() -> None:
    made = bench("ACC 750 DEC 750 VEL 75 STP 750", "X25 Y15")
    made.ticks(1)
    assert made.p(LENGTH) == pytest.approx(29.15476)
    fastest = [0.0, 0.0]
    while made.bit(IN_MOTION):
        made.ticks(1)
        for axis in (0, 1):
            fastest[axis] = max(fastest[axis], made.axis(axis, at.AX_VELOCITY) / 1000)
    assert made.card.tick == ticks(29.15476 / 75 + 0.1)
    assert fastest == [pytest.approx(64.3, abs=0.05), pytest.approx(38.6, abs=0.05)]
    assert (made.p(12288), made.p(12544)) == (25000, 15000)


@pytest.mark.req("ACR-PROF-17")
def test_an_axis_that_is_not_named_is_not_part_of_the_vector() -> None:
    made = bench("ACC 750 DEC 750 VEL 75 STP 750", "X25")
    assert made.until_clear(IN_MOTION) == ticks(25 / 75 + 0.1)
    assert made.p(12544) == 0


@pytest.mark.req("ACR-CMD-VECDEF", "ACR-PROF-13")
def test_an_axis_of_weight_0_follows_the_others() -> None:
    alone = bench("ACC 100 STP 100 VEL 50", "X10")
    made = bench("ACC 100 STP 100 VEL 50", "VECDEF X1 Y0", "X10 Y5")
    made.ticks(1)
    assert made.p(LENGTH) == 10.0
    assert made.until_clear(IN_MOTION) + 1 == alone.until_clear(IN_MOTION)
    assert (made.p(12288), made.p(12544)) == (10000, 5000)


def test_weights_scale_the_length_of_a_move() -> None:
    made = bench("VECDEF X1 Y1 A0", "X3 Y4 A90", axes=("X", "Y", "A"))
    made.ticks(1)
    assert made.p(LENGTH) == 5.0
    assert made.type("VECDEF X Y A") == "1|1|0"
    assert made.type("VECDEF X-1") == "Invalid argument"


def test_weights_need_a_master() -> None:
    assert Bench("X").type("VECDEF AXIS5 1") == "No master attached"


@pytest.mark.req("ACR-CMD-VECTOR", "ACR-PROF-14")
def test_vector_is_the_length_of_a_move_without_weights() -> None:
    made = bench("ACC 0 STP 0 VEL 10", "VECDEF A0", "VECTOR 10", "A90", axes=("X", "A"))
    made.ticks(1)
    assert made.p(LENGTH) == 10.0
    assert made.until_clear(IN_MOTION) + 1 == ticks(1.0)
    assert made.p(12544) == 90000
    assert made.p(8202) == 10.0


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


# overrides


@pytest.mark.req("ACR-MOT-15", "ACR-CMD-FOV")
def test_fov_scales_the_speed_of_a_move_under_way_with_the_ramps() -> None:
    made = bench("ACC 100 DEC 200 STP 100 VEL 20", "X100")
    made.seconds(0.3)
    assert made.p(VELOCITY) == 20.0
    for factor, ramp_s in (("0.75", 5 / 200), ("0.50", 5 / 200), ("1.00", 10 / 100)):
        made.type(f"FOV {factor}")
        made.seconds(ramp_s)
        assert made.p(VELOCITY) == pytest.approx(20 * float(factor))
        assert made.p(8201) == float(factor)
    made.type("FOV 0")
    made.seconds(20 / 200 + 0.001)
    held = made.p(12288)
    assert (made.p(VELOCITY), made.p(8201), made.bit(IN_MOTION)) == (0.0, 0.0, True)
    made.seconds(0.1)
    assert made.p(12288) == held < 100_000
    made.type("FOV 1")
    made.until_clear(IN_MOTION)
    assert made.p(12288) == 100_000


@pytest.mark.req("ACR-CMD-FOV")
def test_the_override_is_that_of_one_master() -> None:
    made = bench("FOV 0.75")
    made.attach(1, (2, "Z"))
    made.at(Level.PROG, 1).all("FOV 0.5")
    assert (made.p(8201), made.p(8457)) == (0.75, 0.5)
    made.all("PPU Z1000", "ACC 0 DEC 0 STP 0 VEL 20", "Z100")
    assert (made.type("FOV"), made.at(Level.PROG, 0).type("FOV")) == ("0.5", "0.75")
    made.all("ACC 0 DEC 0 STP 0 VEL 20", "X100").ticks(2)
    assert (made.p(VELOCITY), made.p(VELOCITY + 256)) == (15.0, 10.0)


@pytest.mark.req("ACR-MOT-16", "ACR-MOT-17")
def test_fov_acts_at_once_and_vel_after_the_move() -> None:
    made = bench("ACC 0 DEC 0 STP 0 VEL 20", "X10")
    made.ticks(10)
    made.type("VEL 5")
    made.ticks(10)
    assert made.p(VELOCITY) == 20.0
    made.type("FOV 0.5")
    made.ticks(1)
    assert made.p(VELOCITY) == 10.0
    assert made.type("VEL") == "5"
    made.until_clear(IN_MOTION)
    made.type("X20")
    made.ticks(1)
    assert made.p(VELOCITY) == 2.5


@pytest.mark.req("ACR-MOT-18")
def test_fov_affects_all_axes_of_the_master() -> None:
    made = bench("ACC 0 DEC 0 STP 0 VEL 10", "X30 Y40")
    made.ticks(2)
    speeds = [made.axis(axis, at.AX_VELOCITY) for axis in (0, 1)]
    made.type("FOV 0.5")
    made.ticks(2)
    halved = [made.axis(axis, at.AX_VELOCITY) for axis in (0, 1)]
    assert halved == pytest.approx([speed / 2 for speed in speeds])


def test_override_0_holds_the_move_without_ending_it() -> None:
    made = bench("ACC 100 DEC 100 STP 100 VEL 10", "X10")
    made.seconds(0.2)
    made.type("FOV 0")
    made.seconds(0.2)
    here = made.p(12288)
    made.seconds(0.1)
    assert (made.p(VELOCITY), made.p(12288), made.bit(IN_MOTION)) == (0.0, here, True)
    made.type("FOV 1")
    made.until_clear(IN_MOTION)
    assert made.p(12288) == 10000


@pytest.mark.req("ACR-CMD-ROV")
def test_rov_scales_rapid_moves_only() -> None:
    made = bench("ACC 0 DEC 0 STP 0 VEL 10", "ROV 0.5", "X1")
    made.ticks(1)
    assert made.p(VELOCITY) == 10.0
    made.until_clear(IN_MOTION)
    made.memory.I[at.MF2_WORD] |= at.MF2_RAPID_PENDING
    made.type("X2")
    made.ticks(1)
    assert made.p(VELOCITY) == 5.0


# what the master profile does not touch


@pytest.mark.req("ACR-PROF-09", "ACR-JOG-01")
def test_a_jog_obeys_its_own_profile_only() -> None:
    made = bench("ACC 1 DEC 1 STP 1 VEL 1", "JOG ACC X1000 : JOG DEC X1000 : JOG VEL X25")
    made.type("JOG INC X10")
    assert largest(made, at.AX_CURRENT_JOG_VELOC, 0, 792) == pytest.approx(25.0)
    assert made.card.tick == ticks(0.425)
