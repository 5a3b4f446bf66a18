"""Programs of the rs274ngc dialect: their canonical entries, and LinuxCNC's moves for the same."""

from pathlib import Path

import pytest
from tests.cnc.linuxcnc import (
    compare,
    compare_texts,
    golden,
    judged,
    needs_linuxcnc,
    own,
    printed,
    texts,
)
from tests.cnc.ngc_programs import FOLDER, PROGRAMS, is_judged, listed, run_of

from openacr.cnc.interpreter.interpreter import Options

NAMES = [pytest.param(path, id=path.stem) for path in PROGRAMS]
JUDGED = [pytest.param(path, id=path.stem) for path in PROGRAMS if is_judged(path)]
pytestmark = pytest.mark.evidence("oracle", "rs274 -g of LinuxCNC")


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


def test_the_programs_that_linuxcnc_judges_have_its_lines_and_no_others() -> None:
    kept = {path.stem for path in FOLDER.glob("*.canon")}
    assert kept == {path.stem for path in filter(is_judged, PROGRAMS)}, (
        "python -m tests.cnc.linuxcnc, where rs274 is installed, writes them"
    )


@pytest.mark.parametrize("path", JUDGED)
def test_the_moves_are_those_of_linuxcnc(path: Path) -> None:
    theirs = judged(path)
    done = run_of(path)
    assert done.error is None
    compare(own(done), theirs.moves)
    compare_texts(texts(done), theirs.texts)


@needs_linuxcnc
def test_the_lines_that_are_kept_of_linuxcnc_are_what_it_prints() -> None:
    kept = {
        path.stem: golden(path).read_text(encoding="utf-8") for path in filter(is_judged, PROGRAMS)
    }
    assert kept == {path.stem: printed(path) for path in filter(is_judged, PROGRAMS)}
