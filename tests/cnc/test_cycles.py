"""Canned cycles, macros, probing and floating zeros."""

import re
from pathlib import Path

import pytest
from tests.cnc.programs import CYCLES, Bench, errors, made, run

from openacr.cnc.canonical import Orient, Probe, Spindle
from openacr.cnc.codes.table import DIALECTS
from openacr.cnc.interpreter.interpreter import Options
from openacr.cnc.loading import supplied
from openacr.cnc.loading.load import load
from openacr.cnc.loading.supplied import cycle_part
from openacr.cnc.reading.parser import parse

Z2 = (0.0, 0.0, 2.0)


@pytest.mark.req("MILL-CYC-LABELS")
def test_labels_of_the_supplied_cycles_begin_at_73000() -> None:
    labels = re.findall(
        r"^N(\d+)", Path(supplied.__file__).with_name("CYCLES.TXT").read_text(), re.M
    )
    assert min(int(label) for label in labels) == 73_000


def test_programs_may_not_jump_into_a_cycle() -> None:
    assert errors("GOTO 81000" + CYCLES) == ["E264"]
    assert errors("P200=81000\nGOTO (P200)" + CYCLES) == ["E264"]
    (found,) = made("X1 F10\nG65 P81000" + CYCLES).interpreter.program.errors
    assert (found.code, found.line, found.column) == ("E264", 2, 5)


def test_a_plane_change_ends_a_cycle_with_a_warning() -> None:
    done = run("G81 X1 Z-1 R0 F10\nG18\nX2" + CYCLES)
    assert "W213" in done.codes
    assert done.moves[3:] == ["L X2"]


@pytest.mark.req("MILL-CYC-DRYRUN")
def test_cycles_run_dry_without_the_spindle() -> None:
    done = run("M3\nG76 X1 Z-1 R.1 Q.2 P1 F10" + CYCLES, start=Z2, options=Options(is_dry=True))
    assert not done.of(Spindle)
    assert not done.of(Orient)
    assert "L X1.2 Z-1" in done.moves


def test_rotation_and_scale_act_on_holes_and_levels() -> None:
    text = "G68 X0 Y0 R90\nG51 X0 Y0 Z0 P2\nG81 X1 Z-1 R.5 F10" + CYCLES
    assert run(text, start=Z2).moves == ["R Y2 Z2", "R Y2 Z1", "L Y2 Z-2", "R Y2 Z2"]


def test_single_block_stops_at_every_hole() -> None:
    options = Options(has_block_ends=True)
    done = run("G91 G81 X1 Z-1 R0 L3 F10" + CYCLES, options=options)
    assert done.story.count("BlockEnd") == 4  # three holes and M2
    assert done.story[3] == "BlockEnd"


def test_the_users_own_cycles_come_first(tmp_path: Path) -> None:
    (tmp_path / "CYCLES.TXT").write_text("N81000 G1 Z(P252)\nRET\n")
    (tmp_path / "P.NC").write_text("G81 X1 Z-1 R0 F10" + CYCLES)
    from tests.cnc.programs import made

    done = made("M2")
    program = load(tmp_path / "P.NC", done.cells)
    interpreter = type(done.interpreter)(program, done.cells, Bench())
    kinds = [type(e).__name__ for e in interpreter.entries()]
    assert kinds == ["Rapid", "Line", "End"]


# --- macros -------------------------------------------------------------------------------


def test_locals_come_back_after_a_call() -> None:
    text = (
        "G65 P5 X1\nM2\nN5 #1=#1+10\nG65 P6 X99\nP200=#1\nGOSUB 7\nRET\n"
        "N6 #1=5\nRET\nN7 P201=#1\nRET"
    )
    done = run(text)
    assert (done.p(200), done.p(201)) == (11, 11)


@pytest.mark.parametrize(
    ("text", "code"),
    [("G65 X1", "E222"), ("G65 P5 L0", "E222"), ("G65 P9", "E220"), ("G1 G65 P5", "E201"),
     ("G65 P5 P6", "E202")],
)  # fmt: skip
def test_calls_need_their_label(text: str, code: str) -> None:
    assert errors(text + "\nM2\nN5 RET") == [code]


# --- G31 ----------------------------------------------------------------------------------


