"""What the front end occupies on a card: each number once, each where the code has it."""

import pytest

from openacr.cnc.occupied import TABLE, Kind, Occupied
from openacr.sysvar import Store

WATCHDOG_CELL = 250_125


def test_the_table_has_every_number_once() -> None:
    assert [(row.shown, row.name) for row in TABLE] == [
        ("P90", "tool requested"),
        ("P91", "tool in the spindle"),
        ("P92", "spindle speed"),
        ("P93", "spindle state"),
        ("P94", "executing line"),
        ("P95", "run state"),
        ("P96", "heartbeat"),
        ("P97", "cause of a kill"),
        ("P98", "hold at"),
        ("BIT128 to BIT227", "relays"),
        ("BIT237 to BIT244", "drives to switch on"),
        ("BIT245", "ran short"),
        ("BIT246", "outputs at rest"),
        ("BIT247", "watchdog tripped"),
        ("BIT248 to BIT255", "homed axes"),
        ("PROG7", "watchdog"),
    ]


@pytest.mark.parametrize("first", [5, 9, 14])
def test_a_number_that_is_taken_is_refused(first: int) -> None:
    table = Occupied()
    table.reserve(Kind.FLAG, 9, "lamps", "of the door", 6)
    with pytest.raises(ValueError, match=f"BIT{first} to BIT{first + 4} horn: BIT9 to BIT14 is"):
        table.reserve(Kind.FLAG, first, "horn", "", 5)


@pytest.mark.parametrize(("kind", "first"), [(Kind.FLAG, 8), (Kind.FLAG, 15), (Kind.VARIABLE, 9)])
def test_a_number_beside_it_or_of_another_kind_is_free(kind: Kind, first: int) -> None:
    table = Occupied()
    table.reserve(Kind.FLAG, 9, "lamps", "of the door", 6)
    assert table.reserve(kind, first, "horn", "") == first
    assert len(list(table)) == 2


def test_the_watchdog_runs_in_the_program_of_the_table_by_default() -> None:
    (watchdog,) = (row for row in TABLE if row.kind is Kind.PROGRAM)
    assert Store().read(WATCHDOG_CELL) == watchdog.numbers[0]
