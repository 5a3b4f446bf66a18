"""A scenario is checked before anything runs and then played by the tick alone."""

from collections.abc import Callable
from dataclasses import dataclass, field

import pytest

from openacr.errors import SourceError
from openacr.scenario import Play, State, parse_scenario

PERIOD_S = 0.0005


@dataclass
class Bench:
    """A world of numbers: what the scenario reads, and a record of what it did."""

    tick: int = 0
    bits: dict[int, bool] = field(default_factory=dict)
    parameters: dict[int, float] = field(default_factory=dict)
    positions: dict[int, float] = field(default_factory=dict)
    states: dict[int, State] = field(default_factory=dict)
    deeds: list[tuple[object, ...]] = field(default_factory=list)

    def read(self, parameter: int) -> float:
        return self.parameters.get(parameter, 0.0)

    def bit(self, number: int) -> bool:
        return self.bits.get(number, False)

    def position_u(self, axis: int) -> float:
        return self.positions.get(axis, 0.0)

    def commanded_u(self, axis: int) -> float:
        return self.positions.get(axis, 0.0)

    def program_state(self, program: int) -> State:
        return self.states.get(program, State.IDLE)

    @property
    def surroundings(self) -> "Bench":
        return self

    def set_input(self, bit: int, on: bool) -> None:
        self.bits[bit] = on
        self.deeds.append((self.tick, "input", bit, on))

    def release_input(self, bit: int) -> None:
        self.bits[bit] = False
        self.deeds.append((self.tick, "release", bit))

    def fault(self, axis: int, kind: str, value: float) -> None:
        self.deeds.append((self.tick, "fault", axis, kind, value))

    def mend(self, axis: int, kind: str | None) -> None:
        self.deeds.append((self.tick, "mend", axis, kind))

    def command(self, device: str, name: str, value: float) -> None:
        self.deeds.append((self.tick, "command", device, name, value))

    def type_text(self, text: str, stream: str | None) -> None:
        self.deeds.append((self.tick, "type", text, stream))

    def drag(self, axis: int, by_u: float) -> None:
        self.deeds.append((self.tick, "drag", axis, by_u))

    def set_analog(self, parameter: int, value: float) -> None:
        self.deeds.append((self.tick, "analog", parameter, value))


def nothing(bench: Bench, play: Play) -> None:
    """Leave the world as it is."""


def play(
    text: str, ticks: int, world: Callable[[Bench, Play], None] = nothing
) -> tuple[Bench, Play]:
    """Play `text`; `world` changes the bench at each tick."""
    bench, run = Bench(), Play(parse_scenario(text), PERIOD_S)
    for bench.tick in range(ticks):
        world(bench, run)
        run.step(bench)
    run.finish(bench)
    return bench, run


def test_inputs_of_nodes_are_switched_and_measured() -> None:
    bench, _ = play(
        """
        [[at]]
        time_s = 0.001
        set = [13568]
        analog = {input = 33800, value = -2.5}
        """,
        5,
    )
    assert bench.deeds == [(2, "input", 13568, True), (2, "analog", 33800, -2.5)]


def test_timed_actions_happen_at_their_tick_in_the_order_of_the_file() -> None:
    bench, _ = play(
        """
        [[at]]
        time_s = 0.002
        clear = [3]
        [[at]]
        time_s = 0.001
        set = [3, 4]
        [[at]]
        time_s = 0.002
        send = "PROG0\\rRUN\\r"
        stream = "COM1"
        """,
        ticks=10,
    )
    assert bench.deeds == [
        (2, "input", 3, True),
        (2, "input", 4, True),
        (4, "input", 3, False),
        (4, "type", "PROG0\rRUN\r", "COM1"),
    ]


def test_a_button_is_released_after_its_time() -> None:
    bench, _ = play("at = [{time_s = 0.001, press = [5], press_s = 0.002}]", ticks=20)
    assert bench.deeds == [(2, "input", 5, True), (6, "release", 5)]


def test_a_load_is_dragged_evenly_over_its_time() -> None:
    bench, _ = play("at = [{time_s = 0.001, drag = {axis = 3, by = 2.0, over_s = 0.002}}]", 20)
    assert bench.deeds == [(tick, "drag", 3, 0.5) for tick in (2, 3, 4, 5)]


