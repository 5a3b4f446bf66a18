"""What docs/sysvar.md shows, works."""

import re
import shlex
from pathlib import Path

import pytest
from typer.testing import CliRunner

from openacr.cli.main import app
from openacr.sysvar.reference import page

DOCS = Path(__file__).parents[2] / "docs"
TEXT = (DOCS / "sysvar.md").read_text(encoding="utf-8")


def blocks(kind: str) -> list[str]:
    return re.findall(rf"```{kind}\n(.*?)```", TEXT, re.DOTALL)


def test_the_python_of_the_page_runs(capsys: pytest.CaptureFixture[str]) -> None:
    (code,) = blocks("python")
    exec(compile(code, "sysvar.md", "exec"), {})
    assert capsys.readouterr().out.splitlines() == ["10.0", "X H length 1", "{150}"]


def test_the_commands_of_the_page_work(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OPENACR_STORE", str(tmp_path / "s.db"))
    monkeypatch.chdir(tmp_path)
    (commands,) = blocks("")
    for line in commands.splitlines():
        words = shlex.split(line.split("   ")[0])[1:]
        if "password" in words:
            words += ["--new", "x"]
        result = CliRunner().invoke(app, words)
        assert result.exit_code == 0, (words, result.output)


def test_the_tables_are_up_to_date() -> None:
    assert (DOCS / "sysvar-tables.md").read_text(encoding="utf-8") == page(), "run `make docs`"
