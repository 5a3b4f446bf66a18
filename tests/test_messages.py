"""The rows of the card's messages: one number, one text each."""

import pytest

from openacr import messages
from openacr.messages import MESSAGES, Message


def test_every_message_is_found_by_the_number_in_its_row() -> None:
    rows = [row for row in vars(messages).values() if isinstance(row, Message)]
    assert len(rows) == len(MESSAGES)
    assert all(MESSAGES[row.number] is row for row in rows)


def test_numbers_are_those_stored_programs_and_snapshots_know() -> None:
    assert [messages.OK.number, messages.DIVIDE_BY_ZERO.number] == [0, 9]
    assert [messages.MATH_ERROR.number, messages.STACK_OVERFLOW.number] == [10, 31]
    assert messages.SAVE_FAILED.number == 56


def test_a_number_is_given_once() -> None:
    with pytest.raises(ValueError, match="message 9 is there twice: 'Divide by zero', 'Other'"):
        messages._row(9, "Other")
    assert MESSAGES[9] is messages.DIVIDE_BY_ZERO
