"""Names given with #DEFINE."""

import pytest
from tests.basic.machine import Machine

import openacr.basic.commands.strings  # noqa: F401 - enters its functions
from openacr.basic.language.aliases import Aliases
from openacr.basic.language.nodes import Number, Parameter
from openacr.basic.language.scope import join_names
from openacr.errors import CardError
from openacr.lang.lexer import tokens
from openacr.plant.describe.schema import Card

SUCCESSOR = Card(digits_in_names=True).board
P0 = Parameter(Number(0))
P1 = Parameter(Number(1))


@pytest.fixture
def aliases() -> Aliases:
    return Aliases(lambda: 2)


@pytest.mark.parametrize(
    "name",
    ["a" * 25, "Count1", "my_name", "a b", "x@y", "", "ä", "Len", "bit", "And", "then", "LV"],
)
def test_illegal_names_are_refused(aliases: Aliases, name: str) -> None:
    with pytest.raises(CardError, match="Illegal name"):
        aliases.define(name, P0, "P0")


def test_names_of_24_letters_are_accepted_and_case_matters(aliases: Aliases) -> None:
    aliases.define("A" * 24, P0, "P0")
    aliases.define("a" * 24, P1, "P1")
    assert aliases.nodes == {"A" * 24: P0, "a" * 24: P1}


@pytest.mark.parametrize("name", ["Count1", "a2b3", "Stn12x", "x" * 22 + "24"])
def test_newer_models_allow_digits_after_the_first_letter(name: str) -> None:
    bench = Machine(SUCCESSOR)
    bench.type("DIM P(10)", "DIM DEF(5)")
    assert bench.type(f"#DEFINE {name} P5") == "SYS>"
    assert bench.type(f"#DEFINE {name}") == f"#DEFINE {name} P5|SYS>"


@pytest.mark.parametrize("name", ["P12", "SET32", "LV0", "1st", "Len2", "a_1", "x" * 24 + "5"])
def test_names_that_read_as_a_word_and_its_number_are_refused(name: str) -> None:
    bench = Machine(SUCCESSOR)
    bench.type("DIM P(10)", "DIM DEF(5)")
    assert bench.type(f"#DEFINE {name} P5") == "Illegal name|SYS>"


def test_names_with_digits_are_used_listed_and_distinguished_from_numbers() -> None:
    rig = Machine(SUCCESSOR)
    rig.type("DIM PROG0(1000)", "DIM P(10)", "DIM DEF(5)", "PROG0")
    rig.type("#DEFINE Part1 P1", "#DEFINE Part1b P2", "#DEFINE Part BIT33")
    rig.type("10 Part1=5:Part1b=Part1*2", "20 SET Part 32", "30 PRINT Part1;Part1b")
    assert rig.type("LIST").split("|")[:-1] == [
        "10 Part1 = 5 : Part1b = Part1*2",
        "20 SET Part 32",
        "30 PRINT Part1;Part1b",
    ]


def test_the_longest_name_is_read() -> None:
    found = tokens("Part1b=Part1+Part12+X1")
    join_names(found, frozenset(("Part1", "Part1b")))
    assert [token.text for token in found[:-1]] == [
        *("Part1b", "=", "Part1", "+", "Part", "12", "+", "X", "1"),
    ]  # fmt: skip
