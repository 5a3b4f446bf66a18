"""The answer to ATTACH at a program, read."""

import pytest

from openacr.controller import Controller
from openacr.lang.attachments import Attached, attachments

ANSWER = ["ATTACH MASTER3", 'ATTACH SLAVE0 AXIS5 "X"', 'ATTACH SLAVE1 AXIS2 "SP"']


def test_master_and_axes_are_read_in_the_order_of_the_answer() -> None:
    assert attachments(ANSWER) == (3, [Attached(3, 0, 5, "X"), Attached(3, 1, 2, "SP")])
    assert attachments(ANSWER[:1]) == (3, [])


@pytest.mark.parametrize("lines", [[], ["Unknown command"], ANSWER[1:]])
def test_without_a_master_there_are_no_axes(lines: list[str]) -> None:
    assert attachments(lines) == (None, [])


def test_the_answer_of_a_card_is_read() -> None:
    card = Controller()
    card.send('PROG2\rATTACH MASTER2\rATTACH SLAVE1 AXIS4 "AB"\rECHO 4\r')
    assert attachments(card.ask("ATTACH\r").splitlines()) == (2, [Attached(2, 1, 4, "AB")])
