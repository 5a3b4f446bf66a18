"""The rows in the memory of an interpreter."""

from openacr.cnc.rows import holes, modes, plans, points, results, runs, scans, values
from openacr.cnc.rows.room import Memory, Room

ROWS = (scans, modes, points, holes, runs, plans, values, results)


def test_doubles_and_integers_share_no_byte() -> None:
    room = Room(4)
    assert room.reals(2) == range(1, 3)  # bytes 8 to 24
    assert room.whole() == 6
    assert room.real() == 4  # bytes 32 to 40, as a double begins at a multiple of 8
    assert room.wholes(3) == range(10, 13)
    assert room.end == 52


def test_the_rows_of_a_module_begin_where_those_of_the_one_before_end() -> None:
    first = [
        (modes.state[0], 4),
        (points.position_u[0], 8),
        (holes.initial_u, 8),
        (runs.letter_of[0], 4),
        (plans.limit[0], 8),
        (values.stack[0], 8),
        (results.end_u[0], 8),
    ]
    for before, (place, size) in zip(ROWS, first, strict=False):
        assert before.SIZE <= place * size < before.SIZE + size


def test_a_memory_ends_with_a_whole_double_and_both_views_show_its_bytes() -> None:
    memory = Memory(12)
    assert (len(memory.F), len(memory.I)) == (2, 4)
    memory.reals(range(1, 2))[0] = 1.0
    assert memory.wholes(range(2, 4)).tolist() == [0, 0x3FF00000]
