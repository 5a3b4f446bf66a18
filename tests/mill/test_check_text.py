"""A part program that is being edited is checked as its file would be."""

from pathlib import Path

import pytest

from openacr.cli.mill.check import in_folder, loaded
from openacr.mill.plan.estimate.checking import check_text, checked
from openacr.panel.work.paths import check_text as check_on_panel
from openacr.sysvar import Store

INCLUDING = "G1 X1 F100\nGOSUB 100\nM2\n$I sub.txt\n"


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.nc", "G1 X1\nG1 Q2 F5\nGOTO 7\nM2\n"),
        ("b.ngc", "O100 sub\n#<x> = [1 +\nO100 endsub\nM2\n"),
        ("c.nc", ";dialect rs274ngc\n#<x> = 1\nM2\n"),
        ("d.nc", INCLUDING),
        ("e.nc", "G1 X1e9 F100\nM2\n"),
    ],
)
def test_a_text_has_the_findings_of_its_file(tmp_path: Path, name: str, text: str) -> None:
    (tmp_path / "sub.txt").write_text("N100 G4 F1\nRET\n")
    file = tmp_path / name
    with Store() as cells:
        found = check_text(text, file, cells)
        file.write_text(text)
        program, dialect = loaded(file, cells, None)
        expected = checked(program, cells, dialect)[0].findings
    assert found == expected
    assert in_folder(found, file) == in_folder(expected, file)
    assert bool(found) is (name not in ("c.nc", "d.nc"))


def test_files_beside_the_text_are_included(tmp_path: Path) -> None:
    (tmp_path / "sub.txt").write_text("N100 G4 F1\nRET\n")
    store = tmp_path / "store" / "sysvar.db"
    store.parent.mkdir()
    with Store(store) as cells:
        assert check_text(INCLUDING, tmp_path / "d.nc", cells) == []
        missing = check_text(INCLUDING, tmp_path / "store" / "d.nc", cells)
    assert [(each.code, each.line) for each in missing] == [("E220", 2), ("E262", 4)]
    assert check_on_panel(INCLUDING, "d.nc", tmp_path, store, "acromill").findings == []
