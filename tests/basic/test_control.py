"""Programs under RUN, HALT, PAUSE, block mode and their request flags."""

import pytest
from tests.basic.machine import Machine

PROGRAM_1 = 1024 + 32
RUNNING = PROGRAM_1
STEP_CONTROL, PAUSE_CONTROL, PAUSE_MODE, PAUSE_WAITING = (PROGRAM_1 + n for n in (22, 24, 26, 27))


@pytest.fixture
def card() -> Machine:
    machine = Machine()
    machine.type("DIM P(100)", "PROG 1")
    machine.load(1, "P1 = P1 + 1", "DWL 0.005", "P2 = P2 + 1", "DWL 0.005", "P3 = P3 + 1")
    return machine


def counts(card: Machine) -> tuple[float, ...]:
    return tuple(card.card.memory.read(number) for number in (1, 2, 3))


def bits(card: Machine, *numbers: int) -> list[bool]:
    return [card.card.memory.bit(number) for number in numbers]


def test_halt_ends_a_program_in_the_middle_of_a_dwell(card: Machine) -> None:
    card.type("RUN")
    card.advance(5)
    assert card.type("HALT") == "P01>"
    card.advance(100)
    assert counts(card) == (1, 0, 0)
    assert bits(card, RUNNING, PROGRAM_1 + 1) == [False, False]


def test_pause_stops_before_the_next_line_and_resume_goes_on(card: Machine) -> None:
    card.type("RUN")
    card.advance(5)
    card.type("PAUSE")
    card.advance(200)
    assert counts(card) == (1, 0, 0)
    assert bits(card, RUNNING, PAUSE_CONTROL, PAUSE_MODE, PAUSE_WAITING) == [True] * 4
    card.type("RESUME")
    assert bits(card, PAUSE_CONTROL, PAUSE_MODE, PAUSE_WAITING) == [False] * 3
    card.advance(100)
    assert counts(card) == (1, 1, 1)


def test_clearing_pause_control_resumes_like_the_command(card: Machine) -> None:
    card.load(1, "_L", "P1 = P1 + 1", "DWL 0.001", "GOTO L")
    card.type("RUN", f"SET {PAUSE_CONTROL}")
    card.advance(200)
    held = counts(card)
    card.advance(100)
    assert counts(card) == held
    card.type(f"CLR {PAUSE_CONTROL}")
    card.advance(200)
    assert bits(card, PAUSE_MODE, RUNNING) == [False, True]
    assert counts(card) > held


def test_the_edge_of_step_control_is_a_step_too(card: Machine) -> None:
    card.load(1, "P1 = 1", "P2 = 1")
    card.type("RUN", "BLK")
    card.advance(20)
    card.type(f"SET {STEP_CONTROL}")
    card.advance(300)
    card.type(f"CLR {STEP_CONTROL}")
    card.advance(100)
    card.type(f"SET {STEP_CONTROL}")
    card.advance(100)
    assert counts(card) == (1, 0, 0)


def test_programs_go_on_while_their_text_is_edited(card: Machine) -> None:
    card.type("RUN")
    card.advance(5)
    card.type("20 P1 = 100", "60 P3 = 50")
    card.advance(100)
    assert counts(card) == (1, 1, 1)
    card.type("RUN")
    card.advance(100)
    assert counts(card) == (100, 2, 50)
