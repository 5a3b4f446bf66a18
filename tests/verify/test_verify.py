"""`openacr verify`: every program of a folder, whatever the files are."""

import json
import os
import signal
import sys
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree as Xml

import pytest
from typer.testing import CliRunner

from openacr.cli.main import app
from openacr.cnc.interpreter.by_block import loops
from openacr.cnc.state.cells import LAST_RADIUS, RADII
from openacr.verify import checking
from openacr.verify.checking import Status, Task, check, check_all
from openacr.verify.programs import programs
from openacr.workers import LocalPool

GOOD = "G21 F600\nG0 X1 Y2\nG1 X11\nM2\n"
WRONG = "F10\nG1 X5\nX\nG1 Y(\nM2\n"
ENDLESS = "F1\nG0 X0\nN10 G1 X1\nP200=P200+1\nX0\nGOTO 10\n"
SILENT = "N10 P200=P200+1\nGOTO 10\n"
STOCK = "G21 F600\nG10 L12 P1 R3\nT1 M6\nG0 X1 Y1 Z5\nG1 Z-2\nG0 X20\nG1 X30\nG0 Z5\nM2\n"


@pytest.fixture
def shop(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder of programs; the machine is the default one."""
    monkeypatch.setenv("OPENACR_STORE", str(tmp_path / "sysvar.db"))
    folder = tmp_path / "shop"
    (folder / "jobs" / "old").mkdir(parents=True)
    (folder / "good.nc").write_text(GOOD)
    (folder / "jobs" / "wrong.NC").write_text(WRONG)
    (folder / "jobs" / "old" / "best.ngc").write_text(GOOD)
    (folder / "jobs" / "notes.txt").write_text(WRONG)
    (folder / ".hidden.nc").write_text(WRONG)
    return folder


def run(*words: object, code: int = 0) -> str:
    result = CliRunner().invoke(app, ["verify", *map(str, words)])
    assert result.exit_code == code, result.output
    return result.output


def test_all_programs_of_a_folder_are_found_in_their_order(shop: Path) -> None:
    names = [str(path.relative_to(shop)) for path in programs(shop)]
    assert names == ["good.nc", "jobs/old/best.ngc", "jobs/wrong.NC"]
    assert [path.name for path in programs(shop, ["*.TXT", "g*"])] == ["good.nc", "notes.txt"]


def test_a_table_lists_every_program_and_the_errors_with_their_places(shop: Path) -> None:
    text = run(shop, "--workers", 1, code=1)
    lines = text.splitlines()
    assert lines[:5] == [
        "program            result      errors  warnings     time  tools",
        "good.nc            ok               0         0     0:01",
        "jobs/old/best.ngc  ok               0         0     0:01",
        "jobs/wrong.NC      errors           2         0        -",
        "3 programs: 2 good, 1 not",
    ]
    assert lines[5].startswith(f"{shop}/jobs/wrong.NC:3:2: E105 value expected")
    assert lines[6].startswith(f"{shop}/jobs/wrong.NC:4:6: E105 value expected")
    assert len(lines) == 7


def test_the_exit_code_is_0_without_errors(shop: Path) -> None:
    (shop / "jobs" / "wrong.NC").unlink()
    assert "2 programs: 2 good, 0 not" in run(shop, "--workers", 1)


def test_json_has_the_verdict_of_each_program(shop: Path) -> None:
    report = json.loads(run(shop, "--workers", 1, "--json", code=1))
    assert report["counts"] == {"ok": 2, "errors": 1}
    good, _, wrong = report["programs"]
    alone = CliRunner().invoke(app, ["mill", "time", str(shop / "good.nc"), "--json"])
    assert good["time_s"] == pytest.approx(json.loads(alone.stdout)["time_s"], abs=1e-4)
    assert good["extents"] == {"X": [pytest.approx(1.0), pytest.approx(11.0)]}
    assert (good["name"], good["unit"], good["lines"]) == ("good.nc", "mm", 4)
    assert [note["code"] for note in wrong["notes"]] == ["E105", "E105"]
    assert (wrong["time_s"], wrong["is_good"], wrong["status"]) == (None, False, "errors")


def test_the_junit_file_has_a_case_for_each_program(shop: Path) -> None:
    (shop / "bell.nc").write_bytes(b"G0 X1\n\x01\x02\n")
    path = shop.parent / "found.xml"
    run(shop, "--workers", 1, "--junit", path, code=1)
    root = Xml.parse(path).getroot()
    counts = {"tests": "4", "failures": "1", "errors": "1", "skipped": "0"}
    (suite,) = root
    assert (root.tag, suite.tag, suite.attrib) == (
        "testsuites", "testsuite", {"name": str(shop), **counts},
    )  # fmt: skip
    cases = {case.attrib["name"]: case for case in suite}
    assert list(cases) == ["bell.nc", "good.nc", "best.ngc", "wrong.NC"]
    assert cases["best.ngc"].attrib["classname"] == "jobs.old"
    assert cases["good.nc"].attrib["classname"] == "programs"
    assert float(cases["good.nc"].attrib["time"]) == pytest.approx(1.1, abs=0.3)
    assert list(cases["good.nc"]) == []
    (failure,) = cases["wrong.NC"]
    assert (failure.tag, failure.attrib["type"]) == ("failure", "errors")
    assert failure.attrib["message"] == "value expected after letter"
    assert failure.text is not None and len(failure.text.splitlines()) == 2
    (error,) = cases["bell.nc"]
    assert (error.tag, error.attrib["type"]) == ("error", "unreadable")
    assert "byte 0x01 at offset 6" in error.attrib["message"]


def test_a_warning_goes_with_a_case_that_is_met(shop: Path) -> None:
    (shop / "coolant.nc").write_text("F10\nM8\nG1 X1\nM2\n")
    path = shop.parent / "found.xml"
    run(shop, "--files", "coolant.nc", "--workers", 1, "--junit", path)
    (case,) = Xml.parse(path).getroot()[0]
    (output,) = case
    assert output.tag == "system-out"
    assert output.text == (
        f"{shop}/coolant.nc:2:1: W405 nothing is wired to the code: M8 (P800010)"
    )


def _binary(path: Path) -> None:
    path.write_bytes(bytes(range(256)))


def _empty(path: Path) -> None:
    path.write_bytes(b"")


def _wide(path: Path) -> None:
    path.write_text(GOOD, encoding="utf-16")


def _loose(path: Path) -> None:
    path.symlink_to(path.parent / "nowhere.nc")


def _folder_link(path: Path) -> None:
    path.symlink_to(path.parent / "jobs")


@pytest.mark.parametrize(
    ("make", "status", "reason"),
    [
        (_binary, Status.UNREADABLE, "not a text file: byte 0x01 at offset 1"),
        (_wide, Status.UNREADABLE, "the file is UTF-16"),
        (_loose, Status.UNREADABLE, "no such file"),
        (_folder_link, Status.UNREADABLE, "this is a folder, not a part program"),
        (_empty, Status.OK, ""),
    ],
)
def test_a_bad_file_is_a_verdict_among_others(
    shop: Path, make: Callable[[Path], None], status: Status, reason: str
) -> None:
    make(shop / "bad.nc")
    report = json.loads(run(shop, "--workers", 1, "--json", code=1))
    bad, good = report["programs"][:2]
    assert (bad["name"], bad["status"], good["status"]) == ("bad.nc", status, "ok")
    assert reason in bad["reason"]


def test_a_name_that_is_no_text_is_shown(shop: Path) -> None:
    path = Path(os.fsdecode(bytes(shop) + b"/b\xffd.nc"))
    path.write_text(WRONG)
    junit, page = shop.parent / "a.xml", shop.parent / "a.html"
    text = run(shop, "--workers", 1, "--junit", junit, "--html", page, code=1)
    assert "4 programs: 2 good, 2 not" in text
    assert len(Xml.parse(junit).getroot()[0]) == 4


def test_a_program_that_does_not_end_is_stopped_at_its_limit_of_machine_time(shop: Path) -> None:
    (shop / "endless.nc").write_text(ENDLESS)
    verdict = check(Task(shop / "endless.nc", limit_s=600.0))
    assert verdict.status is Status.TOO_LONG
    assert verdict.reason == "it takes more than 600 s of machine time"
    assert check(Task(shop / "good.nc", limit_s=600.0)).status is Status.OK
    text = run(shop, "--workers", 1, "--limit", 0.5, "--files", "*.nc", code=1)
    assert "endless.nc     too long         0         0        -" in text
    assert f"{shop}/good.nc: it takes more than 0.5 s of machine time" in text


def test_a_program_that_does_not_move_and_not_end_is_an_error_of_its_jump(
    shop: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(loops, "MOST_PASSES", 1000)
    (shop / "silent.nc").write_text(SILENT)
    (note,) = check(Task(shop / "silent.nc")).notes
    assert (note.code, note.line) == ("A62", 2)


def test_a_rapid_through_the_stock_is_an_error_only_with_stock(shop: Path) -> None:
    (shop / "stock.nc").write_text(STOCK)
    verdict = check(Task(shop / "stock.nc", has_stock=True))
    assert list(map(str, verdict.errors)) == [
        f"{shop / 'stock.nc'}:6:1: a rapid goes through material"
    ]
    assert verdict.removed is not None and verdict.removed > 0.0
    assert verdict.status is Status.ERRORS
    verdict = check(Task(shop / "stock.nc"))
    assert (verdict.errors, verdict.removed) == ([], None)


def test_tools_without_a_radius_in_the_store_are_marked(shop: Path) -> None:
    (shop / "tools.nc").write_text("F10\nT4 M6\nG1 X1\nT2 M6\nX2\nT4 M6\nX1\nM2\n")
    assert check(Task(shop / "tools.nc")).tools == (4, 2)
    assert check(Task(shop / "tools.nc")).without_radius == (2, 4)
    CliRunner().invoke(app, ["sysvar", "set", f"P{RADII + 4}=3"], catch_exceptions=False)
    assert check(Task(shop / "tools.nc")).without_radius == (2,)
    text = run(shop, "--files", "tools.nc", "--workers", 1)
    assert text.splitlines()[1].endswith("  T4 T2*")
    assert "*: the store has no radius of this tool" in text


def fatal(task: Task) -> checking.Verdict:
    """Ends the process of `wrong.NC`, as a fault of the interpreter would."""
    if task.file.name == "wrong.NC":
        os.kill(os.getpid(), signal.SIGKILL)
    return check(task)


@pytest.mark.skipif(sys.platform == "win32", reason="SIGKILL")
def test_a_program_whose_process_dies_is_lost_alone(
    shop: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(checking, "check", fatal)
    with LocalPool(2) as pool:
        verdicts = sorted(
            check_all([Task(path) for path in programs(shop)], pool), key=lambda each: each.file
        )
    assert [(each.status, each.reason) for each in verdicts] == [
        (Status.OK, ""), (Status.OK, ""), (Status.LOST, "the worker process died"),
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("nowhere",), "error: nowhere: no such folder"),
        (("shop/good.nc",), "error: shop/good.nc: not a folder"),
        (("shop", "--files", "*.iso"), "error: shop: no part programs (*.iso; --files names"),
        (("shop", "--limit", "0"), "error: --limit 0: give seconds above 0, at most 1000000000"),
        (("shop", "--html", "a.pdf"), "error: a.pdf: its name has to end in .html"),
        (("shop", "--junit", "a.html"), "error: a.html: its name has to end in .xml"),
        (("shop", "--junit", "nowhere/a.xml"), "error: nowhere/a.xml: cannot be written"),
        (("shop", "--store", "none.db"), "error: none.db does not exist"),
    ],
)
def test_wrong_words_are_refused_with_the_reason(
    shop: Path, monkeypatch: pytest.MonkeyPatch, words: tuple[str, ...], message: str
) -> None:
    monkeypatch.chdir(shop.parent)
    assert run(*words, code=2).startswith(message)


def test_the_page_is_one_file_that_names_no_other(shop: Path) -> None:
    page = shop.parent / "found.html"
    run(shop, "--workers", 1, "--html", page, code=1)
    text = page.read_text()
    assert "<title>Part programs of " in text
    assert "http" not in text.replace("http://www.w3.org", "")
    assert "value expected after letter" in text


def test_the_last_tool_with_a_radius_in_the_store_is_not_marked(shop: Path) -> None:
    (shop / "tools.nc").write_text(
        f"F10\nT{LAST_RADIUS} M6\nG1 X1\nT{LAST_RADIUS + 1} M6\nX2\nM2\n"
    )
    cell = RADII + LAST_RADIUS
    CliRunner().invoke(app, ["sysvar", "set", f"P{cell}=3"], catch_exceptions=False)
    assert check(Task(shop / "tools.nc")).without_radius == (LAST_RADIUS + 1,)
