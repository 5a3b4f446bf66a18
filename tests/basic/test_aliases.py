"""Names given with #DEFINE."""

import pytest

import openacr.basic.strings  # noqa: F401 - enters its functions
from openacr.basic.aliases import Aliases
from openacr.basic.nodes import Flag, Number, Parameter
from openacr.errors import CardError

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


def test_one_more_than_reserved_is_refused(aliases: Aliases) -> None:
    aliases.define("One", P0, "P0")
    aliases.define("Two", P1, "P1")
    with pytest.raises(CardError, match="Out of define space"):
        aliases.define("Three", P1, "P1")
    aliases.define("Two", Flag(Number(5)), "BIT5")
    assert aliases.nodes["Two"] == Flag(Number(5))


def test_without_reserved_space_there_is_none() -> None:
    with pytest.raises(CardError, match="Out of define space"):
        Aliases(lambda: 0).define("One", P0, "P0")


def test_definitions_are_listed_as_typed(aliases: Aliases) -> None:
    aliases.define("Time", P0, "P0")
    aliases.define("Count", P1, "P1")
    assert list(aliases.lines()) == ["#DEFINE Time P0", "#DEFINE Count P1"]
    assert aliases.line("Count") == "#DEFINE Count P1"
    assert aliases.line("Other") is None
    aliases.clear()
    assert list(aliases.lines()) == []
    assert not aliases.nodes


def test_aliases_survive_a_snapshot(aliases: Aliases) -> None:
    aliases.define("Time", P0, "P0")
    other = Aliases(lambda: 2)
    other.restore(aliases.state())
    assert list(other.lines()) == ["#DEFINE Time P0"]
    assert other.nodes == {"Time": P0}