def tripped(x: float, y: float = 0.0) -> Bench:
    return Bench(trip=(x, y, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))


@pytest.mark.req("MILL-G31-STORE", "MILL-G31-USE")
def test_the_trip_is_stored_in_machine_coordinates() -> None:
    text = "G21 F10 G31 X100\nP200=P101 P201=P330 P202=P329\nG10 L2 P1 X#101\nG0 X0"
    done = run(text, {910: 1.0}, machine=tripped(3.0))
    assert done.p(200) == pytest.approx(3 * 25.4)
    assert done.p(201) == pytest.approx(2 * 25.4)
    assert done.p(202) == 1
    assert done.p(910) == pytest.approx(3.0)
    assert done.moves[-1] == "R X3"


def test_all_eight_axes_of_the_trip_are_stored() -> None:
    where = (0.75, 0.5, -1.0, 90.0, 10.0, -20.0, 4.0, 0.125)
    done = run("G31 F10 X1\nP200=P101", axes=8, machine=Bench(trip=where))
    assert [done.p(number) for number in range(101, 109)] == list(where)


def test_a_probe_input_is_needed() -> None:
    class NoProbe(Bench):
        def has_probe(self) -> bool:
            return False

    assert errors("G31 X1", machine=NoProbe()) == ["E243"]


def test_the_probe_runs_at_feed_to_rest() -> None:
    (probe,) = run("F10 G31 X1").of(Probe)
    assert isinstance(probe, Probe)
    assert probe.pace.feed_upm == 10
    assert probe.pace.mode.value == "G61"


# --- floating zero --------------------------------------------------------------------------


def test_g92_keeps_what_was_there_before() -> None:
    done = run("G0 X2\nG92 X5\nG0 X6\nG92 X0", {801: 1.0})
    assert done.moves == ["R X3", "R X4"]
    assert (done.p(801), done.p(809), done.p(817), done.p(825)) == (4, 0, -2, 4)


def test_g92_reads_right_under_scaling_and_rotation() -> None:
    done = run("F10 G51 X0 Y0 Z0 P2\nX1\nG92 X5\nX6")
    assert done.moves == ["L X2", "L X4"]
    done = run("F10 G68 X0 Y0 R90\nX1\nG92 X5 Y0\nX6")
    assert done.moves == ["L Y1", "L Y2"]


@pytest.mark.parametrize(
    ("text", "warnings"),
    [
        ("G0 Z.5\nG98 G81 X1 Z-1 R1", ["G98 level below R: 0.5 of R 1"]),
        ("G0 Z.5\nG99 G81 X1 Z-1 R1\nX2\nG98 X3", ["G98 level below R: 0.5 of R 1"]),
        ("G0 Z1\nG98 G81 X1 Z-1 R1", []),
        ("G0 Z.5\nG99 G81 X1 Z-1 R1", []),
        ("G0 Z-.5\nG91 G98 G81 X1 Z-1 R.25", ["G98 level below R: -0.5 of R -0.25"]),
        ("G0 Z1\nG98 G81 X1 Z-1 R.5\nX2 R2", ["G98 level below R: 1 of R 2"]),
    ],
)
def test_a_path_between_holes_that_is_deeper_than_r_is_doubted(
    text: str, warnings: list[str]
) -> None:
    done = run(f"F10\n{text}{CYCLES}")
    found = [each for each in done.interpreter.warnings if each.code == "W219"]
    assert [each.text for each in found] == warnings
    assert all(each.hint == "the cycle began below R" for each in found)


def test_other_controls_go_up_to_r_and_need_no_doubt() -> None:
    done = run("F10\nG0 Z.5\nG98 G81 X1 Z-1 R1", dialect="rs274ngc")
    assert "W219" not in done.codes


def test_the_labels_of_the_supplied_cycles_are_those_the_parser_finds() -> None:
    part = cycle_part()
    lines = Path(supplied.__file__).with_name("CYCLES.TXT").read_text().splitlines()
    parsed = {
        block.label: line
        for line, raw in enumerate(lines, 1)
        if (block := parse(raw, DIALECTS["acromill"].grammar)).label is not None
    }
    assert len(parsed) > 12
    found = {label: part.labels.get(label) for label in parsed}
    assert {label: place.line for label, place in found.items() if place} == parsed
