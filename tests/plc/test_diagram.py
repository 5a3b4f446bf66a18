"""Rungs on a grid: where elements and wires are, and to which net they belong."""

import pytest
from tests.plc.rack import Rack, numbered

from openacr.errors import CardError
from openacr.plc.diagram import Picture, Wire, pictures


def picture(*lines: str) -> Picture:
    (found,) = pictures(numbered(*lines))
    return found


def symbols(found: Picture) -> list[tuple[object, ...]]:
    return [
        (s.kind, s.text, s.flag, s.is_negated, s.column, s.row, s.source, s.sink)
        for s in found.symbols
    ]


def test_contacts_in_series_and_a_coil_share_the_nets_between_them() -> None:
    found = picture("LD 0", "AND NOT 1", "OUT 32")
    assert symbols(found) == [
        ("contact", "0", 0, False, 0, 0, 0, 1),
        ("contact", "1", 1, True, 1, 0, 1, 2),
        ("coil", "32", 32, False, 2, 0, 2, 3),
    ]
    assert found.wires == []
    assert (found.line, found.columns, found.rows, found.nets) == (10, 3, 1, 4)


def test_branches_are_below_each_other_and_end_in_one_net() -> None:
    found = picture("LD 0", "AND 1", "LD 2", "OR LD", "OUT NOT 33")
    assert symbols(found) == [
        ("contact", "0", 0, False, 0, 0, 0, 2),
        ("contact", "1", 1, False, 1, 0, 2, 1),
        ("contact", "2", 2, False, 0, 1, 0, 1),
        ("coil", "33", 33, True, 2, 0, 1, 3),
    ]
    assert found.wires == [Wire(1, 1, 1, 2, 1), Wire(0, 0, 0, 0, 1), Wire(1, 2, 0, 2, 1)]
    assert (found.columns, found.rows, found.nets) == (3, 2, 4)


def test_branches_of_branches_keep_their_heights() -> None:
    found = picture("LD 0", "LD 1", "OR 2", "AND LD", "LD 3", "OR LD", "OUT 32")
    places = {s.text: (s.column, s.row) for s in found.symbols}
    assert places == {"0": (0, 0), "1": (1, 0), "2": (1, 1), "3": (0, 2), "32": (2, 0)}
    assert Wire(0, 0, 0, 0, 2) in found.wires
    assert Wire(1, 2, 0, 2, 2) in found.wires
    assert found.rows == 3


def test_outputs_are_at_the_right_rail_in_every_rung() -> None:
    short, long = pictures(numbered("LD 0 OUT 32 SET 33", "LD 1 AND 2 AND 3 CLR 34"))
    assert [(s.kind, s.column) for s in short.symbols] == [("contact", 0), ("coil", 2), ("set", 3)]
    assert short.wires == [Wire(1, 1, 0, 2, 0)]
    assert [(s.kind, s.column) for s in long.symbols][-1] == ("clear", 3)
    assert (short.line, long.line, short.columns, long.columns) == (10, 20, 4, 4)


def test_a_contact_after_an_output_keeps_its_place_in_the_row() -> None:
    found = picture("LD 0 OUT 32 AND 1 CLR 34")
    assert [(s.kind, s.column, s.source) for s in found.symbols] == [
        ("contact", 0, 0), ("coil", 1, 1), ("contact", 2, 2), ("clear", 3, 3),
    ]  # fmt: skip


def test_a_counter_has_two_inputs_and_shows_its_output_flag() -> None:
    found = picture("LD 4 AND 7", "LD 5", "CNT 1 10")
    counter = found.symbols[-1]
    assert (counter.kind, counter.text, counter.number) == ("counter", "1 10", 1)
    assert counter.flag == 1536 + 32 + 20
    assert (counter.column, counter.row, counter.reset_row) == (2, 0, 1)
    assert (counter.source, counter.reset, counter.sink) == (2, 3, 1)
    assert found.wires == [Wire(3, 1, 1, 2, 1), Wire(0, 0, 0, 0, 1)]
    assert (found.rows, found.columns) == (2, 3)


def test_the_second_input_of_a_latch_is_below_all_branches_of_the_first() -> None:
    found = picture("LD 0 OR 1", "LD 2 AND 3", "KR 0")
    latch = found.symbols[-1]
    assert (latch.column, latch.row, latch.reset_row) == (2, 0, 2)
    assert {s.text: (s.column, s.row) for s in found.symbols[:-1]} == {
        "0": (0, 0), "1": (0, 1), "2": (0, 2), "3": (1, 2),
    }  # fmt: skip
    assert (found.columns, found.rows) == (3, 3)


@pytest.mark.parametrize(
    ("line", "kind", "number", "flag"),
    [
        ("LD 0 TIM 2 500", "timer", 2, 1536 + 64 + 16),
        ("LD 0 LD 1 KR 3", "latch", 3, 1536 + 96 + 28),
        ("LD 0 NOT OUT 5", "not", None, None),
    ],
)
def test_boxes_know_their_flag(line: str, kind: str, number: int | None, flag: int | None) -> None:
    box = next(s for s in picture(line).symbols if s.kind not in ("contact", "coil"))
    assert (box.kind, box.number, box.flag) == (kind, number, flag)


def test_a_plc_that_cannot_run_has_no_picture() -> None:
    with pytest.raises(CardError):
        pictures(numbered("AND 1"))
    assert pictures(numbered("REM nothing")) == []


def power(found: Picture, on: set[int]) -> list[bool]:
    """Which nets carry power, as a screen finds it."""
    carries = [True] + [False] * (found.nets - 1)
    for s in found.symbols:
        source = carries[s.source] if s.reset is None else carries[s.reset]
        if s.kind == "contact":
            source = source and (s.flag in on) is not s.is_negated
        elif s.kind == "not":
            source = not source
        carries[s.sink] = carries[s.sink] or source
    return carries


@pytest.mark.parametrize(
    "line",
    [
        "LD 0 AND NOT 1 OR 2 OUT 40",
        "LD 0 LD 1 OR 2 AND LD LD NOT 3 AND 0 OR LD NOT OUT 40",
        "LD 0 OR 1 LD 2 OR NOT 3 AND LD OUT 41 AND 1 OUT 40",
        "LD 0 NOT AND 1 LD 2 NOT OR LD OUT 40",
        "LD 0 LD 1 CNT 1 5 AND 2 OUT 40",
    ],
)
def test_power_at_a_coil_is_the_result_of_the_scan(line: str) -> None:
    found = picture(line)
    coil = next(s for s in found.symbols if s.flag == 40)
    for state in range(16):
        on = {bit for bit in range(4) if state >> bit & 1}
        rack = Rack().program(line)
        rack.put(True, *on)
        rack.step()
        assert power(found, on)[coil.source] is rack.on(40), on
