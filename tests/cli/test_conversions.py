"""Numbers of a command line: the values and refusals of typer, mostly without it."""

from typing import Annotated, Any

import pytest
import typer
from typer.testing import CliRunner

from openacr.cli.conversions import CONVERSION, Quick
from openacr.cli.main import SubCommand


def _show(
    whole: Annotated[int, typer.Option(min=-2, max=5)] = 3,
    real: Annotated[float, typer.Option(min=0.5)] = 0.5,
    is_on: Annotated[bool, typer.Option("--on")] = False,
    free: Annotated[int | None, typer.Option()] = None,
    texts: Annotated[list[str] | None, typer.Option()] = None,
) -> None:
    typer.echo(repr((whole, real, is_on, free, texts)))


def _command(kind: Any) -> Any:
    single = typer.Typer(add_completion=False, rich_markup_mode=None)
    single.command("show", cls=kind)(_show)
    return single


def _by_typer(command: Any) -> list[str]:
    """The options that typer had to convert in this command."""
    return [
        each.name for each in command.params if not isinstance(getattr(each, CONVERSION), Quick)
    ]


PLAIN = ["", "--whole -2", "--whole +5", "--real 0.5", "--real 7", "--on", "--free 123456789"]


@pytest.mark.parametrize("words", PLAIN)
def test_plain_numbers_are_those_of_typer_and_need_no_typer(words: str) -> None:
    made: list[SubCommand] = []

    class Kept(SubCommand):
        def __init__(self, *more: Any, **given: Any) -> None:
            super().__init__(*more, **given)
            made.append(self)

    own = CliRunner().invoke(_command(Kept), words.split())
    assert own.exit_code == 0
    assert own.output == CliRunner().invoke(_command(None), words.split()).output
    assert [_by_typer(each) for each in made] == [[]]


REFUSED = ["--whole -3", "--whole 6", "--whole 1.5", "--whole x", "--real 0.4", "--real nan"]
ODD = ["--real 1e3", "--real inf", "--real .75", "--whole 0b1", "--free 1234567890", "--texts a"]


@pytest.mark.parametrize("words", REFUSED + ODD)
def test_other_words_are_converted_or_refused_as_by_typer(words: str) -> None:
    own = CliRunner().invoke(_command(SubCommand), words.split())
    theirs = CliRunner().invoke(_command(None), words.split())
    assert (own.exit_code, own.output) == (theirs.exit_code, theirs.output)
    assert own.exit_code == (2 if words in [*REFUSED, "--whole 0b1"] else 0)
