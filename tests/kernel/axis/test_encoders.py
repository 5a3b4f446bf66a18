"""ENC ROTARY and LIMIT: positions that wrap for those who look, edges too quick to count."""

from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.basic.motion_bench import WHEEL, Bench, turn

from openacr.compiled import pick
from openacr.kernel.axis import feedback_cy
from openacr.map.memory import Memory
from openacr.map.rows import axes, encoders, motors, plant

T = 0.0005
STEPS = [feedback_cy.encoder_filters_step, pick(feedback_cy.encoder_filters_step)]
GEAR = axes.gear_cnt[0]


def moved(motor: int, made: Bench, raw: float) -> Bench:
    """The motor of an encoder turns to a raw count within one tick."""
    made.memory.I[motors.kind[motor]] = 1
    made.memory.F[motors.raw_count[motor]] = raw
    return made.ticks(1)


# ROTARY


def test_a_position_wraps_into_its_turn_and_is_unrolled_again() -> None:
    made = Bench().all("ENC10 ROTARY 1000")
    shown = [turn(made, count).p(WHEEL) for count in (999, 1, -1, -1500, 7000)]
    assert shown == [999, 0, 999, 499, 499]
    assert made.type("ENC10 ROTARY : ENC10") == "1000|499"
    made.all("ENC10 ROTARY 360")
    assert made.p(WHEEL) == 6499 % 360
    made.all("ENC10 ROTARY 0")
    assert turn(made, 1).p(WHEEL) == 6500


@given(st.lists(st.tuples(st.integers(-(2**31), 2**31 - 1), st.integers(0, 2**31 - 1)), max_size=8))
def test_the_position_is_always_the_count_modulo_the_length(
    steps: list[tuple[int, int]],
) -> None:
    memory, count = Memory(), 0
    for step, length in steps:
        feedback_cy.encoder_roll(memory.I, 0, length)
        moved_to = memory.I[encoders.parameters[0]] + step
        memory.I[encoders.parameters[0]] = (moved_to + 2**31) % 2**32 - 2**31
        feedback_cy.encoder_wrap(memory.I, 0)
        count = (count + step + 2**31) % 2**32 - 2**31
        assert feedback_cy.encoder_count(memory.I, 0) == count
        assert feedback_cy.encoder_shaft(memory.I, 0) == count
        if length:
            assert 0 <= memory.I[encoders.parameters[0]] < length
        else:
            assert memory.I[encoders.parameters[0]] == count


def test_the_axis_of_a_wrapping_encoder_moves_on_without_an_error() -> None:
    made = Bench("X").all("PPU X1000", "ENC0 ROTARY 300", "ACC 0 DEC 0 STP 0 VEL 1", "X1.25")
    worst = 0.0
    while made.bit(516):
        made.ticks(1)
        worst = max(worst, abs(made.axis(0, axes.following_error)))
        assert 0 <= made.p(6144) < 300
    assert worst <= 1
    assert (made.ticks(2).p(12290), made.p(6144)) == (1250, 1250 % 300)
    assert abs(made.p(6145)) <= 1000  # the speed has no wraps in it


def test_a_motor_that_turns_on_keeps_its_axis_and_its_encoder() -> None:
    made = Bench("X").all("ENC0 MULT 4", "ENC0 ROTARY 100", "TLM X0")
    for raw in (70, 140, 210, -30):
        moved(0, made, raw)
        assert (made.p(12290), made.p(6144)) == (raw, raw % 100)


def test_res_of_an_axis_and_of_a_wrapping_encoder_make_the_count_that_is_asked_for() -> None:
    made = Bench("X").all("ENC0 ROTARY 100", "TLM X0", "RES X250").ticks(1)
    assert (made.p(12290), made.p(6144)) == (250, 50)
    made.all("ENC0 RES -30").ticks(1)
    assert (made.p(12290), made.p(6144)) == (-30, 70)


