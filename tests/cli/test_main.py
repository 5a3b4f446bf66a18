"""The command `openacr` as a whole: help, version, errors, speed."""

import os
import subprocess
import sys
from collections.abc import Mapping
from importlib import import_module
from pathlib import Path
from typing import Annotated

import pytest
import typer
from typer.testing import CliRunner

from openacr.cli.commands import COMMANDS, Entry, Family
from openacr.cli.main import SubCommand, app


def all_entries(
    table: Mapping[str, Entry | Family] = COMMANDS, before: str = ""
) -> list[tuple[str, Entry]]:
    """The words of every command with its entry."""
    found = []
    for name, entry in table.items():
        if isinstance(entry, Family):
            found += all_entries(entry.entries, f"{before}{name} ")
        else:
            found.append((before + name, entry))
    return found


@pytest.mark.parametrize(("words", "entry"), all_entries())
def test_the_help_of_every_command_begins_with_its_summary(words: str, entry: Entry) -> None:
    function = getattr(import_module(f"openacr.cli.{entry.module}"), entry.function)
    assert function.__doc__.splitlines()[0] == entry.summary
    result = CliRunner().invoke(app, [*words.split(), "--help"])
    assert result.exit_code == 0
    assert " ".join(entry.summary.split()) in " ".join(result.stdout.split())


def test_help_lists_every_command() -> None:
    shown = CliRunner().invoke(app, ["--help"]).stdout
    assert [
        line.split()[0] for line in shown.split("Commands:")[1].splitlines() if line[2:3].strip()
    ]
    for name in COMMANDS:
        assert f"\n  {name} " in shown


@pytest.mark.parametrize(
    "family", [name for name, each in COMMANDS.items() if isinstance(each, Family)]
)
def test_a_family_offers_no_completion_of_its_own(family: str) -> None:
    shown = CliRunner().invoke(app, [family, "--help"]).output
    assert "-h, --help" in shown
    assert "completion" not in shown


HEAVY = {"numpy", "matplotlib", "rich", "asyncio", "serial", "starlette"}
SLOW = {"pydantic", "importlib.metadata", "importlib.resources", "zipfile"}


@pytest.mark.parametrize(
    ("arguments", "heavy"),
    [
        (["--help"], HEAVY | {"msgspec", "pydantic"}),
        (["mill", "check", "part.nc"], HEAVY - {"rich"} | SLOW),
        (["mill", "check", "--json", "--dialect", "acromill", "part.nc"], HEAVY - {"rich"} | SLOW),
    ],
)
def test_what_answers_at_once_imports_nothing_heavy(
    arguments: list[str], heavy: set[str], tmp_path: Path
) -> None:
    (tmp_path / "part.nc").write_text("G21 G90\nG1 X10 F100\nG2 X20 I15 J0\nM2\n")
    code = (
        "import sys, openacr.cli.main as m\n"
        f"sys.argv = ['openacr', *{arguments}]\n"
        "try: m.main()\n"
        "except SystemExit as end: print(end.code or 0, file=sys.stderr)\n"
        f"print(sorted({heavy} & set(sys.modules)), file=sys.stderr)\n"
    )
    result = subprocess.run(
        [sys.executable, "-c", code], check=True, capture_output=True, cwd=tmp_path
    )
    assert result.stderr.decode().splitlines() == ["0", "[]"]


def converted(words: list[str]) -> dict[str, object]:
    """What a command with every kind of parameter receives."""
    got: dict[str, object] = {}

    def command(
        file: Annotated[Path, typer.Argument()],
        others: Annotated[list[Path] | None, typer.Argument()] = None,
        name: Annotated[str, typer.Option()] = "none",
        store: Annotated[Path | None, typer.Option()] = None,
        kept: Annotated[Path | None, typer.Option(exists=True)] = None,
        folder: Annotated[Path | None, typer.Option(file_okay=False)] = None,
        count: Annotated[int, typer.Option(min=1)] = 3,
        is_on: Annotated[bool, typer.Option("--on")] = False,
        tags: Annotated[list[str] | None, typer.Option()] = None,
    ) -> None:
        got.update(locals())

    single = typer.Typer(add_completion=False, rich_markup_mode=None)
    single.command(cls=SubCommand)(command)
    result = CliRunner().invoke(single, words)
    got["stderr"] = result.stderr
    got.pop("got", None)
    return got