@pytest.mark.parametrize(
    ("key", "character"),
    [("escape", "\x1b"), ("ctrl-x", "\x18"), ("ctrl-y", "\x19"), ("ctrl-z", "\x1a")],
)
def test_control_keys_send_their_character(key: str, character: str) -> None:
    bench, _ = play(f'at = [{{time_s = 0, key = "{key}"}}]', ticks=1)
    assert bench.deeds == [(0, "type", character, None)]


def test_becomes_waits_for_the_change_and_is_for_the_state() -> None:
    def moving(bench: Bench, _: Play) -> None:
        bench.bits[516] = 3 <= bench.tick < 7

    bench, _ = play(
        """
        [[at]]
        when = {bit = 516, becomes = false}
        set = [1]
        [[at]]
        when = {bit = 516, is = false}
        set = [2]
        [[at]]
        when = {bit = 516}
        set = [3]
        """,
        10,
        moving,
    )
    assert bench.deeds == [
        (0, "input", 2, True),
        (3, "input", 3, True),
        (7, "input", 1, True),
    ]


def test_a_position_a_text_a_parameter_and_a_program_can_be_waited_for() -> None:
    def world(bench: Bench, run: Play) -> None:
        bench.positions[1] = bench.tick * 0.5
        bench.parameters[39] = float(-bench.tick)
        bench.states[2] = State.RUNNING if bench.tick >= 8 else State.IDLE
        if bench.tick == 6:
            run.heard("part 1 ready\r\n")

    bench, _ = play(
        """
        [[at]]
        when = {axis = 1, above = 0.9}
        set = [1]
        [[at]]
        when = {printed = "ready"}
        set = [2]
        [[at]]
        when = {parameter = 39, below = -3, above = -6}
        set = [3]
        [[at]]
        when = {program = 2, state = "running"}
        drag = {axis = 0, by = 2.5}
        """,
        10,
        world,
    )
    assert bench.deeds == [
        (2, "input", 1, True),
        (4, "input", 3, True),
        (6, "input", 2, True),
        (8, "drag", 0, 2.5),
    ]


def test_checkpoints_chain_actions_even_within_one_tick() -> None:
    bench, run = play(
        """
        [[at]]
        after = "second"
        delay_s = 0.001
        set = [3]
        [[at]]
        after = "first"
        checkpoint = "second"
        [[at]]
        time_s = 0.002
        checkpoint = "first"
        """,
        ticks=10,
    )
    assert run.checkpoints == {"start": 0, "first": 4, "second": 4, "end": 9}
    assert bench.deeds == [(6, "input", 3, True)]


def test_a_text_printed_before_the_checkpoint_does_not_count() -> None:
    def world(bench: Bench, run: Play) -> None:
        if bench.tick in (1, 6):
            run.heard("OK\r\n")

    bench, _ = play(
        """
        [[at]]
        time_s = 0.002
        checkpoint = "go"
        [[at]]
        after = "go"
        when = {printed = "OK"}
        set = [1]
        """,
        10,
        world,
    )
    assert bench.deeds == [(6, "input", 1, True)]


def test_met_expectations_leave_no_failure() -> None:
    def world(bench: Bench, run: Play) -> None:
        bench.positions[0] = 10.004
        bench.parameters[100] = 7.0
        bench.bits[32] = bench.tick >= 4
        bench.states[0] = State.IDLE
        if bench.tick == 0:
            run.heard("A 1\r\nB 2\r\n")

    _, run = play(
        """
        [[at]]
        when = {bit = 32}
        checkpoint = "on"
        [[expect]]
        axis = 0
        position = 10
        tolerance = 0.005
        [[expect]]
        time_s = 0.0015
        flag = 32
        is = false
        [[expect]]
        when = {bit = 32, becomes = true}
        parameter = 100
        is = 7
        [[expect]]
        parameter = 100
        above = 6
        below = 8
        [[expect]]
        program = 0
        state = "idle"
        [[expect]]
        printed = ["A", "B"]
        [[expect]]
        between = ["start", "on"]
        duration_s = 0.002
        """,
        10,
        world,
    )
    assert run.failures == []
    assert len(run.verdicts) == 7


