"""Machine, scenario and answer files report everything that is wrong with them at once."""

from collections.abc import Callable

import pytest

from openacr.configure.load import parse_answers
from openacr.errors import SourceError
from openacr.plant.describe.load import parse_world
from openacr.scenario import parse_scenario


def mistakes(parse: Callable[[str, str], object], text: str) -> list[str]:
    """Every line of what is said, without the name of the file."""
    with pytest.raises(SourceError) as caught:
        parse(text, "f")
    lines = str(caught.value).split("\n")
    assert [str(each) for each in caught.value.errors] == lines
    return [line.removeprefix("f:").split(" (")[0] for line in lines]


MACHINE = """
[card]
model = "ACR90"
period_s = 1
speed = 3

[[axis]]
number = 99
encoder_lines = 1000
drive = { mode = "ideal", revs_per_s_per_volt = -1 }

[[axis]]
encoder_lines = 0

[[axis]]
number = 2
encoder_lines = 1000
travel = [1, 2, 3]
marker = inf

[axis.drive]
mode = "magic"
"""


def test_every_wrong_value_of_a_machine_is_reported_with_its_line() -> None:
    found = mistakes(parse_world, MACHINE)
    assert [line.split(": ")[0] for line in found] == [
        *("3:1", "4:1", "5:1", "8:1", "10:27", "12:3", "13:1", "18:1", "19:1", "22:1")
    ]
    assert found[0] == (
        '3:1: card.model is "ACR90"; it must be one of "ACR1200", "ACR1500", "ACR1505", "ACR2000",'
        ' "ACR8000", "ACR8010", "ACR8020", "ACR9000", "ACR9030", "ACR9040"'
    )
    assert found[2] == "5:1: unknown key 'speed' in [card]"
    assert found[5] == "12:3: [axis] lacks the key 'number'"
    assert found[8] == "19:1: axis[2].marker is inf; it must be a finite number"
    assert found[9].startswith('22:1: axis[2].drive.mode is "magic"; it must be one of "torque"')


def test_all_contradictions_of_a_machine_are_reported() -> None:
    text = """
    [[axis]]
    number = 0
    drive = { mode = "ideal", revs_per_s_per_volt = 1 }
    travel = [5, -5]

    [[axis]]
    number = 0
    encoder_lines = 100
    drive = { mode = "ideal", revs_per_s_per_volt = 1 }
    motor = { inertia_kgm2 = 1e-5, torque_nm_per_a = 1 }
    """
    assert mistakes(parse_world, text) == [
        "2:7: axis 0 has neither of encoder_lines and counts_per_rev",
        "5:5: axis 0: travel goes from 5 to -5",
        "8:5: two axes have the number 0",
        "11:5: axis 0: an ideal drive has no use for a motor",
    ]


def test_one_mistake_is_an_error_of_its_own() -> None:
    with pytest.raises(SourceError) as caught:
        parse_world("[card]\nperiod_s = 1\n", "f")
    assert str(caught.value).startswith("f:2:1: card.period_s is 1; it must be a number from")
    assert caught.value.errors == (caught.value,)


def test_all_mistakes_of_a_scenario_are_reported() -> None:
    text = """
    at = [
      {time_s = -1, set = [3]},
      {time_s = 1, sett = [3]},
      {time_s = 1, key = "f1"},
    ]
    """
    found = mistakes(parse_scenario, text)
    assert len(found) == 3
    assert any("unknown key `sett`" in line for line in found)
    text = """
    [[at]]
    time_s = 1
    set = [40]
    [[at]]
    set = [3]
    [[expect]]
    flag = 33
    """
    assert mistakes(parse_scenario, text) == [
        "4:5: bit 40 is not an input",
        "5:7: this entry does not say when it happens",
        "7:7: what is expected of the flag?",
    ]


def test_all_mistakes_of_configuration_answers_are_reported() -> None:
    axis = '[[axis]]\nnumber = {}\nname = "{}"\nunits_per_rev = 1.0\ncounts_per_rev = 4\n'
    assert mistakes(parse_answers, axis.format(0, "X") + axis.format(0, "X")) == [
        "7:1: axis 0 is there twice",
        "8:1: the name X is there twice",
    ]
    text = axis.format(16, "X") + axis.format(1, "1") + "colour = 3\n"
    assert [line.split(":")[0] for line in mistakes(parse_answers, text)] == ["2", "8", "11"]


def test_endless_mistakes_end() -> None:
    text = "".join(f"k{n} = 1\n" for n in range(300))
    assert len(mistakes(parse_world, text)) == 100
