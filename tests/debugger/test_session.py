"""A debugged card: where it stops, forwards and backwards, and what is seen there."""

from pathlib import Path

import pytest
from tests.debugger.project import card_of

from openacr.client.program_variables import Value
from openacr.controller import Controller
from openacr.debugger.breakpoints import DataBreakpoint, Fault, LineBreakpoint
from openacr.debugger.calls import depth_of, frames_of, levels_of, listing, state_of
from openacr.debugger.card_course import CardCourse
from openacr.debugger.questions import answer, assign
from openacr.debugger.stops import Reason, Stop
from openacr.debugger.variables import locals_of, program_state
from openacr.errors import UserError
from openacr.timeline import Moment

COUNT, CALL, DWELL, DOUBLE, SET = 50, 60, 70, 100, 110


class Bench:
    """A session with both programs running, and what it has shown."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.shown: list[str] = []
        self.card = card_of(folder)
        self.session = CardCourse(self.card, self.shown.append)
        self.card.send("PROG0\rRUN\r")

    def breaks(self, *lines: LineBreakpoint) -> Stop | None:
        self.session.set_lines(list(lines))
        return self.session.run(4000)

    def line(self, program: int = 0) -> int:
        return frames_of(self.card, program)[0].line

    def steps(self, count: int, *, into: bool = False) -> list[int]:
        found = []
        for _ in range(count):
            self.session.begin_step(0, into=into)
            assert self.session.run(4000) == Stop(Reason.STEP, 0)
            found.append(self.line())
        return found


@pytest.fixture
def bench(tmp_path: Path) -> Bench:
    return Bench(tmp_path)


def test_a_line_stops_before_it_is_executed(bench: Bench) -> None:
    for count in range(3):
        assert bench.breaks(LineBreakpoint(0, COUNT)) == Stop(Reason.BREAKPOINT, 0)
        assert (bench.line(), bench.card.p[0]) == (COUNT, count)


def test_lines_that_are_no_breakpoints_any_more_do_not_stop(bench: Bench) -> None:
    assert bench.breaks(LineBreakpoint(0, COUNT)) is not None
    assert bench.breaks() is None
    assert bench.card.p[0] > 50


def test_a_condition_decides_and_leaves_no_trace(bench: Bench) -> None:
    other = Bench(bench.folder)
    assert bench.breaks(LineBreakpoint(0, COUNT, "P0=7 OR P0=9")) == Stop(Reason.BREAKPOINT, 0)
    assert bench.card.p[0] == 7
    assert bench.breaks(LineBreakpoint(0, COUNT, "P0=7 OR P0=9")) is not None
    assert bench.card.p[0] == 9
    bench.session.set_lines([])
    end_tk = bench.card.lived_tk + 50
    bench.session.run(50)
    other.session.run(end_tk - other.card.lived_tk)
    assert bench.card.lived_tk == other.card.lived_tk
    assert bench.card.digest() == other.card.digest()


def test_a_condition_that_cannot_be_computed_stops_and_says_why(bench: Bench) -> None:
    assert bench.breaks(LineBreakpoint(0, COUNT, "LV99 > 1")) is not None
    assert bench.shown == ["?LV99 > 1: Undefined variable\n"]


def test_a_count_of_hits_is_a_first_hit(bench: Bench) -> None:
    found = LineBreakpoint(0, COUNT, hits=4)
    assert bench.breaks(found) is not None
    assert bench.card.p[0] == 3
    assert bench.breaks(found) is not None
    assert bench.card.p[0] == 4


def test_a_line_can_print_instead_of_stopping(bench: Bench) -> None:
    stop = LineBreakpoint(0, DWELL, "P0=3")
    assert (
        bench.breaks(LineBreakpoint(0, COUNT, log="count {P0}, {P0*P0} {LV77}"), stop) is not None
    )
    assert bench.shown == [
        "count 0, 0 <?LV77: Undefined variable>\n",
        "count 1, 1 <?LV77: Undefined variable>\n",
        "count 2, 4 <?LV77: Undefined variable>\n",
    ]


def test_steps_pass_over_routines_or_go_into_them_or_out(bench: Bench) -> None:
    bench.breaks(LineBreakpoint(0, CALL, "P0=4"))
    bench.session.set_lines([])
    assert bench.steps(4) == [DWELL, 80, COUNT, CALL]
    assert bench.steps(2, into=True) == [DOUBLE, SET]
    assert depth_of(bench.card, 0) == 1
    assert [frame.line for frame in frames_of(bench.card, 0)] == [SET, CALL]
    bench.session.begin_step(0, out=True)
    bench.session.run(4000)
    assert (bench.line(), depth_of(bench.card, 0)) == (DWELL, 0)


def test_a_step_ends_with_its_program(bench: Bench) -> None:
    bench.card.send("PROG1\rP7=1\rRUN\r")
    bench.session.set_lines([LineBreakpoint(1, 40)])
    assert bench.session.run(4000) == Stop(Reason.BREAKPOINT, 1)
    bench.session.begin_step(1)
    bench.session.run(4000)
    bench.session.begin_step(1)
    assert bench.session.run(4000) == Stop(Reason.STEP, 1, "PROG1 has ended")
    assert frames_of(bench.card, 1) == []
    with pytest.raises(UserError, match="PROG1 does not run"):
        bench.session.begin_step(1)


def test_steps_back_are_the_steps_forward_in_reverse(bench: Bench) -> None:
    bench.breaks(LineBreakpoint(0, CALL, "P0=4"))
    bench.session.set_lines([])
    places = []
    for _ in range(20):
        bench.session.begin_step(0, into=True)
        bench.session.run(4000)
        places.append((bench.session.timeline.now, bench.line(), bench.card.p[1]))
    for place in reversed(places[:-1]):
        assert bench.session.step_back(0) == Stop(Reason.STEP, 0)
        assert (bench.session.timeline.now, bench.line(), bench.card.p[1]) == place


def test_running_back_finds_the_stops_in_reverse(bench: Bench) -> None:
    found = LineBreakpoint(0, SET)
    places = []
    for _ in range(5):
        assert bench.breaks(found) is not None
        places.append((bench.session.timeline.now, bench.card.p[1]))
    bench.session.set_lines([])
    bench.session.run(300)
    bench.session.set_lines([found, LineBreakpoint(0, COUNT, "P0=900")])
    back = []
    while (stop := bench.session.run_back()).reason is Reason.BREAKPOINT:
        back.append((bench.session.timeline.now, bench.card.p[1]))
    assert stop == Stop(Reason.ENTRY, None, "the beginning of what is known")
    assert back[-5:] == places[::-1]
    assert bench.session.timeline.now == bench.session.timeline.branch.first


def test_ticks_go_forward_and_back(bench: Bench) -> None:
    bench.breaks(LineBreakpoint(0, COUNT))
    within = bench.session.timeline.now
    assert within.within
    assert bench.session.tick() == Stop(Reason.STEP, None, "one servo interrupt")
    assert bench.session.timeline.now == Moment(within.tick)
    bench.session.tick()
    assert bench.session.timeline.now == Moment(within.tick + 1)
    bench.session.tick_back()
    bench.session.tick_back()
    assert bench.session.timeline.now == Moment(within.tick - 1)
    bench.session.seek(bench.session.timeline.branch.first)
    assert bench.session.tick_back().reason is Reason.ENTRY


@pytest.mark.parametrize(("name", "before", "after"), [("P0", 3, 4), ("p1", 0, 6)])
def test_a_changed_parameter_stops_after_its_tick(
    bench: Bench, name: str, before: float, after: float
) -> None:
    bench.breaks(LineBreakpoint(0, CALL, "P0=3"))
    bench.session.set_lines([])
    assert bench.card.p[int(name[1:])] == before
    bench.session.set_data([DataBreakpoint(name)])
    assert bench.session.run(4000) == Stop(Reason.DATA, None, f"{name} has changed")
    assert (bench.card.p[int(name[1:])], bench.card.within) == (after, 0)


def test_a_flag_that_changes_stops_too_and_only_if_its_condition_holds(bench: Bench) -> None:
    bench.session.set_data([DataBreakpoint("BIT1048", "P0>20")])
    assert bench.session.run(400) is None
    bench.session.set_data([DataBreakpoint("P0", "P0>25"), DataBreakpoint("BIT40")])
    assert bench.session.run(4000) is not None
    assert bench.card.p[0] == 26
    assert bench.session.run_back().reason is Reason.ENTRY


def test_a_change_is_found_backwards(bench: Bench) -> None:
    bench.session.run(1000)
    value = bench.card.p[0]
    bench.session.set_data([DataBreakpoint("P0")])
    assert bench.session.run_back() == Stop(Reason.DATA, None, "P0 has changed")
    tick = bench.session.timeline.now.tick
    assert bench.card.p[0] == value
    bench.session.tick_back()
    assert (bench.card.p[0], bench.session.timeline.now.tick) == (value - 1, tick - 1)


def test_what_cannot_be_watched_is_refused(bench: Bench) -> None:
    for name in ("LV0", "P99999999", "BIT99999999", "P"):
        with pytest.raises(UserError, match=name):
            bench.session.set_data([DataBreakpoint(name)])


def test_the_error_of_a_program_stops_if_it_is_wanted(bench: Bench) -> None:
    bench.card.send("PROG1\rRUN\r")
    assert bench.session.run(3000) is None
    assert {each.name: each.text for each in program_state(bench.card, 1)}[
        "error"
    ] == "Divide by zero"
    bench.session.set_faults(frozenset([Fault.PROGRAM]))
    bench.card.send("RUN\r")
    assert bench.session.run(3000) == Stop(Reason.EXCEPTION, 1, "Divide by zero")
    assert bench.session.run(3000) is None
    assert bench.session.run_back() == Stop(Reason.EXCEPTION, 1, "Divide by zero")


def test_killed_motion_stops_if_it_is_wanted(bench: Bench) -> None:
    bench.session.set_faults(frozenset([Fault.KILL]))
    bench.card.send("PROG1\rP7=1\rNEW\r10 DWL 0.1\r20 SET 522\r30 DWL 0.1\r40 CLR 522\rRUN\r")
    assert bench.session.run(3000) == Stop(
        Reason.EXCEPTION, None, "the motion of MASTER0 is killed"
    )
    assert bench.session.run(3000) is None


def test_a_change_at_a_line_takes_effect_there_and_in_another_branch(bench: Bench) -> None:
    bench.breaks(LineBreakpoint(0, CALL, "P0=6"))
    place = bench.session.timeline.now
    bench.session.set_lines([])
    bench.session.run(500)
    known = bench.card.p[0]
    bench.session.seek(place)
    assign(bench.card, 0, "P0", "600")
    assign(bench.card, 0, "LV1", "5")
    bench.session.run(5)
    assert (bench.card.p[1], answer(bench.card, 0, "LV1")) == (1200, "5")
    bench.session.timeline.switch(0)
    assert bench.card.p[0] == known


def test_open_levels_are_known_with_their_lines() -> None:
    card = Controller()
    card.send(
        "PROG0\rPROGRAM\rDIM LV(2)\rFOR LV0 = 1 TO 3 STEP 1\rWHILE (LV1 < 5)\rGOSUB sub\r"
        "LV1 = LV1+1\rWEND\rNEXT\rEND\r_sub\rIF (LV0 > 0)\rDWL 1\rENDIF\rRETURN\rENDP\rRUN\r"
    )
    card.advance(seconds=0.3)
    assert [str(level) for level in levels_of(card, 0)] == [
        "FOR line 30", "WHILE line 40", "GOSUB line 50", "IF line 110",
    ]  # fmt: skip
    assert list(program_state(card, 0)) == [
        Value("state", "dwells"),
        Value("levels", "FOR line 30, WHILE line 40, GOSUB line 50, IF line 110"),
    ]
    card.send("HALT\r")
    assert levels_of(card, 0) == []
    assert list(program_state(card, 0)) == [Value("state", "ended")]


def test_variables_and_states_are_shown(bench: Bench) -> None:
    bench.card.send("PROG1\rDIM SV(1)\rDIM DV(1)\rDIM DA(2)\rDIM DA1(2)\rDIM $V(1,9)\r")
    bench.card.send('SV0=1.5\rDV0=-1/3\rDA1(1)=2.25\r$V0="it"\r')
    elements = (Value("DA1(0)", "0"), Value("DA1(1)", "2.25"))
    assert list(locals_of(bench.card, 1)) == [
        Value("SV0", "1.5"), Value("DV0", "-0.333333333"), Value("DA1", "2 elements", elements),
        Value("$V0", "'it'"),
    ]  # fmt: skip
    bench.session.run(100)
    assert [value.name for value in locals_of(bench.card, 0)] == ["LV0", "LV1", "LV2"]
    assert state_of(bench.card, 0) == "dwells"
    assert state_of(bench.card, 1) == "ended"
    assert listing(bench.card, 16) == ["10 LD 40", "20 OUT 41"]