def test_every_failed_expectation_is_reported_with_expected_and_found() -> None:
    def world(bench: Bench, run: Play) -> None:
        bench.positions[0] = 9.5
        if bench.tick == 0:
            run.heard("B 2\r\nA 1\r\n")

    _, run = play(
        """
        [[expect]]
        name = "at the pallet"
        axis = 0
        position = 10
        tolerance = 0.1
        [[expect]]
        time_s = 0.001
        flag = 32
        is = true
        [[expect]]
        parameter = 100
        above = 6
        [[expect]]
        program = 3
        state = "running"
        [[expect]]
        printed = ["A", "B"]
        [[expect]]
        when = {bit = 600, becomes = false}
        flag = 1
        is = true
        [[expect]]
        between = ["start", "end"]
        duration_s = 1
        tolerance = 0.1
        """,
        10,
        world,
    )
    assert [str(verdict) for verdict in run.failures] == [
        "expected BIT32 set, found clear at 0.0010 s",
        "expected BIT1 set when BIT600 becomes clear, found that this never came",
        "at the pallet: expected axis 0 position 10 ± 0.1, found 9.5 at 0.0045 s",
        "expected P100 above 6, found 0 at 0.0045 s",
        "expected PROG3 running, found idle at 0.0045 s",
        "expected printed 'A' then 'B', found no 'B' in ' 1\\r\\n' at 0.0045 s",
        "expected 1 ± 0.1 s from start to end, found 0.0045 s at 0.0045 s",
    ]


def test_actions_whose_moment_never_came_are_named() -> None:
    _, run = play('at = [{when = {bit = 9}, send = "X"}]', ticks=3)
    assert run.idle_actions == ["when BIT9 is set"]


def test_the_card_may_run_to_the_next_known_moment() -> None:
    run = Play(parse_scenario("at = [{time_s = 1, press = [1], press_s = 1}]"), PERIOD_S)
    bench = Bench()
    seen = []
    while (tick := run.next_tick(bench.tick)) is not None:
        seen.append(tick)
        bench.tick = tick
        run.step(bench)
    assert seen == [2000, 4000]


def test_what_is_waited_for_is_known_as_long_as_it_is() -> None:
    run = Play(parse_scenario("at = [{when = {bit = 1}, set = [1]}]"), PERIOD_S)
    bench = Bench(tick=41)
    assert [condition.bit for condition in run.conditions] == [1]
    assert run.next_tick(41) is None
    bench.bits[1] = True
    run.step(bench)
    assert run.conditions == ()


def test_while_a_load_is_dragged_every_tick_is_looked_at() -> None:
    drag = "at = [{time_s = 0, drag = {axis = 3, by = 2.0, over_s = 0.002}}]"
    run = Play(parse_scenario(drag), PERIOD_S)
    run.step(Bench())
    assert run.next_tick(0) == 1


