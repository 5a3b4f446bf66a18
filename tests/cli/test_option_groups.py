"""Options that several commands share."""

from dataclasses import dataclass
from typing import Annotated

import typer
from typer.testing import CliRunner

from openacr.cli.option_groups import takes


@dataclass(frozen=True, kw_only=True)
class Machine:
    """Where."""

    host: Annotated[str, typer.Argument(metavar="HOST")]
    baud: Annotated[int, typer.Option("--speed", min=1, help="Its speed.")] = 9600


@dataclass(frozen=True, kw_only=True)
class Asked(Machine):
    """What."""

    axes: Annotated[list[int] | None, typer.Option("--axis")] = None


def test_the_fields_of_a_dataclass_are_the_options_of_a_command() -> None:
    found: list[Asked] = []

    @takes(Asked)
    def work(asked: Asked) -> None:
        """What is done."""
        found.append(asked)

    app = typer.Typer()
    app.command()(work)
    runner = CliRunner()
    assert runner.invoke(app, ["a"]).exit_code == 0
    assert runner.invoke(app, ["b", "--speed", "5", "--axis", "1", "--axis", "2"]).exit_code == 0
    assert found == [Asked(host="a"), Asked(host="b", baud=5, axes=[1, 2])]
    assert runner.invoke(app, ["c", "--speed", "0"]).exit_code == 2
    assert runner.invoke(app, []).exit_code == 2
    shown = runner.invoke(app, ["--help"]).output
    assert "What is done." in shown
    assert shown.index("--speed") < shown.index("--axis")
