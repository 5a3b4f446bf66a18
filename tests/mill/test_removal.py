"""Stock removal of whole programs: cutters, lengths, the blank, lines with something wrong."""

import re

import numpy as np
import pytest

from openacr.cnc.loading.load import load
from openacr.errors import UserError
from openacr.mill.plan.pictures.removal import Removal, removal
from openacr.mill.plan.pictures.stock import Mark
from openacr.sysvar import Store
from openacr.sysvar.tabs import CELLS, CONTROL, GENERAL, TOOL

SIZES = (CONTROL.x_axis_cutting_size, CONTROL.y_axis_cutting_size, CONTROL.z_axis_cutting_size)
HOME = "G0 X1 Y1 Z5\nG0 X0 Y0\n"  # after this a rapid comes from a known place


@pytest.fixture
def store() -> Store:
    cells = Store(is_metric=True)
    cells.write(CONTROL.default_units, 1)
    cells.write(CELLS.d_radius[1], 2.0)
    cells.write(CELLS.d_radius[2], 3.0)
    return cells


def cut(store: Store, text: str) -> Removal:
    return removal(load("G21 F100\n" + text, store), store, "acromill")


def height(found: Removal, x: float, y: float) -> float:
    """The height of the material at a place."""
    stock = found.stock
    column = int((x - stock.blank.low[0]) / stock.cell)
    row = int((y - stock.blank.low[1]) / stock.cell)
    return float(stock.heights[row, column])


def test_a_blank_is_as_large_as_what_is_cut_with_its_top_at_program_zero(store: Store) -> None:
    found = cut(store, f"{HOME}D1 G1 Z-3\nX20 Y10\nG0 Z5\nM2\n")
    assert found.stock.blank.low == (-2.0, -2.0, -3.0)
    assert found.stock.blank.high == (22.0, 12.0, 0.0)
    assert found.stock.cell == 24.0 / 500
    assert (height(found, 10, 5), height(found, 0, 10)) == (-3.0, 0.0)
    assert (found.rapid_lines, found.below_lines) == ((), ())


def test_program_zero_is_the_bottom_where_all_cuts_are_above(store: Store) -> None:
    found = cut(store, f"{HOME}D1 G1 Z4\nX20\nZ9\nG0 Z20\nM2\n")
    assert (found.stock.blank.low[2], found.stock.blank.high[2]) == (0.0, 9.0)
    store.write(SIZES[2], 12.0)
    found = cut(store, f"{HOME}D1 G1 Z4\nX20\nZ9\nG0 Z20\nM2\n")
    assert (found.stock.blank.low[2], found.stock.blank.high[2]) == (0.0, 12.0)


def test_sizes_of_the_store_are_those_of_the_blank_around_the_middle_of_what_is_cut(
    store: Store,
) -> None:
    for cell, size in zip(SIZES, (40.0, 30.0, 2.0), strict=True):
        store.write(cell, size)
    found = cut(store, f"{HOME}D1 G1 Z-3\nX20 Y10\nG0 Z5\nM2\n")
    assert found.stock.blank.low == (-10.0, -10.0, -2.0)
    assert found.stock.blank.high == (30.0, 20.0, 0.0)
    assert found.below_lines == (4, 5)
    assert found.stock.heights.min() == -2.0


def test_the_zero_of_the_work_system_moves_the_blank(store: Store) -> None:
    store.write(CELLS.work_systems[0][0], 100.0)
    store.write(CELLS.work_systems[0][0] + 2, -50.0)
    found = cut(store, f"{HOME}D1 G1 Z-3\nX20\nG0 Z5\nM2\n")
    assert (found.stock.blank.low[0], found.stock.blank.high[2]) == (98.0, -50.0)


def test_the_zero_is_that_of_the_work_system_of_the_first_cut(store: Store) -> None:
    store.write(CELLS.work_systems[1][2], -50.0)
    store.write(CELLS.h_length[1], 7.0)
    found = cut(store, "G0 X1 Y1 Z5\nG55 G43 H1\nG0 X0 Y0 Z5\nD1 G1 Z-3\nX20\nG54 X30\nM2\n")
    assert found.stock.blank.high[2] == -50.0


