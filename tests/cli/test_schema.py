"""`openacr schema`: examples pass, and what a loader refuses by itself the schema refuses, too."""

import json
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator
from typer.testing import CliRunner

from openacr.cli.explain.schema import Kind, schema_of
from openacr.cli.main import app
from openacr.configure.load import parse_answers
from openacr.errors import SourceError
from openacr.plant.load import parse_world
from openacr.scenario import parse_scenario

ROOT = Path(__file__).parents[2]
LOADERS: dict[Kind, Callable[[str, str], object]] = {
    Kind.MACHINE: parse_world,
    Kind.SCENARIO: parse_scenario,
    Kind.CONFIGURE: parse_answers,
}
FILES = sorted(path for kind in Kind for path in (ROOT / "examples").glob(f"*/{kind}.toml"))
AXIS = "[[axis]]\nnumber = 0\nencoder_lines = 1000\n"
IDEAL = 'drive = { mode = "ideal", revs_per_s_per_volt = 1.0 }\n'
ANSWERS = '[[axis]]\nnumber = 0\nname = "X"\nunits_per_rev = 5.0\ncounts_per_rev = 8000\n'
DONE = "[[at]]\ntime_s = 1\nset = [3]\n"

REFUSED = [
    (Kind.MACHINE, '[card]\nmodel = "ACR90"\n'),
    (Kind.MACHINE, "[card]\nperiod_s = 0.006\n"),
    (Kind.MACHINE, "[card]\nperiod_s = 0.00009\n"),
    (Kind.MACHINE, "[card]\ndac_bits = 8.5\n"),
    (Kind.MACHINE, "[card]\nspeed = 1\n"),
    (Kind.MACHINE, "[crd]\n"),
    (Kind.MACHINE, "card = 3\n"),
    (Kind.MACHINE, "[[axis]]\nencoder_lines = 1000\n" + IDEAL),
    (Kind.MACHINE, AXIS.replace("0", "16", 1) + IDEAL),
    (Kind.MACHINE, AXIS.replace("0", "-1", 1) + IDEAL),
    (Kind.MACHINE, AXIS + 'drive = { mode = "magic" }\n'),
    (Kind.MACHINE, AXIS + 'drive = { mode = "ideal" }\n'),
    (Kind.MACHINE, AXIS + 'drive = { mode = "ideal", revs_per_s_per_volt = 0 }\n'),
    (Kind.MACHINE, AXIS + IDEAL + "travel = [1.0, 2.0, 3.0]\n"),
    (Kind.MACHINE, AXIS + IDEAL + "travel = 1.0\n"),
    (Kind.SCENARIO, "duration_s = 0\n"),
    (Kind.SCENARIO, 'duration_s = "2"\n'),
    (Kind.SCENARIO, "length_s = 2\n"),
    (Kind.SCENARIO, "[[at]]\nset = [3]\n"),  # no moment
    (Kind.SCENARIO, "[[at]]\ntime_s = 1\n"),  # no deed
    (Kind.SCENARIO, "[[at]]\ntime_s = -1\nset = [3]\n"),
    (Kind.SCENARIO, "[[at]]\ntime_s = 1\nset = [-1]\n"),
    (Kind.SCENARIO, '[[at]]\ntime_s = 1\nkey = "ctrl-q"\n'),
    (Kind.SCENARIO, "[[at]]\nwhen = {bit = 516, axis = 0, above = 1}\nset = [3]\n"),
    (Kind.SCENARIO, "[[at]]\nwhen = {above = 1}\nset = [3]\n"),
    (Kind.SCENARIO, "[[expect]]\ntime_s = 1\n"),
    (Kind.SCENARIO, "[[expect]]\nflag = 3\nis = true\naxis = 0\nposition = 1\n"),
    (Kind.CONFIGURE, ANSWERS + "leed = 3\n"),
    (Kind.CONFIGURE, ANSWERS.replace("number = 0\n", "")),
    (Kind.CONFIGURE, ANSWERS.replace('"X"', '"TOOLONG"')),
    (Kind.CONFIGURE, ANSWERS.replace("8000", "0")),
    (Kind.CONFIGURE, "[card]\ncanopen = { nodes = 5 }\n" + ANSWERS),
]
ACCEPTED = [
    (Kind.MACHINE, ""),
    (Kind.MACHINE, "[card]\nperiod_s = 0.005\n"),
    (Kind.MACHINE, "[card]\nperiod_s = 0.0001\n"),
    (Kind.MACHINE, AXIS + IDEAL),
    (Kind.SCENARIO, DONE),
    (Kind.SCENARIO, DONE + "[[expect]]\nflag = 33\nis = true\n"),
    (Kind.CONFIGURE, ANSWERS),
]


def complaints(kind: Kind, text: str) -> list[str]:
    validator = Draft202012Validator(schema_of(kind))
    return [error.message for error in validator.iter_errors(tomllib.loads(text))]


@pytest.mark.parametrize("kind", list(Kind))
def test_a_schema_is_one_itself(kind: Kind) -> None:
    Draft202012Validator.check_schema(schema_of(kind))


@pytest.mark.parametrize("path", FILES, ids=lambda path: f"{path.parent.name}/{path.name}")
def test_the_examples_pass(path: Path) -> None:
    assert complaints(Kind(path.stem), path.read_text(encoding="utf-8")) == []


def test_there_are_examples_of_every_kind() -> None:
    assert {Kind(path.stem) for path in FILES} == set(Kind)


@pytest.mark.parametrize(("kind", "text"), REFUSED)
def test_what_the_loader_refuses_the_schema_refuses(kind: Kind, text: str) -> None:
    with pytest.raises(SourceError):
        LOADERS[kind](text, "f")
    assert complaints(kind, text)


@pytest.mark.parametrize(("kind", "text"), ACCEPTED)
def test_what_the_loader_accepts_the_schema_accepts(kind: Kind, text: str) -> None:
    LOADERS[kind](text, "f")
    assert complaints(kind, text) == []


@pytest.mark.parametrize("kind", list(Kind))
def test_the_command_prints_it(kind: Kind) -> None:
    result = CliRunner().invoke(app, ["schema", kind])
    printed = json.loads(result.stdout)
    assert (result.exit_code, printed) == (0, json.loads(json.dumps(schema_of(kind))))
    assert printed["title"] == f"{kind}.toml of openacr"
    assert printed["$schema"] == "https://json-schema.org/draft/2020-12/schema"
    assert not list(nulls(printed))


def nulls(value: Any) -> list[Any]:
    """Every place where a schema speaks of null."""
    if isinstance(value, dict):
        own = [value] if value.get("type") == "null" or None in value.values() else []
        return own + [each for inner in value.values() for each in nulls(inner)]
    return [each for inner in value for each in nulls(inner)] if isinstance(value, list) else []