def test_a_step_skipped_over_its_moment_is_made_up_for() -> None:
    run = Play(parse_scenario("at = [{time_s = 0.001, set = [1]}]"), PERIOD_S)
    bench = Bench(tick=50)
    run.step(bench)
    assert bench.deeds == [(50, "input", 1, True)]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("duration_s = 'x'", 's.toml:1:1: duration_s is "x"; it must be a number above 0'),
        (
            "duration_s = 0\n",
            "s.toml:1:1: duration_s is 0; it must be a number above 0",
        ),
        (
            "[[at]]\ntime_s = 1\nsets = [1]",
            "s.toml:3:1: unknown key `sets` (allowed: time_s, when, after",
        ),
        (
            "[[at]]\ntime_s = 1\nset = [1]\n[[at]]\ntime_s = 1\nset = [true]",
            "s.toml:6:1: set: expected `int`, got `bool`",
        ),
        (
            "[[at]]\nwhen = {bit = 1, becomse = true}\nset = [1]",
            "s.toml:2:18: unknown key `becomse` (allowed: bit, is, becomes",
        ),
        (
            "[[at]]\ntime_s = 1\nkey = 'ctrl-c'",
            "s.toml:3:1: key: invalid enum value 'ctrl-c' (allowed: escape, ctrl-x,",
        ),
        ("[[at]]\nset = [1]", "s.toml:1:3: this entry does not say when it happens"),
        ("[[at]]\ntime_s = 1", "s.toml:1:3: this entry does nothing (one of set, clear"),
        (
            "[[at]]\ntime_s = 1\nanalog = {input = 33289, value = 1.0}",
            "s.toml:3:1: P33289 is not an analog input",
        ),
        ("[[at]]\ntime_s = 1\nset = [12032]", "s.toml:3:1: bit 12032 is not an input"),
        ("[[at]]\ntime_s = 1\nset = [32]", "s.toml:3:1: bit 32 is not an input (inputs are"),
        (
            "[[at]]\ntime_s = 1\nafter = 'start'\nset = [1]",
            "s.toml:2:1: `time_s` and `after` exclude each other",
        ),
        ("[[at]]\nafter = 'x'\nset = [1]", "s.toml:2:1: no checkpoint 'x' (known: start)"),
        (
            "[[at]]\ntime_s = 1\nsend = 'X'\nstream = 'COM9'",
            "s.toml:4:1: no stream 'COM9' (one of FIFO, COM1",
        ),
        (
            "duration_s = 2\n[[at]]\ntime_s = 3\nset = [1]",
            "s.toml:3:1: 3 s is after the end of the run at 2 s",
        ),
        (
            "[[at]]\ntime_s = 0\ncheckpoint = 'a'\n[[at]]\ntime_s = 1\ncheckpoint = 'a'",
            "s.toml:6:1: checkpoint 'a' exists already",
        ),
        ("[[at]]\nwhen = {axis = 16}\nset = [1]", "s.toml:2:9: axis: expected `int` <= 15"),
        ("[[at]]\nwhen = {axis = 1}\nset = [1]", "s.toml:2:1: what of axis? (`above` or `below`)"),
        (
            "[[at]]\nset = [1]\n[at.when]\nbit = 1\nabove = 2",
            "s.toml:5:1: `above` does not belong to a condition on a bit",
        ),
        ("[[expect]]\nname = 'n'", "s.toml:1:3: an expectation has exactly one of parameter"),
        ("[[expect]]\nflag = 1", "s.toml:1:3: what is expected of the flag? (is)"),
        ("[[expect]]\nflag = 1\nis = 1", "s.toml:3:1: a flag is true or false"),
        ("[[expect]]\nparameter = 1\nis = true", "s.toml:3:1: a parameter is a number"),
        (
            "[[expect]]\nflag = 1\nis = true\ntolerance = 1",
            "s.toml:4:1: `tolerance` does not belong to an expected flag (allowed: after,",
        ),
        (
            "[[expect]]\nbetween = ['start', 'x']\nduration_s = 1",
            "s.toml:2:1: no checkpoint 'x' (known: end, start)",
        ),
        ("[[at]]\ntime_s = = 1", "s.toml:2:10: invalid value"),
        ("[[at]", "s.toml:1:5: expected"),
        ("[[at]]\ntime_s = inf\nset = [1]", "s.toml:2:1: numbers have to be finite"),
        ("at = 3", "s.toml:1:1: at: expected `array`, got `int`"),
    ],
)
def test_everything_that_could_not_be_played_is_refused_with_its_place(
    text: str, message: str
) -> None:
    with pytest.raises(SourceError) as caught:
        parse_scenario(text, "s.toml")
    assert str(caught.value).startswith(message)


def test_faults_are_put_in_and_taken_back() -> None:
    bench, _ = play(
        """
        [[at]]
        time_s = 0.001
        fault = {axis = 2, kind = "jam"}
        release = [3]
        [[at]]
        time_s = 0.001
        fault = {axis = 3, kind = "obstacle", at = -12.5}
        [[at]]
        time_s = 0.001
        fault = {axis = 4, kind = "friction", torque_nm = 0.5}
        [[at]]
        time_s = 0.002
        mend = {axis = 2, kind = "jam"}
        [[at]]
        time_s = 0.002
        mend = {axis = 3}
        """,
        8,
    )
    assert bench.deeds == [
        (2, "release", 3),
        (2, "fault", 2, "jam", 0.0),
        (2, "fault", 3, "obstacle", -12.5),
        (2, "fault", 4, "friction", 0.5),
        (4, "mend", 2, "jam"),
        (4, "mend", 3, None),
    ]