def test_values_of_parameters_have_the_types_of_the_command() -> None:
    few = converted(["a.nc"])
    assert few == {
        "file": Path("a.nc"), "others": None, "name": "none", "store": None, "kept": None,
        "folder": None, "count": 3, "is_on": False, "tags": None, "stderr": "",
    }  # fmt: skip
    words = "a.nc b.nc c.nc --name 7 --store x/y --count 5 --on --tags p --tags q"
    assert converted(words.split()) == few | {
        "others": [Path("b.nc"), Path("c.nc")], "name": "7", "store": Path("x/y"), "count": 5,
        "is_on": True, "tags": ["p", "q"],
    }  # fmt: skip


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--count", "0"], "Invalid value for '--count'"),
        (["--count", "a"], "Invalid value for '--count'"),
        (["--kept", "nowhere"], "'nowhere' does not exist"),
        (["--folder", __file__], "is a file"),
    ],
)
def test_rules_of_a_parameter_are_kept(words: list[str], said: str) -> None:
    assert said in " ".join(str(converted(["a.nc", *words])["stderr"]).split())


def test_a_file_that_may_not_be_read_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "a.nc"
    path.touch()
    monkeypatch.setattr(os, "access", lambda *_: False)
    assert "is not readable" in " ".join(str(converted([str(path)])["stderr"]).split())


def test_a_slip_gets_a_suggestion() -> None:
    result = CliRunner().invoke(app, ["chek", "a.8k"])
    assert result.exit_code == 2
    assert "Did you mean 'check'" in result.stderr


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder with the programs `-part.nc`, `-h.nc` and `--part.nc`, and a store."""
    monkeypatch.chdir(tmp_path)
    for name in ("-part.nc", "-h.nc", "--part.nc"):
        (tmp_path / name).write_text("F10 G1 X1\nM2\n")
    return tmp_path


@pytest.mark.parametrize(
    "words",
    [
        ["mill", "check", "-part.nc"],
        ["mill", "check", "--json", "-part.nc"],
        ["mill", "check", "-part.nc", "--json"],
        ["mill", "check", "--part.nc"],
        ["mill", "check", "--", "-part.nc"],
        ["mill", "check", "./-h.nc"],
        ["mill", "time", "-part.nc", "--dry"],
        ["mill", "plot", "-part.nc", "-part.svg"],
    ],
    ids=" ".join,
)
def test_a_file_may_have_a_minus_in_front(folder: Path, words: list[str]) -> None:
    (folder / "-part.svg").write_text("")
    result = CliRunner().invoke(app, words)
    assert result.exit_code == 0, result.output


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["check", "-lost.nc"], "No such option: -l (a file of this name is written ./-lost.nc)"),
        (["check", "./-lost.nc"], "error: -lost.nc: no such file"),
        (["check", "--lost.nc"], "No such option: --lost.nc"),
        (["check", "-x"], "No such option: -x"),
        (["check", "-part.nc", "-x.nc"], "(a file of this name is written ./-x.nc)"),
        (["check", "-part.nc", "--jsno"], "No such option: --jsno"),
        (["time", "-part.nc", "--", "-part.nc"], "(-part.nc)"),
    ],
)
def test_a_name_that_no_file_has_is_an_option_that_is_not_there(
    folder: Path, words: list[str], said: str
) -> None:
    result = CliRunner().invoke(app, ["mill", *words])
    assert result.exit_code == 2
    assert said in " ".join(result.output.split())
    if "-x" in words or any(word.startswith("--") for word in words):
        assert "is written" not in result.output


def test_the_version_is_shown() -> None:
    result = CliRunner().invoke(app, ["--version"])
    assert result.exit_code == 0
    assert result.stdout.startswith("openacr ")


def test_a_mistake_of_the_user_is_one_line_without_a_trace(tmp_path: Path) -> None:
    result = subprocess.run(
        [sys.executable, "-m", "openacr.cli.main", "run", str(tmp_path / "none")],
        capture_output=True,
        text=True,
        check=False,
    )
    assert result.returncode == 2
    assert result.stderr == f"error: {tmp_path / 'none'}: no such file or folder\n"


def test_an_interrupt_ends_quietly_with_130(tmp_path: Path) -> None:
    (tmp_path / "a.8k").write_text("REM")
    code = (
        "import openacr.cli.main as m, openacr.cli.run.command as r\n"
        "def stop(text): raise KeyboardInterrupt\n"
        "r.parse_until = stop\n"
        f"m.main(['run', {str(tmp_path / 'a.8k')!r}])\n"
    )
    result = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=False
    )
    assert result.returncode == 130
    assert "Traceback" not in result.stderr


@pytest.mark.parametrize("words", [(), ("run",), ("mill",), ("mill", "run"), ("sysvar", "get")])
def test_h_is_help_everywhere(words: tuple[str, ...]) -> None:
    short, long = (CliRunner().invoke(app, [*words, option]) for option in ("-h", "--help"))
    assert short.exit_code == 0
    assert short.output == long.output
    assert "Usage:" in short.output