def test_gears_and_cams_do_not_feel_the_wrap() -> None:
    made = Bench("X").all("ENC10 ROTARY 100", "GEAR SRC X ENC10", "GEAR ON X")
    turn(made, *[30] * 10, -500)
    assert made.memory.F[GEAR] == -200.0
    made.all("ENC10 RES 99").ticks(1)
    before = made.memory.F[GEAR]
    assert turn(made, 2).memory.F[GEAR] == before + 2.0


def test_an_encoder_locked_to_a_wrapping_one_counts_every_pulse() -> None:
    made = Bench().all("ENC10 ROTARY 100", "ENC11 LOCK 10", "ENC12 LOCK 11", "ENC12 ROTARY 70")
    turn(made, *[40] * 10).ticks(1)
    assert [made.type(f"ENC{n}") for n in (10, 11, 12)] == ["0", "400", "50"]
    made.all("ENC11 ROTARY 10", "ENC11 UNLOCK")
    assert made.type("ENC11 ROTARY") == "10"
    assert turn(made, 5).type("ENC11") == "0"


def test_windows_and_copies_see_the_wrapped_position() -> None:
    made = Bench().all("ENC10 ROTARY 100", "ENC10 DST P4100", "OOP0 SRC ENC10", "OOP0 POS (10,20)")
    made.all("OOP0 ON")
    seen = [turn(made, count).bit(32) for count in (15, 90, 10, 100, 100)]
    assert seen == [True, False, True, True, True]
    assert made.p(4100) == 15


def test_a_captured_source_position_is_one_of_the_turn() -> None:
    made = Bench("X").all("ENC10 ROTARY 100", "GEAR SRC X ENC10", "GEAR ON TRG X(2, P38912)")
    turn(made, 95).memory.set_bit(26, True)
    assert turn(made, 10).p(38912) == 5


def test_a_marker_of_another_encoder_starts_a_gear_within_the_tick() -> None:
    """The register names encoder 0: its marker comes after a quarter of the travel of the tick."""
    made = Bench("X").all("ENC0 MULT 4", "TLM X0", "GEAR SRC X ENC10", "GEAR ON TRG X(0, 0)")
    made.memory.I[motors.marker_edges[0]] = 1
    made.memory.F[motors.marker_rise_cnt[0]] = 10.0
    made.memory.I[WHEEL] += 100
    assert moved(0, made, 40.0).memory.F[GEAR] == 75.0


def test_ihpos_counts_the_source_beyond_a_setpoint_of_the_turn() -> None:
    made = Bench("X").all("ENC10 ROTARY 100", "GEAR SRC X ENC10")
    turn(made, 70, 70)  # at 40
    made.all("GEAR ON IHPOS X(P6304, 55)")
    turn(made, 10, 10)
    assert made.memory.F[GEAR] == 5.0


def test_a_ballscrew_table_is_read_within_the_turn() -> None:
    made = Bench("X").all("DIM LA(1)", "DIM LA0(3)", "LA0(0)=0 : LA0(1)=50 : LA0(2)=0")
    made.all("BSC DIM X1", "BSC SEG X(0,100,LA0)", "BSC SRC X ENC10", "ENC10 ROTARY 100")
    made.all("BSC ON X").ticks(1)
    offset = axes.ballscrew_cnt[0]
    assert [turn(made, 25).memory.F[offset] for _ in range(6)] == [25, 50, 25, 0, 25, 50]


@pytest.mark.parametrize("value", ["-1", "2147483648"])
@pytest.mark.parametrize("word", ["ROTARY", "LIMIT", "CLOCK", "WIDTH"])
def test_values_that_cannot_be_are_refused(word: str, value: str) -> None:
    made = Bench()
    assert made.type(f"ENC1 {word} {value}") == "Invalid argument"
    assert made.type(f"ENC1 {word}") == "0"
    assert made.type(f"ENC{encoders.COUNT} {word} 1") == "Invalid argument"


def test_the_interface_of_an_absolute_encoder_is_kept() -> None:
    made = Bench().all("ENC2 CLOCK 250000", "ENC2 WIDTH 25")
    assert made.type("ENC2 CLOCK : ENC2 WIDTH") == "250000|25"
    assert made.type("ENC2 WIDTH 33") == "Invalid argument"


