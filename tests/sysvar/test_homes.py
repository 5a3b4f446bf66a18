"""Every P number has one home, and the store has a row for every number it hosts."""

from itertools import pairwise

import pytest

from openacr.sysvar import Host, Writer, home_of, parameter
from openacr.sysvar.homes import BEYOND, HOMES, LAST_SYSTEM
from openacr.sysvar.lookup import parameters
from openacr.sysvar.schema import FIRST_SYSTEM
from openacr.sysvar.tabs import CELLS, TAB_CELLS, TABS


def test_the_ranges_follow_each_other_without_gap() -> None:
    assert (HOMES[0].first, HOMES[-1].last) == (-BEYOND, BEYOND)
    for before, after in pairwise(HOMES):
        assert after.first == before.last + 1


def test_every_cell_the_map_gives_to_the_store_has_a_row() -> None:
    for n in range(4096):
        assert (home_of(n).host is Host.STORE) == (parameter(n) is not None), n


def test_tab_t_starts_at_100000_plus_50000_t() -> None:
    assert [tab.base for tab in TABS] == [FIRST_SYSTEM + TAB_CELLS * t for t in range(19)]
    assert max(found.number for found in parameters()) == LAST_SYSTEM
    assert min(found.number for found in parameters()) == 100
    assert CELLS.tab.base == 0


@pytest.mark.parametrize(
    ("first", "last", "host", "writer"),
    [
        (0, 33, Host.CARD, Writer.PROGRAM),
        (34, 89, Host.CARD, Writer.WARNED),
        (90, 99, Host.CARD, Writer.NONE),
        (100, 233, Host.STORE, Writer.PROGRAM),
        (234, 244, Host.STORE, Writer.NONE),
        (245, 245, Host.STORE, Writer.PROGRAM),
        (246, 248, Host.STORE, Writer.NONE),
        (249, 270, Host.STORE, Writer.PROGRAM),
        (271, 279, Host.STORE, Writer.WARNED),
        (280, 317, Host.STORE, Writer.PROGRAM),
        (318, 399, Host.STORE, Writer.WARNED),
        (400, 999, Host.STORE, Writer.PROGRAM),
        (1000, 1000, Host.STORE, Writer.NONE),
        (1001, 1499, Host.STORE, Writer.PROGRAM),
        (1500, 1500, Host.STORE, Writer.NONE),
        (1501, 1999, Host.STORE, Writer.PROGRAM),
        (2000, 2000, Host.STORE, Writer.NONE),
        (2001, 2999, Host.STORE, Writer.PROGRAM),
        (3000, 3000, Host.STORE, Writer.NONE),
        (3001, 4095, Host.STORE, Writer.PROGRAM),
        (4096, 20_487, Host.LIVE, Writer.CARD),
        (20_488, 99_999, Host.NONE, Writer.NONE),
    ],
)
def test_a_range_of_the_map(first: int, last: int, host: Host, writer: Writer) -> None:
    for n in (first, (first + last) // 2, last):
        assert (home_of(n).host, home_of(n).writer) == (host, writer)


@pytest.mark.parametrize("n", [-1, 20_488, 99_999, 100_007, 250_015, 150_010, 1_003_425, 10**12])
def test_a_number_without_a_cell_is_refused_when_read_and_written(n: int) -> None:
    assert home_of(n).read_error == "E211"
    assert home_of(n).write_error() == "E211"
    assert home_of(n).write_error(is_service=True) == "E211"


def test_system_parameters_are_written_with_the_service_role_only() -> None:
    home = home_of(250_101)
    assert (home.read_error, home.write_error(), home.write_error(is_service=True)) == (
        None,
        "E212",
        None,
    )
    assert home_of(100_000).write_error(is_service=True) == "E212"  # the layout version
    assert home_of(1_003_424).write_error(is_service=True) == "E212"  # a count


def test_texts_have_no_value_in_expressions() -> None:
    assert home_of(100_002).read_error == "E211"


def test_reserved_cells_warn() -> None:
    assert home_of(40).write_warning == "W220"
    assert home_of(40).write_error() is None
    assert home_of(33).write_warning is None
    assert home_of(95).write_error() == "E212"
