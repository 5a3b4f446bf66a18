"""`openacr mill ballscrew`: tables in files, and in the store."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from openacr.cli.main import app
from openacr.mill.session import MillSession
from openacr.sysvar import Store

TABLE = "X0E.00325\nX1E.00175\nX2E-.00250\n"


def ballscrew(*words: object) -> tuple[int, str]:
    result = CliRunner().invoke(app, ["mill", "ballscrew", *map(str, words)])
    return result.exit_code, result.output


@pytest.fixture
def table(tmp_path: Path) -> Path:
    file = tmp_path / "X.BSC"
    file.write_text(TABLE)
    return file


@pytest.mark.req("MILL-BSC-FILE")
def test_an_imported_table_acts_on_the_machine_and_is_exported_again(
    table: Path, tmp_path: Path, own_store: Path
) -> None:
    code, text = ballscrew("import", "x", table)
    assert code == 0
    assert "3 positions from 0 to 2, largest error 0.00325" in text
    table.unlink()
    assert ballscrew("export", "X") == (0, TABLE)
    assert ballscrew("export", "X", tmp_path / "copy.txt")[0] == 0
    assert (tmp_path / "copy.txt").read_text() == TABLE
    with Store(own_store) as store:
        shop = MillSession.virtual(store, lambda _text: None)
        for _ in range(5):
            shop.step()
        assert shop.card.read(12295) - shop.card.read(12294) in (32, 33)


@pytest.mark.req("MILL-BSC-FILE-BAD")
def test_a_table_with_a_bad_line_is_not_loaded(table: Path, own_store: Path) -> None:
    table.write_text(TABLE + "X3\n")
    code, text = ballscrew("import", "X", table)
    assert (code, text) == (2, f"error: {table}:4: 'X3' is not like X1E.00175\n")
    with Store(own_store) as store:
        assert store.read(950_010) == 0
        assert store.read_text(950_020) == ""


def test_a_table_is_made_of_measurements(tmp_path: Path) -> None:
    file = tmp_path / "measured.csv"
    file.write_text("N,n1,n2\n0,0,0\n1,.99,1\n2,2,2\n")
    assert ballscrew("from-measurements", "X", file, "--home", "1") == (
        0,
        "X0E.00500\nX1E.00000\nX2E.00000\n",
    )
    code, text = ballscrew("from-measurements", "Y", file, "-o", tmp_path / "Y.BSC")
    assert code == 0
    assert "3 positions from 0 to 2" in text


def test_what_is_not_there_is_named(tmp_path: Path, table: Path, own_store: Path) -> None:
    assert ballscrew("export", "X")[1].startswith("error: axis X has no ballscrew table (P950020)")
    assert (
        ballscrew("import", "W", table)[1]
        == "error: axis W is not configured; configured are X Y Z\n"
    )
    assert "no such file" in ballscrew("import", "X", tmp_path / "none")[1]
    with Store(own_store) as store:
        store.write(950_011, 1)
    file = tmp_path / "P.NC"
    file.write_text("M2\n")
    result = CliRunner().invoke(app, ["mill", "run", str(file)])
    assert (result.exit_code, result.output) == (
        2,
        "error: the ballscrew table of Y is on, but has no file: P950021\n",
    )
