"""`openacr conform`: cards against their manuals, on virtual cards and over TCP."""

import json
import time
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import pytest
from tests import warm
from tests.io.served import LOOPBACK, Served, serving
from tests.proxy import Proxy
from typer.testing import CliRunner

from openacr.cli.main import app

CASES = """\
rests on: manual

[case Sums]
proves: ACR-EVAL-01
source: 000 L2494
> ?1+2
3

[case Variables]
source: 000 L2494
> DIM P(1)
> P0=7
> ?P0
7
"""


@pytest.fixture
def cases(tmp_path: Path) -> Path:
    folder = tmp_path / "manual"
    folder.mkdir()
    (folder / "01-first.txt").write_text(CASES)
    (folder / "02-second.txt").write_text(CASES.replace("Sums", "Products").replace("1+2", "1*3"))
    return tmp_path


@pytest.fixture(scope="module")
def card() -> Iterator[Served]:
    with serving() as served:
        yield served


def typed(card: Served, *lines: str) -> str:
    """What a terminal of the card shows for lines; it begins at the system level."""
    with card.call() as terminal:
        return "".join(terminal.ask(line) for line in lines)


def test_a_table_of_sections_and_what_differs(cases: Path) -> None:
    good = CliRunner().invoke(app, ["conform", "--cases", str(cases)])
    assert good.exit_code == 0
    assert good.stdout.splitlines() == [
        "section           agrees  differs  not run  not for this model",
        "manual/01-first        2        -        -                   -",
        "manual/02-second       2        -        -                   -",
        "virtual ACR9000: 4 cases, 4 agree, 0 differ, 0 not run, 0 not for this model",
    ]
    file = cases / "manual" / "02-second.txt"
    file.write_text(file.read_text().replace("?P0\n7", "?P0\n8"))
    bad = CliRunner().invoke(app, ["conform", "--cases", str(cases), "--area", "second"])
    assert bad.exit_code == 1
    assert (
        bad.stdout.splitlines()[-1]
        == "virtual ACR9000: 2 cases, 1 agree, 1 differ, 0 not run, 0 not for this model"
    )
    assert bad.stderr.splitlines() == [
        f'{file}:14: in "Variables"', "  8", "expected: 8", "shown:    7",
        "  rests on: manual (000 L2494)",
    ]  # fmt: skip


def test_a_report_holds_card_and_outcomes(cases: Path, tmp_path: Path) -> None:
    report = tmp_path / "report.json"
    words = ["conform", "--cases", str(cases), "--model", "ACR8020", "--area", "first", "--json"]
    result = CliRunner().invoke(app, [*words, "--report", str(report)])
    assert json.loads(result.stdout) == json.loads(report.read_text())
    found = json.loads(report.read_text())
    assert found["card"] == {"kind": "virtual", "model": "ACR8020"}
    assert found["counts"] == {"agrees": 2, "differs": 0, "not run": 0, "not for this model": 0}
    assert found["cases"][0] == {
        "section": "manual/01-first", "case": "Sums", "line": 3, "result": "agrees",
        "proves": ["ACR-EVAL-01"], "source": "000 L2494", "rests_on": "manual",
    }  # fmt: skip


def test_a_card_in_use_is_asked_and_keeps_what_it_has(cases: Path, card: Served) -> None:
    typed(card, "CLEAR", "DIM P(5)", "P0=3")
    address = f"{LOOPBACK}:{card.ascii_port}"
    result = CliRunner().invoke(app, ["conform", address, "--cases", str(cases), "--json"])
    found = json.loads(result.stdout)
    assert found["counts"] == {"agrees": 2, "differs": 0, "not run": 2, "not for this model": 0}
    assert found["card"]["version"] == "ACR9000 Version 1.18.06 Update 15"
    assert found["cases"][1]["why"] == "line 11: `DIM P(1)` may change the card"
    assert typed(card, "?P0") == "?P0\r\n3\r\nSYS>"


def test_a_card_on_which_a_program_runs_is_refused(cases: Path, card: Served) -> None:
    typed(card, "CLEAR", "DIM PROG2(500)", "PROG2", "10 GOTO 10", "RUN")
    address = f"{LOOPBACK}:{card.ascii_port}"
    result = CliRunner().invoke(app, ["conform", address, "--cases", str(cases)])
    typed(card, "HALT PROG2")
    assert result.exit_code == 2
    assert result.stderr == f"error: {address}: PROG2 runs: stop it first, then ask the card\n"


def test_a_run_that_is_killed_leaves_the_card_as_it_was(cases: Path, card: Served) -> None:
    sums = "".join(f"\n[case Sum {n}]\nsource: 000 L2494\n> ?1+{n}\n{n + 1}\n" for n in range(500))
    (cases / "manual" / "01-first.txt").write_text(CASES + sums)
    typed(card, "CLEAR", "DIM P(5)", "P0=3", "DIM PROG2(500)", "PROG2", "10 P1=1")
    report = cases / "report.json"
    with closing(Proxy(f"{LOOPBACK}:{card.ascii_port}")) as line:
        words = ["conform", line.address, "--cases", str(cases), "--report", str(report)]
        process = warm.Popen(words)
        while line.passed < 2000:
            assert process.poll() is None
            time.sleep(0.01)
        process.kill()
        process.wait()
    assert not report.exists()
    assert typed(card, "?P0", "PROG2", "LIST") == (
        "?P0\r\n3\r\nSYS>PROG2\r\nP02>LIST\r\n10 P1 = 1\r\nP02>"
    )


@pytest.mark.parametrize(
    ("words", "refusal"),
    [
        (["--model", "ACR1"], "--model ACR1: the models are ACR1200, "),
        (["--area", "weather"], "--area weather: the sections are first, second; or an id"),
        (["--report", "r.txt"], "r.txt: its name has to end in .json"),
        (["127.0.0.1:1"], "cannot connect to 127.0.0.1:1: "),
        (["127.0.0.1", "--model", "ACR8020"], "--model is that of a virtual card"),
    ],
)
def test_what_cannot_be_done_is_refused_in_one_line(
    cases: Path, words: list[str], refusal: str
) -> None:
    result = CliRunner().invoke(app, ["conform", "--cases", str(cases), *words])
    assert result.exit_code == 2
    assert result.stderr.startswith(f"error: {refusal}")
    assert result.stderr.count("\n") == 1
