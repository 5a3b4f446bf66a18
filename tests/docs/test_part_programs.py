"""What docs/part-programs.md shows, works; the page of codes says what the tables say."""

import re
import shlex
from pathlib import Path

import pytest
from typer.testing import CliRunner

from openacr.cli.main import app
from openacr.cnc.codes.table import DIALECTS
from openacr.cnc.reference import page

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "docs" / "part-programs.md").read_text(encoding="utf-8")


def commands() -> list[list[str]]:
    """The commands of the page that need no machine."""
    blocks = re.findall(r"^```\n(.*?)^```$", TEXT, re.MULTILINE | re.DOTALL)
    lines = [line.split("   ")[0] for block in blocks for line in block.splitlines()]
    found = [shlex.split(line)[1:] for line in lines if line.startswith("openacr ")]
    long = shlex.split("mill run parts/plate.nc")  # minutes of machine time; its dry run is here
    return [words for words in found if "--host" not in words and words != long]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder with the programs, and measurements, in it."""
    monkeypatch.setenv("OPENACR_STORE", str(tmp_path / "sysvar.db"))
    monkeypatch.chdir(tmp_path)
    (tmp_path / "parts").symlink_to(ROOT / "parts")
    (tmp_path / "short.nc").write_text("G21 G90\nG1 X10 Y5 F600\nG2 X20 I5 J0\nG0 X0 Y0\nM2\n")
    (tmp_path / "measured.csv").write_text("0,0\n1,.99\n2,2\n3,3\n")
    (tmp_path / "X.BSC").write_text("X0E0\nX1E.01\n")
    return tmp_path


def test_the_page_shows_every_command_of_programs() -> None:
    assert {words[1] for words in commands()} >= {"check", "plot", "time", "run", "list"}


@pytest.mark.parametrize("words", commands(), ids=" ".join)
def test_a_command_of_the_page_works(folder: Path, words: list[str]) -> None:
    if "--trace" in words:  # of every 10 ms: the part of the page takes minutes of machine time
        words = ["short.nc" if each == "parts/plate.nc" else each for each in words]
    result = CliRunner().invoke(app, words)
    assert result.exit_code == 0, result.output
    assert result.output.strip()


def test_the_cells_of_the_page_are_known() -> None:
    for name in re.findall(r'openacr sysvar set "([^"]+)"', TEXT):
        result = CliRunner().invoke(app, ["sysvar", "get", name.split("=")[0]])
        assert result.exit_code == 0, name


def test_files_the_page_names_are_there() -> None:
    names = set(re.findall(r"`((?:parts|src)/[\w./]+)`", TEXT)) | set(
        re.findall(r"\]\(([\w./-]+)\)", TEXT)
    )
    for name in names:
        assert (ROOT / name).exists() or (ROOT / "docs" / name).exists(), name


def test_the_page_of_codes_is_up_to_date_and_complete() -> None:
    text = page()
    assert (ROOT / "docs" / "part-program-codes.md").read_text(encoding="utf-8") == text, (
        "run `make docs`"
    )
    for dialect in DIALECTS.values():
        for code in (*dialect.table.gcodes.values(), *dialect.table.mcodes.values()):
            assert code.summary in text
            assert code.summary.endswith(".")


def test_blocks_of_the_table_of_offsets_are_read_in_the_dialect_they_are_for(
    tmp_path: Path,
) -> None:
    rows = [row for row in TEXT.splitlines() if "`G10 L" in row and row.startswith("| ")]
    assert len(rows) == 3
    for row in rows:
        for part in row.split("|")[3].split(";"):
            named = [name for name in DIALECTS if f"({name})" in part] or list(DIALECTS)
            for block in re.findall(r"`(G10 [^`]+)`", part):
                for name in named:
                    file = tmp_path / "part.nc"
                    file.write_text(f"{block}\nM2\n")
                    words = ["mill", "check", str(file), "--dialect", name]
                    result = CliRunner().invoke(app, words)
                    assert result.exit_code == 0, f"{name}: {result.output}"
