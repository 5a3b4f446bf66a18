"""DIM, CLEAR and MEM as storage sees them."""

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from openacr.basic.memory.heap import ARRAYS, SCALARS, Heap
from openacr.basic.memory.storage import Storage
from openacr.errors import CardError
from openacr.map import numbers as at
from openacr.map.memory import Memory
from openacr.map.rows import storage as storage_rows

FACTORY_FREE = 1048576 - 8 * 65536


@pytest.fixture
def storage() -> Storage:
    return Storage(Memory())


def row(storage: Storage, program: int, row: tuple[int, ...]) -> int:
    return storage.heap.row(program, row)


def test_the_first_dim_of_a_program_replaces_its_share(storage: Storage) -> None:
    storage.dimension_program(0, 8192)
    assert storage.size(0) == 8192
    assert storage.free_system() == FACTORY_FREE + 65536 - 8192
    with pytest.raises(CardError, match="Re-dimensioned block"):
        storage.dimension_program(0, 8192)


def test_a_share_with_a_stored_program_is_not_replaced(storage: Storage) -> None:
    storage.set_code_bytes(0, 100)
    with pytest.raises(CardError, match="Program in memory"):
        storage.dimension_program(0, 8192)


def test_dim_refuses_more_than_there_is(storage: Storage) -> None:
    with pytest.raises(CardError, match="Out of memory"):
        storage.dimension_program(15, FACTORY_FREE + 1)
    storage.dimension_program(15, FACTORY_FREE)
    with pytest.raises(CardError, match="Out of memory"):
        storage.dimension_globals(1)


@pytest.mark.parametrize("count", [0, -1, 4097])
def test_the_number_of_globals_is_limited(storage: Storage, count: int) -> None:
    with pytest.raises(CardError, match="Invalid argument"):
        storage.dimension_globals(count)


def test_a_channel_the_card_lacks_is_an_invalid_device() -> None:
    storage = Storage(Memory(), streams=("COM1",))
    with pytest.raises(CardError, match="Invalid device"):
        storage.dimension_stream("DPCB", 1000)
    with pytest.raises(CardError, match="Invalid device"):
        storage.clear_stream("FIFO")


def test_a_refused_dim_leaves_the_old_state_usable(storage: Storage) -> None:
    storage.locals.variables(0, "LV", 4)
    storage.memory.I[row(storage, 0, storage_rows.lv_base)] = 77
    with pytest.raises(CardError, match="Re-dimensioned block"):
        storage.locals.variables(0, "LV", 4)
    with pytest.raises(CardError, match="Re-dimensioned block"):
        storage.locals.variables(0, "LV", 5, repeat=True)
    storage.locals.variables(0, "LV", 4, repeat=True)
    assert storage.memory.I[row(storage, 0, storage_rows.lv_base)] == 77
    assert storage.free_program(0) == 65536 - 16


def test_a_running_program_may_repeat_all_its_dims(storage: Storage) -> None:
    for _ in range(2):
        storage.locals.string_variables(0, 2, 10, repeat=True)
        storage.locals.references(0, "DA", 1, repeat=True)
        storage.locals.array(0, "DA", 0, 9, repeat=True)
        storage.locals.references(0, "$A", 1, repeat=True)
        storage.locals.string_array(0, 0, 2, 3, repeat=True)
        storage.locals.move_buffer(0, 5, repeat=True)
    with pytest.raises(CardError, match="Re-dimensioned block"):
        storage.locals.string_variables(0, 2, 11, repeat=True)


def test_arrays_need_references_first(storage: Storage) -> None:
    with pytest.raises(CardError, match="Undefined variable"):
        storage.locals.array(0, "LA", 0, 10)
    with pytest.raises(CardError, match="Undefined variable"):
        storage.locals.string_array(0, 0, 10, 10)
    storage.locals.references(0, "LA", 1)
    with pytest.raises(CardError, match="Subscript out of range"):
        storage.locals.array(0, "LA", 1, 10)


