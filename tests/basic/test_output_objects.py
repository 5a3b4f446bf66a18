"""Ratchets, limiters, programmable limit switches and output objects."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.basic.motion_bench import WHEEL, Bench, turn

from openacr.map.rows import ratchets


def place(made: Bench, position: int) -> Bench:
    made.memory.I[WHEEL] = position
    return made.ticks(1)


# ratchets


def test_a_ratchet_is_a_source() -> None:
    made = Bench("X").all("RATCH2 SRC ENC10 : RATCH2 MODE 3", "GEAR SRC X RATCH2", "GEAR ON X")
    assert turn(made, 5, -3, 2, 4).p(12296) == 8
    made.all("RATCH2 RES 0")
    assert made.type("RATCH2 SRC") == "ENC10"


def test_ratch_res_sets_the_output_and_drops_the_backlog() -> None:
    made = Bench().all("RATCH0 SRC ENC10 : RATCH0 MODE 3")
    turn(made, -7).all("RATCH0 RES 100")
    assert turn(made, 4).type("RATCH0") == "104"


@given(st.integers(0, 15), st.lists(st.integers(-9, 9), max_size=20))
@settings(max_examples=50, deadline=None)
def test_a_ratchet_that_passes_or_buffers_loses_nothing(mode: int, counts: list[int]) -> None:
    made = Bench().all("RATCH0 SRC ENC10", f"RATCH0 MODE {mode & 0b1100 | 3}")
    turn(made, *counts)
    output, backlog = made.memory.F[ratchets.reals[0] : ratchets.reals[0] + 2]
    if mode >> 2 in (0, 3):
        assert output + backlog == sum(counts)
        assert output >= 0
    if mode >> 2 == 3:
        assert output == 0


@pytest.mark.parametrize("line", ["RATCH8", "RATCH0 MODE 16", "RATCH0 MODE -1", "LIMIT0 FREQ -1"])
def test_what_does_not_exist_is_refused(line: str) -> None:
    assert Bench().type(line) == "Invalid argument"


# limit switches


def switch(*patterns: int, lines: tuple[str, ...] = ()) -> Bench:
    made = Bench("X").all("DIM LA(1)", f"DIM LA0({len(patterns)})")
    for index, pattern in enumerate(patterns):
        made.all(f"LA0({index})={pattern}")
    return made.all("PLS0 SRC ENC10", "PLS0 BASE LA0", "PLS0 DST P4100", *lines, "PLS0 ON")


def test_mask_ratio_rotary_and_flz() -> None:
    made = switch(255, 0, 255, lines=("PLS0 MASK 15", "PLS0 RATIO 0.1", "PLS0 ROTARY 3"))
    made.all("P4100=240", "PLS0 FLZ 10")
    assert [place(made, p).p(4100) for p in (0, 10, 19, 20, -10)] == [240, 255, 255, 255, 255]
    assert place(made, 30).p(4100) == 240


def test_pls_res_makes_the_present_place_an_index() -> None:
    made = switch(1, 2, 4)
    place(made, 1000).all("PLS0 RES 1")
    assert place(made, 1000).p(4100) == 2
    assert place(made, 1001).p(4100) == 4


def test_a_freed_array_switches_it_off() -> None:
    made = switch(1, 2)
    made.all("CLEAR").ticks(1)
    assert not made.bit(120)


def test_a_limit_switch_that_is_on_before_its_array_writes_nothing_until_then() -> None:
    made = Bench("X").all("DIM LA(1)", "DIM LA0(2)", "LA0(0)=5", "LA0(1)=6")
    made.all("PLS0 SRC ENC10", "PLS0 DST P4100", "P4100=9", "PLS0 ON").ticks(3)
    assert (made.bit(120), made.p(4100)) == (True, 9)
    made.all("PLS0 BASE LA0").ticks(2)
    assert (made.bit(120), made.p(4100)) == (True, 5)


def test_a_limit_switch_needs_an_array_and_a_long_parameter() -> None:
    made = Bench("X")
    assert made.type("PLS0 BASE LA0") == "Undefined variable"
    assert made.type("PLS0 DST P12304") == "Invalid parameter"
    assert made.type("PLS0") == "PLS0 OFF SRC NONE BASE NONE DST P4097"


# output objects


@pytest.mark.parametrize(("count", "last"), [("", True), (",0", True), (",2", False)])
def test_windows_repeat(count: str, last: bool) -> None:
    made = Bench().all("OOP0 SRC ENC10", f"OOP0 INC (100,50,10{count})", "OOP0 ON")
    seen = [place(made, p).bit(32) for p in (99, 100, 109, 110, 150, 160, 200, 50)]
    assert seen == [False, True, True, False, True, False, last, False]


def test_the_windows_are_reported_as_they_are_typed() -> None:
    made = Bench().all("OOP2 POS (1,2)", "OOP2 INC (-100,50.5,10)")
    assert made.type("OOP2") == "OOP2 OFF SRC ENC2 BIT 34 POS (1,2) INC (-100,50.5,10)"
    made.all("OOP2 INC (0,50,10,3)")
    assert made.type("OOP2").endswith(" INC (0,50,10,3)")


def test_the_defaults_are_an_encoder_and_an_output_of_the_same_number() -> None:
    made = Bench()
    assert (made.type("OOP3 SRC"), made.type("OOP3 BIT")) == ("ENC3", "35")
    assert made.type("OOP0 INC (0,0,1)") == "Invalid argument"