# LIMIT


def counted(step: Callable[..., None], limit_hz: int, steps: list[int]) -> list[int]:
    """Positions of encoder 0, whose motor turns by these raw counts, tick by tick."""
    memory = Memory()
    memory.I[encoders.mult[0]] = 4
    feedback_cy.encoder_limit(memory.F, memory.I, 0, limit_hz)
    shown = []
    for counts in steps:
        memory.F[motors.raw_count[0]] += counts
        step(memory.F, memory.I, T)
        feedback_cy.encoder_step(memory.F, memory.I, 0, 1 / T)
        shown.append(memory.I[encoders.parameters[0]])
    return shown


@pytest.mark.parametrize("step", STEPS)
@pytest.mark.parametrize("steps", [1, -1])
def test_edges_below_the_limit_all_count_and_those_above_are_lost(
    step: Callable[..., None], steps: int
) -> None:
    slow, fast = [10 * steps] * 50, [60 * steps] * 50  # 20 000 and 120 000 edges a second
    assert counted(step, 100_000, [*slow, 0])[-1] == 500 * steps
    positions = counted(step, 100_000, [*slow, *fast, *slow, 0])
    assert positions[99] - positions[50] == 0  # nothing counts while it is too quick
    lost = 4000 * steps - positions[-1]
    assert lost % 4 == 0
    assert abs(lost) >= 2990


@pytest.mark.parametrize("step", STEPS)
def test_a_spike_is_no_motion(step: Callable[..., None]) -> None:
    assert counted(step, 1500, [1, -1, 0, 0, 0, 0]) == [0] * 6
    assert counted(step, 0, [1, -1, 0]) == [1, 0, 0]


def edge_by_edge(limit_hz: int, steps: list[int]) -> int:
    """The same filter on a list of edges with their times, and a decoder of four states."""
    edges: list[tuple[float, int]] = []  # when, and the raw count from then on
    raw = 0
    for tick, counts in enumerate(steps):
        for number in range(abs(counts)):
            raw += 1 if counts > 0 else -1
            edges.append(((tick + (number + 0.5) / abs(counts)) * T, raw))
    count = state = 0
    for (when, level), (until, _) in zip(edges, [*edges, (len(steps) * T, 0)][1:], strict=True):
        if until - when >= 1 / limit_hz:
            count += {0: 0, 1: 1, 2: 0, 3: -1}[(level - state) % 4]
            state = level
    return count


@given(
    # hold times that are no multiple of what the distances of edges can add up to
    st.sampled_from([1009, 3001, 10_007, 50_021, 200_003]),
    st.lists(st.integers(-120, 120), max_size=30),
)
def test_the_filter_does_what_it_does_to_single_edges(limit_hz: int, steps: list[int]) -> None:
    for step in STEPS:
        shown = counted(step, limit_hz, steps)
        assert (shown or [0])[-1] == edge_by_edge(limit_hz, steps)


def test_a_limit_that_comes_and_goes_leaves_the_position() -> None:
    made = moved(0, Bench("X").all("ENC0 MULT 4", "TLM X0"), 500.0)
    made.all("ENC0 LIMIT 100000")
    assert made.type("ENC0 LIMIT : ENC0") == "100000|500"
    moved(0, made, 900.0)  # 800 000 edges a second
    assert moved(0, made, 901.0).ticks(1).p(6144) == 501
    made.all("ENC0 LIMIT 0")
    assert moved(0, made, 911.0).p(12290) == 511


def test_a_capture_reads_the_counter_after_the_filter() -> None:
    made = Bench("X").all("ENC0 MULT 4", "TLM X0", "ENC0 LIMIT 100000", "INTCAP X2").ticks(1)
    made.memory.I[motors.kind[0]] = 1
    made.memory.F[motors.previous_cnt[0]] = 0.5
    made.memory.F[motors.position_cnt[0]] = 400.5
    made.memory.I[plant.rises] = 1 << 24
    made.memory.F[plant.rise_fraction + 24] = 0.5
    assert moved(0, made, 400.0).p(12292) == 0
