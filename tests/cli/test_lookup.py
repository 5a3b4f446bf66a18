"""`openacr param` and `openacr flag` explain numbers and names."""

import json

import pytest
from typer.testing import CliRunner, Result

from openacr.cli.main import app


def run(command: str, *arguments: str) -> Result:
    return CliRunner().invoke(app, [command, *arguments], env={"COLUMNS": "100"})


@pytest.mark.parametrize(
    "fact",
    ["P12803  Following Error", "AXIS 2", "LONG", "encoder pulse", "00 30 03 04", "mask 0x04"],
)
def test_a_parameter_is_explained(fact: str) -> None:
    assert fact in run("param", "12803").output


def test_an_erratum_is_shown() -> None:
    assert "Printed as P9245" in run("param", "P9244").output


def test_a_flag_word_lists_its_flags_without_the_reserved_ones() -> None:
    output = run("param", "4112").output
    assert "BIT516" in output
    assert "BIT535" not in output


@pytest.mark.parametrize(
    "fact", ["BIT516  In Motion", "bit 4 of P4112", "0x00000010", "every servo period"]
)
def test_a_flag_is_explained(fact: str) -> None:
    assert fact in run("flag", "516").output


def test_several_matches_are_listed() -> None:
    output = run("param", "gear offset").output
    assert "P12296" in output
    assert "P16136" in output


def test_json_is_an_array_of_records() -> None:
    (record,) = json.loads(run("param", "axis 1 ppu", "--json").output)
    assert (record["number"], record["type"]) == (12631, "FP32")
    assert record["packet"] == {"code": 0x30, "group_index": 87, "mask": 2}
    (word,) = json.loads(run("param", "4112", "--json").output)
    assert word["flags"] == list(range(512, 544))
    (flag,) = json.loads(run("flag", "BIT543", "--json").output)
    assert (flag["mask"], flag["access"]) == (-(2**31), "reserved")


@pytest.mark.parametrize("command", ["param", "flag"])
def test_nothing_found_ends_with_code_2_and_a_suggestion(command: str) -> None:
    result = run(command, "excess eror")
    assert result.exit_code == 2
    assert "perhaps" in result.output
    assert run(command, "99999").exit_code == 2


def test_a_long_list_is_cut_and_says_so() -> None:
    result = run("flag", "user defined")
    assert result.stdout.count("BIT") == 60
    assert "more; say more of the name" in result.stderr
    assert len(json.loads(run("flag", "user defined", "--json").stdout)) > 60


@pytest.mark.parametrize(("command", "number"), [("param", "99999"), ("flag", "99999")])
def test_a_number_that_does_not_exist_names_the_range(command: str, number: str) -> None:
    result = run(command, number)
    assert result.exit_code == 2
    assert result.stderr.startswith("error: there is no ")
    assert "a number 0.." in result.stderr
