"""Breakpoints on lines of PLCs: the card stops after the scan in which a coil has changed."""

from pathlib import Path

import pytest

from openacr.controller import Controller
from openacr.debugger.breakpoints import DataBreakpoint, LineBreakpoint
from openacr.debugger.card_target import CardTarget
from openacr.debugger.stops import Reason, Stop
from openacr.errors import UserError

SETUP = "SYS\nDIM PROG0(1000)\nDIM PLC0(1000)\nDIM PLC2(1000)\nDIM P(9)\n"
PLC0 = "PROGRAM\nLD 40\nOUT 41 OUT NOT 42\nLD 43\nSET 44\nLD 45\nTIM 2 5\nENDP\n"
PLC2 = "10 LD 41\n20 OUT 46\n"
LOAD, OUT, SET, TIMER = 20, 30, 50, 70
PLC, OTHER = 16, 18


class Bench:
    """A card whose two PLCs run, and what the session has shown."""

    def __init__(self, folder: Path) -> None:
        for name, text in (("setup", SETUP), ("plc0", PLC0), ("plc2", PLC2)):
            (folder / f"{name}.8k").write_text(text)
        self.card = Controller.from_project(folder)
        self.card.send("PLC0\rRUN\rPLC2\rRUN\rPROG0\r")
        self.card.advance(5)
        self.shown: list[str] = []
        self.session = CardTarget(self.card, self.shown.append)

    def breaks(self, *lines: LineBreakpoint) -> Stop | None:
        self.session.course.set_lines(list(lines))
        return self.session.course.run(100)


@pytest.fixture
def bench(tmp_path: Path) -> Bench:
    return Bench(tmp_path)


def test_a_coil_that_changes_stops_after_its_scan(bench: Bench) -> None:
    assert bench.breaks(LineBreakpoint(PLC, OUT)) is None
    before_tk = bench.card.lived_tk
    for is_set in (True, False):
        bench.card.bit[40] = is_set
        text = "BIT41 is set, BIT42 is clear" if is_set else "BIT41 is clear, BIT42 is set"
        assert bench.session.course.run(100) == Stop(Reason.BREAKPOINT, PLC, text)
        assert bench.card.lived_tk == before_tk + 1
        assert bench.session.course.run(100) is None
        before_tk = bench.card.lived_tk


def test_a_line_of_another_plc_stops_in_its_own_scan(bench: Bench) -> None:
    bench.card.bit[40] = True
    both = LineBreakpoint(OTHER, 20), LineBreakpoint(PLC, SET)
    assert bench.breaks(*both) == Stop(Reason.BREAKPOINT, OTHER, "BIT46 is set")
    bench.card.bit[43] = True
    assert bench.breaks(*both) == Stop(Reason.BREAKPOINT, PLC, "BIT44 is set")
    bench.card.bit[43] = False  # SET leaves its flag
    assert bench.breaks(*both) is None


def test_the_output_is_the_coil_of_a_timer(bench: Bench) -> None:
    output = 1536 + 2 * 32 + 16
    bench.card.bit[45] = True
    began_tk = bench.card.lived_tk
    assert bench.breaks(LineBreakpoint(PLC, TIMER)) == Stop(
        Reason.BREAKPOINT, PLC, f"BIT{output} is set"
    )
    assert (bench.card.lived_tk - began_tk) * bench.card.period_s >= 0.005


def test_a_condition_is_asked_when_a_coil_changes(bench: Bench) -> None:
    rung = LineBreakpoint(PLC, OUT, "BIT41")
    bench.card.bit[40] = True
    assert bench.breaks(rung) is not None
    bench.card.bit[40] = False
    assert bench.breaks(rung) is None
    assert not bench.card.bit[41]


def test_a_scan_that_changes_two_coils_is_one_hit(bench: Bench) -> None:
    rung = LineBreakpoint(PLC, OUT, hits=3)
    for is_set in (True, False):
        bench.card.bit[40] = is_set
        assert bench.breaks(rung) is None
    bench.card.bit[40] = True
    assert bench.breaks(rung) is not None


def test_a_line_of_a_plc_can_print_instead_of_stopping(bench: Bench) -> None:
    bench.card.bit[40] = True
    assert bench.breaks(LineBreakpoint(PLC, OUT, log="lamp {BIT41}")) is None
    assert bench.shown == ["lamp -1\n"]


def test_the_present_line_and_its_flags_are_seen_where_it_has_stopped(bench: Bench) -> None:
    session = bench.session
    bench.card.bit[40] = True
    assert session.frames(PLC) == []
    assert bench.breaks(LineBreakpoint(PLC, OUT)) is not None
    (frame,) = session.frames(PLC)
    assert (frame.name, frame.line, Path(frame.path).name) == ("PLC0 line 30", 3, "plc0.8k")
    assert session.frames(OTHER) == []
    groups = {name: list(values) for name, values in session.scopes(PLC, 0)}
    assert [(each.name, each.text) for each in groups["Rung"]] == [("BIT41", "1"), ("BIT42", "0")]
    session.course.tick()
    assert session.frames(PLC) == []
    with pytest.raises(UserError, match="there is no program 16"):
        list(session.scopes(PLC, 0))


def test_reverse_continue_goes_back_to_the_scan(bench: Bench) -> None:
    bench.card.send("SET 40\r")
    stop = bench.breaks(LineBreakpoint(PLC, OUT))
    assert stop is not None
    there_tk = bench.card.lived_tk
    assert bench.session.course.run(50) is None
    assert bench.session.course.run_back() == stop
    assert bench.card.lived_tk == there_tk
    assert [each.line for each in bench.session.frames(PLC)] == [3]
    assert bench.session.course.run_back().reason is Reason.ENTRY


def test_a_line_without_a_coil_is_refused(bench: Bench) -> None:
    assert "no coil" in bench.session.why_no_stop((PLC, LOAD))
    assert "no coil" in bench.session.why_no_stop((PLC, SET - 5))  # no such line
    assert bench.session.why_no_stop((PLC, OUT)) == ""


def test_no_more_is_watched_than_the_engine_can(bench: Bench) -> None:
    flags = [DataBreakpoint(f"BIT{flag}") for flag in range(100, 193)]
    bench.session.course.set_data(flags)
    rung = LineBreakpoint(PLC, OUT)
    bench.session.course.set_lines([rung])
    with pytest.raises(UserError, match="96 values and coils to be watched: there is room for 95"):
        bench.session.course.set_data([*flags, DataBreakpoint("BIT99")])
    with pytest.raises(UserError, match="96 values and coils"):
        bench.session.course.set_lines([rung, LineBreakpoint(PLC, SET)])
    bench.card.bit[40] = True
    assert bench.session.course.run(10) == Stop(
        Reason.BREAKPOINT, PLC, "BIT41 is set, BIT42 is clear"
    )
