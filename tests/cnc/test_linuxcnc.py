"""Programs of the rs274ngc dialect: their canonical entries, and LinuxCNC's moves for the same."""

from pathlib import Path

import pytest
from tests.cnc.linuxcnc import compare, compare_texts, judged, needs_linuxcnc, own, texts
from tests.cnc.ngc_programs import PROGRAMS, is_judged, listed, run_of

from openacr.cnc.interpreter.interpreter import Options

NAMES = [pytest.param(path, id=path.stem) for path in PROGRAMS]
JUDGED = [pytest.param(path, id=path.stem) for path in PROGRAMS if is_judged(path)]


@pytest.mark.parametrize("path", NAMES)
def test_a_program_comes_to_the_entries_that_are_written_down(path: Path) -> None:
    assert listed(run_of(path)) == path.with_suffix(".txt").read_text(encoding="utf-8")


@pytest.mark.parametrize("path", NAMES)
def test_many_blocks_at_once_come_to_the_same(path: Path) -> None:
    done = run_of(path, Options(has_batches=True))
    assert listed(done) == path.with_suffix(".txt").read_text(encoding="utf-8")


@pytest.mark.parametrize("path", NAMES)
def test_every_program_says_what_its_entries_are_judged_by(path: Path) -> None:
    title, evidence, *_ = path.read_text(encoding="utf-8").splitlines()
    assert title.startswith("(")
    assert evidence.startswith(("; LinuxCNC", "; closed form"))


@needs_linuxcnc
@pytest.mark.parametrize("path", JUDGED)
def test_the_moves_are_those_of_linuxcnc(path: Path, tmp_path: Path) -> None:
    theirs = judged(path.read_text(encoding="utf-8"), tmp_path)
    done = run_of(path)
    assert done.error is None
    compare(own(done), theirs.moves)
    compare_texts(texts(done), theirs.texts)
