"""Names of rows: `SPEEDS.cut_speed` is the number of a cell, `AXIS.name` the range of several."""

import pytest

from openacr.sysvar import tabs
from openacr.sysvar.lookup import known
from openacr.sysvar.schema import AXES, Tab
from openacr.sysvar.tabs import AXIS, CELLS, CONTROL, FOV, JOG, MESSAGES, OFFSETS, SPEEDS, TABS

NAMESPACES = [
    getattr(tabs, name)
    for name in tabs.__all__
    if name.isupper() and name not in ("TABS", "TAB_CELLS")
]


def _ranges(value: object) -> list[range]:
    if isinstance(value, int):
        return [range(value, value + 1)]
    if isinstance(value, range):
        return [value]
    return [each for each in value if isinstance(each, range)] if isinstance(value, tuple) else []


def test_a_row_with_one_cell_is_its_number() -> None:
    assert SPEEDS.cut_speed == 650_002
    assert CONTROL.acute_angle2 == 250_011
    assert (FOV.switch, FOV.click) == (450_016, 450_017)
    assert type(SPEEDS.cut_speed) is int  # as fast to read as a number


def test_a_row_with_several_cells_is_their_range() -> None:
    assert [AXIS.pulses_per_unit[a] for a in (0, 1, 7)] == [200_006, 201_006, 207_006]
    assert [JOG.increments[k][1] for k in (0, 4)] == [351_006, 351_010]
    assert (OFFSETS.backlash[2], OFFSETS.fixtures[3][1]) == (950_002, 952_023)
    assert (MESSAGES.bit[0], MESSAGES.bit[2]) == (1_000_001, 1_000_215)
    assert (CELLS.h_length[0], CELLS.h_length[7], CELLS.h_length[-1]) == (2000, 2007, 2999)
    assert (CELLS.work_systems[0][0], CELLS.work_systems[7][2]) == (910, 982)


def test_a_cell_that_a_row_does_not_have_is_refused() -> None:
    with pytest.raises(IndexError):
        AXIS.pulses_per_unit[AXES]
    with pytest.raises(IndexError):
        CELLS.d_radius[401]


def test_the_tabs_are_all_there_with_their_names() -> None:
    held = {each.tab for each in NAMESPACES}
    assert held == {*TABS, CELLS.tab}


@pytest.mark.parametrize("namespace", NAMESPACES, ids=lambda each: each.tab.name)
def test_names_mean_cells_of_one_row_of_their_own_tab(namespace: type[SPEEDS]) -> None:
    tab: Tab = namespace.tab
    for name, value in vars(namespace).items():
        for numbers in _ranges(value) if not name.startswith("_") else ():
            assert {known(n).tab for n in numbers} == {tab.name}, name
            rows = {known(n).row.k for n in numbers if not known(n).row.is_fixed}
            assert len(rows) <= 1, name


@pytest.mark.parametrize("tab", TABS, ids=lambda each: each.name)
def test_every_cell_of_the_system_parameters_has_a_name(tab: Tab) -> None:
    namespace = next(each for each in NAMESPACES if each.tab is tab)
    named = {n for value in vars(namespace).values() for each in _ranges(value) for n in each}
    unnamed = [
        row.name for row in tab.rows if tab.base + row.k not in named and "reserved" not in row.name
    ]
    assert unnamed == []
