"""`openacr schema`: examples pass, and what a loader refuses by itself the schema refuses, too."""

import json
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator
from typer.testing import CliRunner

from openacr.bridge.load import parse_bridge
from openacr.cli.explain.schema import Kind, schema_of
from openacr.cli.main import app
from openacr.configure.load import parse_answers
from openacr.errors import SourceError
from openacr.plant.describe.load import parse_world
from openacr.scenario import parse_scenario
from openacr.sweep.load import parse_sweep

ROOT = Path(__file__).parents[2]
LOADERS: dict[Kind, Callable[[str, str], object]] = {
    Kind.MACHINE: parse_world,
    Kind.SCENARIO: parse_scenario,
    Kind.CONFIGURE: parse_answers,
    Kind.BRIDGE: parse_bridge,
    Kind.SWEEP: parse_sweep,
}
SWEEPS = ("gains", "tolerances", "best")
FILES = [
    (kind, path)
    for kind in Kind
    for name in (SWEEPS if kind is Kind.SWEEP else (kind,))
    for path in sorted((ROOT / "examples").glob(f"*/{name}.toml"))
]
AXIS = "[[axis]]\nnumber = 0\nencoder_lines = 1000\n"
IDEAL = 'drive = { mode = "ideal", revs_per_s_per_volt = 1.0 }\n'
ANSWERS = '[[axis]]\nnumber = 0\nname = "X"\nunits_per_rev = 5.0\ncounts_per_rev = 8000\n'
ON = "[prometheus]\n"
VARY = "[vary.a]\nparameter = 0\nvalues = [1, 2]\n"
MEASURES = '[measures]\nm = "at_end(P0)"\n'
SWEEP = f'project = "p"\n{VARY}{MEASURES}'
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
    (Kind.BRIDGE, ON + "port = 65536\n"),
    (Kind.BRIDGE, "rate_hz = 0\n" + ON),
    (Kind.BRIDGE, "[promtheus]\n"),
    (Kind.BRIDGE, "[mtconnect]\nbuffer = 99\n"),
    (Kind.BRIDGE, ON + '[[value]]\nname = "1st"\nflag = 1\n'),
    (Kind.BRIDGE, ON + '[[value]]\nname = "a"\n'),
    (Kind.BRIDGE, ON + '[[value]]\nname = "a"\nflag = 1\nparameter = 1\n'),
    (Kind.SWEEP, SWEEP.replace('project = "p"\n', "")),
    (Kind.SWEEP, "runs = 3\n" + SWEEP),
    (Kind.SWEEP, "duration_s = 0\n" + SWEEP),
    (Kind.SWEEP, "every_tk = 0\n" + SWEEP),
    (Kind.SWEEP, SWEEP.replace(VARY, "")),
    (Kind.SWEEP, SWEEP.replace(VARY, "[vary]\n")),
    (Kind.SWEEP, SWEEP.replace(MEASURES, "[measures]\n")),
    (Kind.SWEEP, SWEEP.replace("vary.a", "vary.A")),
    (Kind.SWEEP, SWEEP.replace("vary.a", f"vary.{'a' * 41}")),
    (Kind.SWEEP, SWEEP.replace("m =", "1m =")),
    (Kind.SWEEP, SWEEP.replace("parameter = 0\n", "")),
    (Kind.SWEEP, SWEEP.replace("values = [1, 2]\n", "")),
    (Kind.SWEEP, SWEEP.replace("parameter = 0", 'parameter = 0\nline = "P0={}"')),
    (Kind.SWEEP, SWEEP.replace("values = [1, 2]", "values = [1]\nrange = [1, 2]\nsteps = 2")),
    (Kind.SWEEP, SWEEP.replace("values = [1, 2]", "range = [1, 2]\nsteps = 1")),
    (Kind.SWEEP, SWEEP.replace("values = [1, 2]", "range = [1]\nsteps = 2")),
    (Kind.SWEEP, SWEEP + '[design]\nkind = "latin"\n'),
    (Kind.SWEEP, SWEEP + "[optimise]\ntrials = 5\n"),
    (Kind.SWEEP, SWEEP + '[optimise]\nminimise = "m"\nmaximise = "m"\n'),
    (Kind.SWEEP, SWEEP + '[optimise]\nminimise = "m"\ntrials = 0\n'),
]
ACCEPTED = [
    (Kind.MACHINE, ""),
    (Kind.MACHINE, "[card]\nperiod_s = 0.005\n"),
    (Kind.MACHINE, "[card]\nperiod_s = 0.0001\n"),
    (Kind.MACHINE, AXIS + IDEAL),
    (Kind.SCENARIO, DONE),
    (Kind.SCENARIO, DONE + "[[expect]]\nflag = 33\nis = true\n"),
    (Kind.CONFIGURE, ANSWERS),
    (Kind.BRIDGE, ON),
    (Kind.BRIDGE, ON + '[[value]]\nname = "a"\nparameter = "axis0.ppu"\n'),
    (Kind.SWEEP, SWEEP),
    (Kind.SWEEP, SWEEP.replace("vary.a", f"vary.{'a' * 40}")),
    (Kind.SWEEP, "until = -516\n" + SWEEP.replace("values = [1, 2]", "range = [1, 2]\nsteps = 2")),
    (Kind.SWEEP, 'until = "idle"\n' + SWEEP + '[optimise]\nmaximise = "m"\n'),
    (
        Kind.SWEEP,
        SWEEP.replace("[1, 2]\n", '[1]\n[vary.b]\nmachine = ["card.period_s"]\nvalues = [1]\n'),
    ),
]


def complaints(kind: Kind, text: str) -> list[str]:
    validator = Draft202012Validator(schema_of(kind))
    return [error.message for error in validator.iter_errors(tomllib.loads(text))]


@pytest.mark.parametrize("kind", list(Kind))
def test_a_schema_is_one_itself(kind: Kind) -> None:
    Draft202012Validator.check_schema(schema_of(kind))


@pytest.mark.parametrize(
    ("kind", "path"), FILES, ids=[f"{path.parent.name}/{path.name}" for _, path in FILES]
)
def test_the_examples_pass(kind: Kind, path: Path) -> None:
    assert complaints(kind, path.read_text(encoding="utf-8")) == []


def test_there_are_examples_of_every_kind() -> None:
    assert {kind for kind, _ in FILES} == set(Kind)


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
