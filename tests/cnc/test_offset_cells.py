"""The cells of offsets and work systems: by name, by number, in a program, and in a new process."""

from pathlib import Path

import pytest
from tests.cnc.programs import made, run
from tests.cnc.test_many_blocks import done, require_same

from openacr.cnc.canonical import Line, Rapid
from openacr.cnc.interpreter.formulas_cy import MAY_WRITE
from openacr.cnc.interpreter.interpreter import Options
from openacr.cnc.interpreter.program_values import access
from openacr.sysvar import Store
from openacr.sysvar.lookup import one

CODES = ("G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2")
LETTERS = "XYZABCUV"
FIRST, LAST = 900, 999


@pytest.mark.req("MILL-OFS-PMAP-R")
def test_radius_n_is_p1000_plus_n_and_its_wear_p1500_plus_n() -> None:
    numbers = [*range(1, 400, 19), 400]
    assert [one(f"d radius {n}").number for n in numbers] == [1000 + n for n in numbers]
    assert [one(f"d wear {n}").number for n in numbers] == [1500 + n for n in numbers]
    for n in (1, 2, 257, 400):
        text = f"G41 D{n} G1 F10 X1 Y0\nY1\nY2\nG40 X0\nM2"
        lines = run(text, {1000 + n: 0.25, 1500 + n: 0.05}).of(Line)
        offset = [e.end[0] for e in lines if isinstance(e, Line)][1]
        assert offset == pytest.approx(1 - 0.3)


@pytest.mark.req("MILL-OFS-PMAP-H")
def test_length_n_is_p2000_plus_n_and_its_wear_p3000_plus_n() -> None:
    numbers = [*range(1, 999, 37), 999]
    assert [one(f"h length {n}").number for n in numbers] == [2000 + n for n in numbers]
    assert [one(f"h wear {n}").number for n in numbers] == [3000 + n for n in numbers]
    for n in (1, 2, 500, 999):
        done = run(f"G43 H{n} G0 Z1", {2000 + n: 0.25, 3000 + n: 0.05})
        assert [e.end[2] for e in done.of(Rapid) if isinstance(e, Rapid)][-1] == pytest.approx(1.3)


@pytest.mark.req("MILL-WCS-8", "MILL-WCS-PMAP")
def test_eight_work_systems_have_a_value_for_each_axis_and_keep_it(tmp_path: Path) -> None:
    path = tmp_path / "sysvar.db"
    wanted = {}
    with Store(path) as store:
        for system in range(1, 9):
            for axis, letter in enumerate(LETTERS):
                cell = one(f"work system {system} {letter}").number
                assert FIRST <= cell <= LAST
                wanted[cell] = system + axis / 8
                store.write(cell, wanted[cell])
    assert len(wanted) == 64
    with Store(path) as store:
        assert {cell: store.read(cell) for cell in wanted} == wanted
    for system, code in enumerate(CODES, start=1):
        done = run(f"{code}\nG0 X1 Y1 Z1", wanted)
        ends = [e.end for e in done.of(Rapid) if isinstance(e, Rapid)]
        assert ends[-1][:3] == pytest.approx([1 + system + axis / 8 for axis in range(3)])


@pytest.mark.parametrize("cell", [839, 840, 847, 848, 849])
def test_cells_about_the_ninth_system_are_the_same_in_a_loop_line_by_line(cell: int) -> None:
    passes = f"P200=0\nN1 P200=P200+1\nP{cell}=P200\nX(P200)\nIF P200<40 THEN GOTO 1\n"
    text = f"F10\nG59.2\n{passes}M2\n"
    single = done(text, "acromill", Options(collects_errors=True), is_slow=True)
    many = require_same(text, "acromill")
    assert many.p(cell) == single.p(cell) == 40


@pytest.mark.parametrize(("cell", "is_free"), [(833, True), (839, True), (840, False),
                                               (848, False), (849, True), (899, True)])  # fmt: skip
def test_cells_of_the_ninth_system_are_not_free(cell: int, is_free: bool) -> None:
    parameters = made("M2\n").interpreter.parameters
    assert parameters.is_free_cell(cell, is_hash=False) is is_free
    assert bool(access()[cell] & MAY_WRITE) is is_free
