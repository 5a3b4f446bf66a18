"""The cells of offsets and work systems: by name, by number, in a program, and in a new process."""

from pathlib import Path

import pytest
from tests.cnc.programs import run

from openacr.cnc.canonical import Line, Rapid
from openacr.sysvar import Store
from openacr.sysvar.lookup import one

CODES = ("G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2")
LETTERS = "XYZABCUV"
FIRST, LAST = 900, 999


@pytest.mark.req("MILL-OFS-PMAP-R")
def test_radius_n_is_p1000_plus_n_and_its_wear_p1500_plus_n() -> None:
    numbers = range(1, 401)
    assert [one(f"d radius {n}").number for n in numbers] == [1000 + n for n in numbers]
    assert [one(f"d wear {n}").number for n in numbers] == [1500 + n for n in numbers]
    for n in (1, 2, 257, 400):
        text = f"G41 D{n} G1 F10 X1 Y0\nY1\nY2\nG40 X0\nM2"
        lines = run(text, {1000 + n: 0.25, 1500 + n: 0.05}).of(Line)
        offset = [e.end[0] for e in lines if isinstance(e, Line)][1]
        assert offset == pytest.approx(1 - 0.3)


@pytest.mark.req("MILL-OFS-PMAP-H")
def test_length_n_is_p2000_plus_n_and_its_wear_p3000_plus_n() -> None:
    numbers = range(1, 1000)
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
