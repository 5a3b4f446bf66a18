"""Part programs and the store: what one writes the other reads, and what survives."""

import math
from pathlib import Path

import pytest
from tests.cnc.programs import errors, made, run

from openacr.cnc.canonical import Line, Stop
from openacr.cnc.interpreter.interpreter import Interpreter
from openacr.cnc.loading.load import load
from openacr.cnc.reading.findings import BlockError
from openacr.cnc.state.hosts import VirtualMachine
from openacr.sysvar import Store


def interpreter(text: str, store: Store) -> Interpreter:
    program = load(text, store)
    assert not program.errors
    return Interpreter(program, store, VirtualMachine())


def finished(text: str, store: Store) -> None:
    for _ in interpreter(text, store).entries():
        pass


# --- cells ------------------------------------------------------------------------------


@pytest.mark.req("MILL-P-OUTOFRANGE")
@pytest.mark.parametrize("n", [20_488, 30_000, 99_999, 100_007, 1_003_425, 2_000_000])
def test_a_parameter_outside_all_ranges_is_an_error(n: int) -> None:
    assert errors(f"P150=P{n}") == ["E211"]
    assert errors(f"P{n}=1") == ["E211"]
    assert errors(f"P150={n}\nP151=P(P150)") == ["E211"]


@pytest.mark.parametrize(
    ("line", "found"),
    [
        ('INPUT "depth", P20500', "E211 parameter number out of range: P20500"),
        ('INPUT "depth", P240', "E212 parameter is read only: P240"),
        ("IF P150=1 THEN GOTO (P20500)", "E211 parameter number out of range: P20500"),
        ("GOSUB (P20500)", "E211 parameter number out of range: P20500"),
        ("PRINT P20500", "E211 parameter number out of range: P20500"),
    ],
)
def test_numbers_in_statements_are_checked_when_a_program_is_loaded(line: str, found: str) -> None:
    (finding,) = made(f"M2\n{line}").interpreter.program.errors
    assert f"{finding.code} {finding.text}" == found
    assert finding.line == 2


@pytest.mark.req("MILL-P-34-99")
@pytest.mark.parametrize("n", [33, 34, 89, 90, 99, 100])
def test_the_internal_cells_are_p34_to_p99(n: int) -> None:
    done = made(f"P{n}=1")
    refused = [error.code for error in done.interpreter.program.errors]
    if refused:
        assert (n, refused) in [(90, ["E212"]), (99, ["E212"])]  # the machine writes these
        return
    assert run(f"P{n}=1").codes == (["W220"] if 34 <= n <= 99 else [])


def test_cells_that_show_the_state_and_system_parameters_are_read_only() -> None:
    for n in (234, 243, 246, 1000, 1500, 2000, 3000, 650_002):
        assert errors(f"P{n}=1") == ["E212"]
    assert errors("P245=1") == []


def test_a_value_the_store_refuses_stops_the_program_before_its_block() -> None:
    store = Store()
    moves = []
    with pytest.raises(BlockError) as refusal:
        for entry in interpreter("F10 G1 X1\nP150=9\nP328=P150*100 X2", store).entries():
            moves.append(entry)
    assert refusal.value.finding.code == "E222"
    assert "P328 Intermediate mask cannot be 900" in str(refusal.value)
    assert len(moves) == 1
    assert store.read(328) == 0


# --- tool offsets -----------------------------------------------------------------------


@pytest.mark.req("MILL-OFS-RW-LIVE")
def test_a_wear_changed_in_production_holds_from_the_next_use_of_the_tool(tmp_path: Path) -> None:
    path = tmp_path / "s.db"
    with Store(path) as operator, Store(path) as store:
        operator.write(1001, 0.25)
        entries = interpreter("F10 D1\nG41 G1 X1\nX2\nX3\nG40 X4 Y0\nM0\n"
                              "D1\nG41 G1 X5\nX6\nX7\nG40 X8 Y0\nM2", store).entries()  # fmt: skip
        heights = []
        for entry in entries:
            if isinstance(entry, Stop):
                operator.write(1501, 0.0625)
            if isinstance(entry, Line):
                heights.append(round(entry.end[1], 9))
        assert heights == [0.25, 0.25, 0.25, 0.0, 0.3125, 0.3125, 0.3125, 0.0]
        assert operator.read(1001) == 0.25


# --- work systems and floating zero -------------------------------------------------------


@pytest.mark.req("MILL-ZERO-PARAM", "MILL-ZERO-FLZ")
def test_a_floating_zero_is_visible_and_survives_a_restart(tmp_path: Path) -> None:
    path = tmp_path / "s.db"
    with Store(path) as store:
        finished("G0 X3 Y2\nG92 X0.5 Y0\nM2", store)
    with Store(path) as store:
        assert [store.read(n) for n in (800, 801, 802, 809, 810)] == [1, 2.5, 2, 0.5, 0]
        ends = [entry.end[:2] for entry in interpreter("G0 X1 Y1", store).entries()
                if hasattr(entry, "end")]  # fmt: skip
        assert ends == [(3.5, 3.0)]


