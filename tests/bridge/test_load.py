"""Bridge files: what is wrong in them is said with its line, all of it together."""

from pathlib import Path

import pytest

from openacr.bridge.load import load_bridge, parse_bridge, secret_of
from openacr.bridge.settings import Chosen
from openacr.errors import SourceError, UserError

ON = "[prometheus]\n"


def refusal(text: str) -> str:
    with pytest.raises(SourceError) as caught:
        parse_bridge(text, "b.toml")
    return str(caught.value)


def test_a_short_file_has_defaults() -> None:
    file = parse_bridge(ON)
    assert (file.name, file.rate_hz, file.value) == ("openacr", 10.0, ())
    assert file.prometheus is not None
    assert (file.prometheus.address, file.prometheus.port) == ("127.0.0.1", 9780)


def test_a_file_without_a_system_is_refused() -> None:
    assert "no system is configured" in refusal('name = "mill"\n')


@pytest.mark.parametrize(
    ("text", "place", "said"),
    [
        ("rate_hz = 51\n", "b.toml:1:1", "rate_hz is 51"),
        ("rate_hz = nan\n", "b.toml:1:1", "rate_hz"),
        ('[[value]]\nname = "a"\n', "b.toml:1:3", "give either parameter or flag"),
        ('[[value]]\nname = "a"\nflag = 1\nparameter = 1\n', "b.toml:1:3", "either"),
        ('[[value]]\nname = "a"\nflag = 1\nlow = 1\n', "b.toml:1:3", "a flag has no low"),
        (
            '[[value]]\nname = "a"\nparameter = 1\nwrite = true\n',
            "b.toml:1:3",
            "needs low and high",
        ),
        (
            '[[value]]\nname = "a"\nparameter = 1\nlow = 2\nhigh = 1\n',
            "b.toml:1:3",
            "low 2 is above high 1",
        ),
        (
            '[[value]]\nname = "a"\nflag = 1\n[[value]]\nname = "a"\nflag = 2\n',
            "b.toml:5:1",
            "the name is used twice",
        ),
        ('[[value]]\nname = "a"\nparameter = 99999\n', "b.toml:1:3", "has no parameter 99999"),
        ('[[value]]\nname = "a"\nflag = 400000\n', "b.toml:1:3", "a card has no flag 400000"),
        (
            '[[value]]\nname = "a"\nparameter = "no such"\n',
            "b.toml:1:3",
            "value a: no parameter is named 'no such'",
        ),
        (
            '[[value]]\nname = "user.pulses"\nflag = 1\n',
            "b.toml:2:1",
            "it must be a letter, then letters, digits and _, at most 40 in all, in quotes",
        ),
        ('[sparkplug]\ngroup = "a/b"\n', "b.toml:2:1", "of the form ^[^/+#]{1,60}$"),
        ('[mtconnect]\naddress = ""\n', "b.toml:2:1", "a text in quotes of 1 to 200 characters"),
        ("name = 5\n", "b.toml:1:1", "name is 5; it must be a letter, then letters"),
        ('[card]\naxes = ["X", "X"]\n', "b.toml:2:1", "two axes have the same letter"),
        ('[card]\nunit = "m"\n', "b.toml:2:1", 'card.unit is "m"; it must be one of "mm", "inch"'),
    ],
)
def test_what_is_wrong_is_said_with_its_place(text: str, place: str, said: str) -> None:
    found = refusal(text + ON)
    assert found.startswith(place), found
    assert said in found


def test_an_equal_range_and_a_flag_that_is_written_are_accepted() -> None:
    text = '[[value]]\nname = "a"\nparameter = 1\nwrite = true\nlow = 1\nhigh = 1\n'
    text += '[[value]]\nname = "b"\nflag = 33\nwrite = true\n'
    first, second = parse_bridge(text + ON).value
    assert (first.number, first.parameter_number) == (1, 1)
    assert (second.number, second.parameter_number, second.bit) == (33, 4097, 1)


def test_other_computers_need_a_password() -> None:
    said = refusal('[prometheus]\naddress = "0.0.0.0"\n')
    assert said.startswith("b.toml:2:1: prometheus.address: other computers reach 0.0.0.0")
    text = '[prometheus]\naddress = "0.0.0.0"\npassword_file = "secret"\n'
    assert parse_bridge(text).prometheus is not None


def test_everything_wrong_is_said_together() -> None:
    text = '[[value]]\nname = "a"\n[[value]]\nname = "b"\n' + ON
    assert refusal(text).count("give either parameter or flag") == 2


def test_names_of_parameters_and_flags_are_those_of_the_client() -> None:
    assert Chosen(name="a", parameter="axis1.actual position").number == 12546
    assert Chosen(name="a", flag="BIT516").number == 516


def test_the_password_is_the_first_line_of_its_file(tmp_path: Path) -> None:
    (tmp_path / "secret").write_text(" hush \nnot this\n")
    assert secret_of(tmp_path, "secret") == "hush"
    assert secret_of(tmp_path, None) is None
    (tmp_path / "empty").write_text("\n")
    with pytest.raises(UserError, match="the first line has to be the password"):
        secret_of(tmp_path, "empty")


def test_a_file_that_is_not_there_is_said(tmp_path: Path) -> None:
    with pytest.raises(UserError, match="cannot be read"):
        load_bridge(tmp_path / "none.toml")
