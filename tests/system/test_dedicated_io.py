"""Limit and home inputs (HLBIT), drive signals."""

import pytest
from tests.system.terminal import Console

POSITIVE, NEGATIVE, HOME = 1, 2, 4


def states(console: Console, axis: int) -> int:
    """Limit and home states of an axis as P4600 + n shows them."""
    console.card.advance(1)
    return int(console.card.p[4600 + axis]) & 7


@pytest.mark.req("ACR-HLBIT-01")
@pytest.mark.parametrize("axis", range(8))
def test_axis_n_has_inputs_3n_to_3n_plus_2(axis: int) -> None:
    console = Console()
    for offset, state in enumerate((POSITIVE, NEGATIVE, HOME)):
        console.card.bit[3 * axis + offset] = True
        assert states(console, axis) == state
        console.card.bit[3 * axis + offset] = False
    assert states(console, axis) == 0
    assert console.type(f"AXIS{axis} HLBIT") == str(3 * axis)


@pytest.mark.req("ACR-HLBIT-02", "ACR-HLBIT-07", "ACR-LIMDET-02")
@pytest.mark.parametrize(("first", "other"), [(3, 12), (12, 3)])
def test_hlbit_chooses_the_first_of_three_inputs_and_reports_it(first: int, other: int) -> None:
    console = Console()
    console.type("PROG0", "ATTACH MASTER0", 'ATTACH SLAVE0 AXIS1 "Y"')
    assert console.type(f"HLBIT Y{first}", "HLBIT Y") == f"{first}"
    for offset, state in enumerate((POSITIVE, NEGATIVE, HOME)):
        console.card.bit[first + offset] = True
        assert states(console, 1) == state
        console.card.bit[first + offset] = False
    console.card.bit[other] = True
    assert states(console, 1) == 0


@pytest.mark.req("ACR-HLBIT-03")
def test_no_parameter_shows_or_changes_the_assignment() -> None:
    console = Console()
    before = console.card.memory.I[4096:40960].tolist()
    assert console.type("AXIS0 HLBIT 12", "AXIS0 HLBIT") == "12"
    assert console.card.memory.I[4096:40960].tolist() == before


@pytest.mark.req("ACR-HLBIT-04", "ACR-HLBIT-05")
@pytest.mark.parametrize(("first", "real"), [(31, POSITIVE), (30, POSITIVE | NEGATIVE), (29, 7)])
@pytest.mark.parametrize("inverted", [False, True])
def test_inputs_beyond_the_word_of_32_always_read_0(first: int, real: int, inverted: bool) -> None:
    console = Console()
    console.type(f"AXIS0 HLBIT {first}")
    for bit in (16144, 16145, 16146):
        console.card.bit[bit] = inverted
    console.card.p[4096] = 0 if inverted else -1
    console.card.p[4097] = 0 if inverted else -1
    assert states(console, 0) == real


@pytest.mark.req("ACR-HLBIT-06")
def test_an_imaginary_home_input_is_never_found_and_jog_off_ends_the_search_as_failed() -> None:
    console = Console()
    console.type("AXIS0 HLBIT 30", "AXIS0 JOG VEL 100", "AXIS0 JOG HOME 1")
    console.card.p[4097] = -1  # whatever lies in the next word
    console.card.advance(seconds=2)
    assert console.card.bit[16131]  # still searching
    console.type("AXIS0 JOG OFF")
    console.card.advance(seconds=30)
    assert (console.card.bit[16134], console.card.bit[16135]) == (False, True)


@pytest.mark.req("ACR-IO-DRIVE")
def test_enable_reset_and_fault_of_a_drive_follow_commands_and_input() -> None:
    console = Console()
    card = console.card
    card.bit[8468] = True  # drive I/O in use
    console.type("AXIS0 DRIVE ON")
    card.advance(seconds=0.0095)
    assert not card.bit[8465]
    card.advance(seconds=0.001)
    assert card.bit[8465]
    console.type("AXIS0 DRIVE RES")
    card.advance(seconds=0.049)
    assert card.bit[8466]
    card.advance(seconds=0.002)
    assert not card.bit[8466]
    console.type("AXIS0 DRIVE OFF")
    card.advance(1)
    assert not card.bit[8465]
    assert console.type("DRIVE AXIS0") == "DRIVE OFF AXIS0"
    console.type("AXIS0 DRIVE ON")
    card.advance(seconds=0.02)
    card.bit[8453] = True  # level inverted: no fault line at the input is a fault
    card.advance(2)
    assert card.bit[8477]
    assert card.bit[8467]
    assert not card.bit[8465]
    assert console.type("DRIVE AXIS0") == "DRIVE OFF AXIS0 FAULT"