def test_devices_are_commanded_by_hand() -> None:
    bench, _ = play(
        """
        [[at]]
        time_s = 0.001
        command = {device = "left", name = "part"}
        [[at]]
        time_s = 0.002
        command = {device = "left", name = "part", value = false}
        [[at]]
        time_s = 0.003
        command = {device = "belt", name = "speed", value = 2.5}
        """,
        8,
    )
    assert bench.deeds == [
        (2, "command", "left", "part", 1.0),
        (4, "command", "left", "part", 0.0),
        (6, "command", "belt", "speed", 2.5),
    ]


def repeated(condition: str, world: Callable[[Bench, Play], None], more: str = "") -> list[int]:
    """Ticks at which an action with `every` was performed."""
    text = f"at = [{{when = {{{condition}}}, every = true, set = [5]{more}}}]"
    bench, _ = play(text, 30, world)
    return [int(str(deed[0])) for deed in bench.deeds]


def blinking(bench: Bench, _: Play) -> None:
    bench.bits[516] = bench.tick % 10 >= 7


def test_every_repeats_an_action_each_time_its_condition_becomes_true() -> None:
    assert repeated("bit = 516", blinking) == [7, 17, 27]
    assert repeated("bit = 516, is = false", blinking) == [0, 10, 20]
    assert repeated("bit = 516, becomes = true", blinking) == [7, 17, 27]
    assert repeated("bit = 516, becomes = false", blinking) == [10, 20]


def test_a_delayed_repetition_happens_once_for_each_time() -> None:
    assert repeated("bit = 516", blinking, ", delay_s = 0.006") == [19, 29]


def test_every_hears_a_text_each_time_it_is_printed() -> None:
    def printing(bench: Bench, run: Play) -> None:
        if bench.tick in (3, 4, 9):
            run.heard("part\r\n")

    assert repeated('printed = "part"', printing) == [3, 4, 9]


def test_a_repeated_action_keeps_its_place_in_the_order_of_the_file() -> None:
    bench, _ = play(
        """
        at = [{when = {bit = 516}, every = true, set = [1]}, {time_s = 0.0035, set = [2]}]
        """,
        10,
        blinking,
    )
    assert bench.deeds == [(7, "input", 1, True), (7, "input", 2, True)]


def test_a_repeated_action_that_has_happened_is_not_reported_as_idle() -> None:
    text = "at = [{when = {bit = 516}, every = true, set = [1]}]"
    assert play(text, 10, blinking)[1].idle_actions == []
    assert play(text, 5, blinking)[1].idle_actions == ["when BIT516 is set"]


@pytest.mark.parametrize(
    ("entry", "text"),
    [
        ("time_s = 1, every = true, set = [1]", "`every` needs `when`"),
        ("when = {bit = 3}, every = true, checkpoint = 'a'", "a checkpoint is one moment"),
        ("time_s = 1, fault = {axis = 0, kind = 'jam', at = 3}", "`at` does not belong to the"),
        ("time_s = 1, fault = {axis = 0, kind = 'obstacle'}", "the fault obstacle needs `at`"),
        ("time_s = 1, fault = {axis = 0, kind = 'friction', at = 1}", "`at` does not belong"),
        ("time_s = 1, fault = {axis = 0, kind = 'friction'}", "friction needs `torque_nm`"),
        ("time_s = 1, fault = {axis = 0, kind = 'rust'}", "allowed: encoder-lost, encoder-noise"),
        ("time_s = 1, release = [40]", "bit 40 is not an input"),
    ],
)
def test_faults_and_repetitions_that_make_no_sense_are_refused(entry: str, text: str) -> None:
    with pytest.raises(SourceError, match=text):
        parse_scenario(f"at = [{{{entry}}}]")
