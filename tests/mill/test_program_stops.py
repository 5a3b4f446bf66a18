"""Questions of a program: who answers them, and what happens where no operator can."""

import pytest
from tests.mill.shop import Shop

from openacr.mill.run.lifecycle import State


def asking(*, has_operator: bool, answers: dict[int, float]) -> Shop:
    shop = Shop()
    shop.runner._lifecycle.has_operator = has_operator
    shop.runner.stream.host.answers.update(answers)
    shop.load('INPUT "depth",P200\nG1 F600 X(P200)\nM2\n')
    shop.pass_time(0.2)
    return shop


@pytest.mark.parametrize("has_operator", [True, False])
def test_an_answer_that_is_there_is_not_asked_for(has_operator: bool) -> None:
    shop = asking(has_operator=has_operator, answers={200: 0.5})
    shop.until(State.IDLE)
    assert (shop.pulses(), shop.runner.alarms.active) == ((5000, 0, 0), [])


def test_a_question_without_an_operator_is_an_alarm_that_names_it() -> None:
    shop = asking(has_operator=False, answers={201: 0.5})
    shop.until(State.ALARM)
    assert [(alarm.kind.code, alarm.text) for alarm in shop.runner.alarms.active] == [
        (61, "Answer missing: P200 depth")
    ]
    assert shop.runner.asking is None


def test_a_question_waits_for_its_operator_and_an_abort_takes_it_back() -> None:
    shop = asking(has_operator=True, answers={})
    shop.pass_time(100.0)
    assert (shop.runner.state, shop.runner.reason) == (State.WAIT, "depth")
    asked = shop.runner.asking
    assert asked is not None
    assert (asked.parameter, asked.text) == (200, "depth")
    shop.runner.abort()
    assert shop.runner.asking is None
    shop.until(State.IDLE)
    assert shop.pulses() == (0, 0, 0)
