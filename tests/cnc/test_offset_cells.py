"""The cells of offsets and work systems: by name, by number, in a program, and in a new process."""

from pathlib import Path

import pytest
from tests.cnc.programs import made
from tests.cnc.test_many_blocks import done, require_same

from openacr.cnc.interpreter.by_line.program_values import access
from openacr.cnc.interpreter.interpreter import Options
from openacr.cnc.rows.values import MAY_WRITE
from openacr.sysvar import Store
from openacr.sysvar.lookup import one

LETTERS = "XYZABCUV"
FIRST, LAST = 900, 999


@pytest.mark.parametrize(
    ("name", "before", "last"),
    [
        ("d radius", 1000, 400),
        ("d wear", 1500, 400),
        ("h length", 2000, 999),
        ("h wear", 3000, 999),
    ],
)  # fmt: skip
def test_the_name_of_an_offset_has_its_number(name: str, before: int, last: int) -> None:
    numbers = [*range(1, last, 37), last]
    assert [one(f"{name} {n}").number for n in numbers] == [before + n for n in numbers]


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
