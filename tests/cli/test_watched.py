"""`--watch`: what its texts mean, and where the values are shown."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from openacr.cli.main import app
from openacr.cli.run.watched import watched
from openacr.errors import UserError

ROOT = Path(__file__).parents[2]
SQUARE = str(ROOT / "examples/square")


@pytest.mark.parametrize(
    ("text", "column", "is_flag", "unit"),
    [
        ("P12290", "P12290", False, "pulse"),
        ("p 0", "P0", False, ""),
        ("BIT516", "BIT516", True, ""),
        ("IN0", "BIT0", True, ""),
        ("in31", "BIT31", True, ""),
        ("OUT0", "BIT32", True, ""),
        ("OUT31", "BIT63", True, ""),
        ("axis 2 following error", "P12803", False, "pulse"),
        ("master 0 in motion", "BIT516", True, ""),
    ],
)
def test_a_text_names_one_value(text: str, column: str, is_flag: bool, unit: str) -> None:
    (found,) = watched([text])
    assert (found.column, found.is_flag, found.unit) == (column, is_flag, unit)


def test_a_value_is_recorded_once_in_the_order_given() -> None:
    assert [one.column for one in watched(["OUT1", "P5", "BIT33"])] == ["BIT33", "P5"]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("P99999", "--watch P99999: there is no parameter P99999"),
        ("BIT99999", "--watch BIT99999: there is no flag BIT99999"),
        ("IN32", "--watch IN32: inputs and outputs are 0..31"),
        ("OUT32", "--watch OUT32: inputs and outputs are 0..31"),
        ("in motion", "the name of more than one (MASTER 0: In Motion; MASTER 1: In Motion ...)"),
        ("kettle", "--watch kettle: there is no such parameter or flag: write P12290, BIT516"),
    ],
)
def test_a_text_that_names_nothing_is_refused(text: str, message: str) -> None:
    with pytest.raises(UserError) as refused:
        watched([text])
    assert message in str(refused.value)


def test_sixty_five_values_are_too_many() -> None:
    assert len(watched([f"P{n}" for n in range(64)])) == 64
    with pytest.raises(UserError, match="65 values; at most 64 are recorded at once"):
        watched([f"P{n}" for n in range(65)])


def _run(*options: str | Path) -> tuple[int, str]:
    result = CliRunner().invoke(app, ["run", SQUARE, "--quiet", *map(str, options)])
    return result.exit_code, result.stderr


def test_a_trace_has_the_axes_in_use_and_then_what_is_watched(tmp_path: Path) -> None:
    path = tmp_path / "t.csv"
    _run(
        "--for", "2", "--trace", path, "--watch", "P4097", "--watch", "P12290", "--watch", "BIT516"
    )
    head, *rows = path.read_text().splitlines()
    names = head.split(",")
    assert names[1::4][:2] == ["axis_0_commanded", "axis_1_commanded"]
    assert names[9:] == ["P4097", "P12290", "BIT516"]
    actual, counts, flag = (names.index(name) for name in ("axis_0_actual", "P12290", "BIT516"))
    values = [[float(text) for text in row.split(",")] for row in rows]
    assert len(values) == 4000
    assert values[-1][counts] == 40000.0
    assert all(row[counts] == round(row[actual] * 8000) for row in values)
    assert {row[flag] for row in values} == {0.0, 1.0}


@pytest.mark.parametrize("kind", ["svg", "html"])
def test_a_picture_shows_what_is_watched(kind: str, tmp_path: Path) -> None:
    path = tmp_path / f"p.{kind}"
    _run("--for", "1", "--plot", path, "--watch", "P12290", "--watch", "OUT7", "--watch", "BIT516")
    text = path.read_text()
    for title in ("Actual Position axis 0 (P12290)", "OUT 39 (BIT39)", "In Motion (BIT516)"):
        assert title in text


def test_watching_without_a_place_to_show_it_is_refused() -> None:
    code, text = _run("--watch", "P0")
    assert code == 2
    assert "--watch: nothing shows the values; give --trace or --plot, too" in text
