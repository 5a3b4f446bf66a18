"""The tool table: which tools it has, and what it says of each."""

import pytest

from openacr.mill.config.tools import MOST_TOOLS, Tip, Tool, ToolTable, radius_u
from openacr.sysvar import Store
from openacr.sysvar.tabs import CELLS, TOOL


def test_a_tool_is_there_when_its_radius_its_length_or_a_wear_is_entered() -> None:
    with Store() as cells:
        table = ToolTable(cells)
        assert table.read() == ()
        cells.write(CELLS.h_length[999], 10.0)
        cells.write(CELLS.d_radius[1], 3.0)
        cells.write(CELLS.d_wear[1], -0.125)
        cells.write(TOOL.tip[1], 1)
        cells.write(CELLS.h_wear[2], 0.25)
        cells.write(CELLS.d_wear[3], 0.5)
        cells.write(TOOL.tip[4], 1)
        cells.write(CELLS.d_radius[400], 8.0)
        assert table.read() == (
            Tool(1, 2.875, None, Tip.BALL, radius_wear_u=-0.125),
            Tool(2, None, 0.25, Tip.FLAT, length_wear_u=0.25),
            Tool(3, 0.5, None, Tip.FLAT, radius_wear_u=0.5),
            Tool(400, 8.0, None, Tip.FLAT),
            Tool(999, None, 10.0, Tip.FLAT),
        )
        assert MOST_TOOLS == 999


def test_a_table_follows_what_is_stored_after_it_was_read() -> None:
    with Store() as cells:
        table = ToolTable(cells)
        cells.write(CELLS.h_length[5], 40.0)
        cells.write(CELLS.h_wear[5], 0.5)
        assert table.read() == (Tool(5, None, 40.5, Tip.FLAT, 0.0, 0.5),)
        assert table.read() == (Tool(5, None, 40.5, Tip.FLAT, 0.0, 0.5),)
        cells.write(TOOL.tip[5], 1)
        assert table.read() == (Tool(5, None, 40.5, Tip.BALL, 0.0, 0.5),)
        cells.write(CELLS.h_length[5], 0.0)
        assert table.read() == (Tool(5, None, 0.5, Tip.BALL, 0.0, 0.5),)
        cells.write(CELLS.h_wear[5], 0.0)
        assert table.read() == ()


@pytest.mark.parametrize(("number", "radius"), [(0, 0.0), (1, 2.5), (400, 1.0), (401, 0.0)])
def test_the_radius_of_a_tool_outside_the_table_is_0(number: int, radius: float) -> None:
    with Store() as cells:
        cells.write(CELLS.d_radius[1], 2.0)
        cells.write(CELLS.d_wear[1], 0.5)
        cells.write(CELLS.d_radius[400], 1.0)
        assert radius_u(cells.read, number) == radius