def test_locals_are_refused_beyond_the_memory_of_the_program(storage: Storage) -> None:
    with pytest.raises(CardError, match="Out of memory"):
        storage.locals.variables(8, "LV", 1)
    with pytest.raises(CardError, match="Out of memory"):
        storage.locals.variables(0, "DV", 8193)
    storage.locals.variables(0, "DV", 8192)
    assert storage.free_program(0) == 0


def test_text_is_refused_beyond_the_memory_of_the_program(storage: Storage) -> None:
    storage.set_code_bytes(0, 65536)
    with pytest.raises(CardError, match="Out of memory"):
        storage.set_code_bytes(0, 65540)
    storage.set_code_bytes(0, 4)
    assert storage.free_program(0) == 65532


def test_strings_are_cut_to_their_dimensioned_length(storage: Storage) -> None:
    storage.locals.string_variables(0, 2, 4)
    block = storage.locals.strings[0].variable(1)
    assert block.read(1) == ""
    block.write(1, "abcdef")
    assert block.read(1) == "abcd"
    with pytest.raises(CardError, match="Undefined variable"):
        storage.locals.strings[0].variable(2)
    with pytest.raises(CardError, match="Undefined variable"):
        storage.locals.strings[0].array(0)


def test_elements_of_string_arrays_have_their_bounds(storage: Storage) -> None:
    storage.locals.references(0, "$A", 1)
    storage.locals.string_array(0, 0, 2, 4)
    array = storage.locals.strings[0].array(0)
    array.write(1, "hello")
    assert array.read(1) == "hell"
    with pytest.raises(CardError, match="Subscript out of range"):
        array.read(2)


def test_memory_and_string_state_together_restore_everything(storage: Storage) -> None:
    storage.locals.string_variables(0, 2, 4)
    storage.locals.references(0, "$A", 2)
    storage.locals.string_array(0, 1, 2, 4)
    storage.locals.strings[0].variable(0).write(0, "one")
    storage.dimension_globals(10)
    saved, strings = storage.memory.snapshot(), storage.locals.strings_state()
    storage.locals.clear(0)
    other = Storage(Memory())
    other.memory.restore(saved)
    other.locals.restore_strings(strings)
    assert other.locals.strings[0].variable(0).read(0) == "one"
    assert list(other.locals.lines(0)) == ["DIM $V(2,4)", "DIM $A(2)", "DIM $A1(2,4)"]
    assert other.global_count == 10


def test_elements_lie_after_their_header_at_the_documented_place(storage: Storage) -> None:
    memory = storage.memory
    storage.locals.variables(0, "LV", 1)
    storage.locals.references(0, "DA", 2)
    storage.locals.array(0, "DA", 1, 3)
    header = memory.I[row(storage, 0, storage_rows.da_base) + 1]
    assert memory.I[header] == 3
    assert header % 2 == 1
    memory.F[(header + 1) // 2 + 2] = 1.5
    assert memory.I[row(storage, 0, storage_rows.da_base)] == 0


@given(
    st.lists(
        st.tuples(st.integers(0, 7), st.sampled_from(range(7)), st.integers(1, 50)), max_size=25
    )
)
def test_blocks_in_the_heap_never_overlap(steps: list[tuple[int, int, int]]) -> None:
    heap = Heap(Memory())
    for program, what, count in steps:
        if what == 6:
            heap.free(program)
        elif what < 3 and not heap.row(program, SCALARS[what].count_row):
            heap.place_scalars(program, SCALARS[what], count)
        elif what >= 3:
            kind = ARRAYS[what - 3]
            if not heap.row(program, kind.count_row):
                heap.place_references(program, kind, 1)
            if not heap.array_count(program, kind, 0):
                heap.place_array(program, kind, 0, count)
    blocks = sorted(heap._blocks())
    for first, second in pairwise(blocks):
        assert first.start + first.words <= second.start
    assert all(block.start * 4 >= at.HEAP_BYTE_BASE for block in blocks)