def test_a_rapid_in_material_is_named_by_its_line(store: Store) -> None:
    found = cut(store, f"{HOME}D1 G1 Z-3\nX20\nG0 Y10\nZ5\nM2\n")
    assert found.rapid_lines == (6,)
    assert (found.stock.marks == Mark.RAPID).any()


def test_a_rapid_from_where_the_machine_is_at_the_start_is_not_judged(store: Store) -> None:
    store.write(CELLS.work_systems[0][0] + 2, 50.0)  # the start, machine 0, lies below program 0
    found = cut(store, "G0 X5 Y5\nZ5\nD1 G1 Z-3\nX20\nG0 Z5\nM2\n")
    assert found.rapid_lines == ()


@pytest.mark.parametrize(
    ("text", "radius"),
    [
        ("D2", 3.0),  # in force
        ("T2 M6", 3.0),  # of the tool's number, where no D is
        ("T2 M6\nD1", 2.0),
    ],
)
def test_the_radius_is_that_of_d_in_force_else_of_the_number_of_the_tool(
    store: Store, text: str, radius: float
) -> None:
    found = cut(store, f"{HOME}{text}\nG1 Z-3\nX20\nG0 Z5\nM2\n")
    assert found.stock.blank.low[0] == -radius


def test_the_radius_of_programs_without_d_is_cmp_rad(store: Store) -> None:
    store.write(GENERAL.cmp_rad, 1.5)
    found = cut(store, f"{HOME}T2 M6\nG1 Z-3\nX20\nG0 Z5\nM2\n")
    assert found.stock.blank.low[0] == -1.5


def test_wear_is_part_of_the_radius(store: Store) -> None:
    store.write(CELLS.d_wear[1], -0.5)
    found = cut(store, f"{HOME}D1\nG1 Z-3\nX20\nG0 Z5\nM2\n")
    assert found.stock.blank.low[0] == -1.5


def test_lengths_of_tools_do_not_count_in_the_heights_of_the_material(store: Store) -> None:
    store.write(CELLS.h_length[1], 70.0)
    found = cut(store, f"{HOME}D1 G1 Z-3\nX20\nG0 Z9\nG43 H1\nD2 G0 X30\nG1 Z-5\nX40\nG0 Z9\nM2\n")
    assert height(found, 10.0, 0.0) == -3.0
    assert height(found, 35.0, 0.0) == -5.0
    assert found.stock.blank.high[2] == 0.0


def test_the_tip_of_a_tool_is_that_of_the_store(store: Store) -> None:
    store.write(TOOL.tip[2], 1)
    found = cut(store, f"{HOME}T2 M6\nG1 Z-3\nX20\nG0 Z5\nM2\n")
    y = 1.5
    row = int((y - found.stock.blank.low[1]) / found.stock.cell)
    middle = found.stock.blank.low[1] + found.stock.cell * (row + 0.5)
    assert height(found, 10.0, y) == pytest.approx(-3.0 + 3.0 - np.sqrt(9.0 - middle**2))


def test_what_cannot_be_computed_is_refused_with_the_reason(store: Store) -> None:
    refusals = {
        f"{HOME}T7 M6\nG1 Z-3\nM2\n": "the radius of T7 is not known: D7 of the offsets is 0",
        f"{HOME}G1 Z-3\nM2\n": (
            "the radius of the tool is not known: no D is in force, and CMP RAD is 0"
        ),
        f"{HOME}M2\n": "the program cuts nothing",
    }
    for text, reason in refusals.items():
        with pytest.raises(UserError, match=f"^{re.escape(reason)}$"):
            cut(store, text)
    with pytest.raises(UserError, match=r"^the program has errors: "):
        cut(store, "G1 X(\n")


def test_the_share_that_is_done_rises_to_the_whole(store: Store) -> None:
    shares: list[float] = []
    text = f"G21 F100\n{HOME}D1 G1 Z-3\nX20\nD2\nX0\nG0 Z5\nM2\n"
    removal(load(text, store), store, "acromill", shares.append)
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
