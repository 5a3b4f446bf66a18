"""The dialect of a part program as the commands choose it and say so."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from openacr.cli.main import app
from openacr.cnc.loading import likely
from openacr.sysvar import Store

FUSION = "%\n(Fusion 360)\nG90 G94\nG0 X1\nG1 X2 F10\nM30\n%\n"
DIALECT = 700_005
BY_SIGNS = (
    "dialect rs274ngc by its features: framed by % in line 1, post-processor Fusion 360 in line 2,"
    " G94 in line 3, end M30 in line 6 (--dialect chooses another)"
)


@pytest.fixture
def store(own_store: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(own_store.parent)
    return own_store


def mill(*words: str) -> Result:
    return CliRunner().invoke(app, ["mill", *words])


def put(store: Path, value: float) -> None:
    with Store(store) as cells:
        cells.write(DIALECT, value)


@pytest.mark.parametrize(
    ("text", "words"),
    [(FUSION, ["--dialect", "rs274ngc"]), (f";dialect rs274ngc\n{FUSION}", [])],
)
def test_features_are_not_searched_where_the_dialect_is_chosen(
    store: Path, monkeypatch: pytest.MonkeyPatch, text: str, words: list[str]
) -> None:
    Path("a.nc").write_text(text)
    monkeypatch.setattr(likely, "_signs", lambda line: pytest.fail(line))
    assert mill("check", "a.nc", *words).exit_code == 0


def test_a_file_of_a_cam_system_is_read_without_a_word_about_dialects(store: Path) -> None:
    Path("a.nc").write_text(FUSION)
    result = mill("check", "a.nc")
    assert result.exit_code == 0
    assert result.stderr == f"a.nc: {BY_SIGNS}\n"
    assert result.stdout.startswith("7 lines, 0 errors, 0 warnings\n")


def test_a_file_without_signs_is_read_as_ever_and_nothing_is_said(store: Path) -> None:
    Path("a.nc").write_text("F10 G1 X1\nM2\n")
    result = mill("check", "a.nc")
    assert (result.exit_code, result.stderr) == (0, "")
    assert mill("dialect", "a.nc").stdout == (
        "a.nc: dialect acromill: nothing in the file points to another one\n"
    )


def test_the_setting_of_the_store_wins_and_the_doubt_is_said(store: Path) -> None:
    Path("a.nc").write_text(FUSION)
    put(store, 0)
    result = mill("check", "a.nc")
    assert result.exit_code == 1
    said, *errors = result.stderr.splitlines()
    assert said == (
        "a.nc: dialect acromill, set by Dialect (P700005), but it looks like rs274ngc: framed by %"
        " in line 1, post-processor Fusion 360 in line 2, G94 in line 3, end M30 in line 6"
        " (--dialect rs274ngc)"
    )
    assert errors[0] == (
        "a.nc:3:5: E203 unknown G code: G94 (a code of the dialect rs274ngc: --dialect rs274ngc)"
    )
    put(store, 1)
    assert mill("check", "a.nc").stderr == ""
    Path("b.nc").write_text("F10 G1 X1\nM2\n")
    assert mill("dialect", "b.nc").stdout == "b.nc: dialect rs274ngc, set by Dialect (P700005)\n"


def test_auto_leaves_the_store_out_and_a_name_leaves_all_out(store: Path) -> None:
    Path("a.nc").write_text(FUSION)
    put(store, 0)
    assert mill("dialect", "a.nc", "--dialect", "auto").stdout == f"a.nc: {BY_SIGNS}\n"
    note = mill("dialect", "a.nc", "--dialect", "RS274NGC").stdout
    assert note == "a.nc: dialect rs274ngc, set by --dialect\n"
    wrong = mill("dialect", "a.nc", "--dialect", "fanuc")
    assert wrong.exit_code == 2
    assert (
        wrong.stderr == "error: unknown dialect fanuc: choose one of acromill, rs274ngc or auto\n"
    )


def test_a_mark_in_the_file_wins_over_the_store_and_the_signs(store: Path) -> None:
    Path("a.nc").write_text(";dialect acromill\nG94\n")
    put(store, 1)
    note = mill("dialect", "a.nc", "--json").stdout
    assert json.loads(note) == {
        "dialect": "acromill", "chosen_by": "file", "likely": "rs274ngc",
        "signs": ["G94 in line 2"],
    }  # fmt: skip
    Path("b.nc").write_text(";dialect auto\nG94\n")
    put(store, -1)
    assert json.loads(mill("dialect", "b.nc", "--json").stdout)["chosen_by"] == "signs"


def test_the_chosen_dialect_belongs_to_the_data_of_a_check(store: Path) -> None:
    Path("a.nc").write_text(FUSION)
    assert json.loads(mill("check", "a.nc", "--json").stdout)["dialect"] == "rs274ngc"
    assert json.loads(mill("time", "a.nc", "--json").stdout)["dialect"] == "rs274ngc"


def test_a_file_that_is_not_there_is_an_error(store: Path) -> None:
    result = mill("dialect", "no.nc")
    assert (result.exit_code, result.stderr) == (2, "error: no.nc: no such file\n")