# --- how programs begin -------------------------------------------------------------------


@pytest.mark.req("MILL-SYS-DISP-MODE")
def test_control_mode_is_the_unit_programs_begin_in() -> None:
    assert run("F10 X25.4").ends == [(25.4, 0, 0)]
    for is_start_set_chosen in (0.0, 1.0):  # the start unit of a chosen set is at first this one
        cells = {100_010: is_start_set_chosen, 850_030: 21.0}
        assert run("F10 X25.4", cells).ends == [(1, 0, 0)]
    for mode, feed in ((20.0, 10.0), (21.0, 10.0 / 25.4)):
        (line,) = run("F10 X1", {850_030: mode}).of(Line)
        assert isinstance(line, Line)
        assert line.pace.feed_upm == pytest.approx(feed)
        for word in ("G20", "G21"):  # what a program says of itself comes first
            both = [run(f"{word} F10 X25.4", {850_030: each}).ends for each in (20.0, 21.0)]
            assert both[0] == both[1]
    in_mm = {250_001: 1.0}
    assert run("F10 X1", in_mm | {850_030: 20.0}).ends == [(25.4, 0, 0)]
    assert run("F10 X1", in_mm | {850_030: 21.0}).ends == [(1, 0, 0)]


@pytest.mark.req("MILL-SYS-CTL-UNITS")
def test_default_units_are_those_of_positions_and_of_all_stored_lengths() -> None:
    inch, metric = Store(), Store(is_metric=True)
    assert not inch.is_metric
    for store, x in ((inch, 1.0), (metric, 25.4)):
        store.write(910, 2.0)  # two units, whichever they are
        (end,) = [entry.end[0] for entry in interpreter("G20 F10 G1 X1", store).entries()
                  if isinstance(entry, Line)]  # fmt: skip
        assert end == x + 2.0


@pytest.mark.req("MILL-SYS-AXES-NAME")
def test_an_axis_is_programmed_by_its_name() -> None:
    shadow = made("", axes=3).cells
    assert [shadow.read_text(200_008 + 1000 * axis) for axis in range(8)] == list("XYZABCUV")
    store = Store()
    with store.transaction():
        store.write_text(202_008, "A")
        store.write_text(203_008, "Z")
    (end,) = [entry.end for entry in interpreter("F10 G1 A5", store).entries()
              if isinstance(entry, Line)]  # fmt: skip
    assert end[2] == 5.0
    assert [found.code for found in load("G1 Z1", store).errors] == ["E207"]
    with pytest.raises(Exception, match="P200008 already has that name"):
        store.write_text(201_008, "X")
    with pytest.raises(Exception, match="one of X, Y, Z, A, B, C, U, V"):
        store.write_text(201_008, "Q")


def test_angles_in_programs_are_degrees_and_cells_plain_numbers() -> None:
    done = run("P150=SIN(30)\nG21\nP151=1\nF10 G1 XP151")
    assert done.p(150) == 0.5
    assert math.isclose(done.ends[0][0], 1 / 25.4, abs_tol=1e-9)


def test_cycles_count_in_their_cells_without_waiting_for_rest() -> None:
    done = run("G90 G83 X1 Z-1 R.1 Q.3 F10\nM2\n$I CYCLES.TXT\n", start=(0, 0, 2))
    assert [type(entry).__name__ for entry in done.entries].count("Sync") == 0
    assert len(done.moves) == 13


def test_a_file_that_is_cut_off_while_it_is_in_use_stops_the_program(tmp_path: Path) -> None:
    path = tmp_path / "P.NC"
    path.write_text("F10 X1\n" + "(a remark)\n" * 200_000 + "X2\nM2\n")
    done = made(path)
    path.write_text("F10 X1\n")
    with pytest.raises(BlockError, match=r"P.NC:1:1: E262 the file has become shorter"):
        list(done.interpreter.entries())


@pytest.mark.parametrize(
    "block",
    ["G92 X1 Y1 Z1", "G54 G52 X1 Y1", "D3", "H3", "G31 X1", "G81 X1 Z-1 R-.5", "P200=1"],
)
def test_what_belongs_together_is_one_commit(block: str, tmp_path: Path) -> None:
    with Store(tmp_path / "s.db") as store:
        for n in (1003, 1503, 2003, 3003):
            store.write(n, 0.5)
        store.write(700_006, 1.0)  # cycles without $I

        def commits(text: str) -> int:
            finished("M2", store)
            before = store.token
            for entry in interpreter(text, store).entries():
                if isinstance(entry, Stop):
                    return store.token - before
            raise AssertionError(text)

        assert commits(f"{block}\nM0") == commits("M0") + 1
