"""`openacr conform`: cards against their manuals, on virtual cards and over TCP."""

import json
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from signal import SIGINT
from subprocess import PIPE, Popen

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


JOGS = """\
rests on: manual
source: 000 L4287

[case A jog by a length]
moves: 1 units at 2 units/s
changes: P12348, P12349, P12350
> AXIS0 JOG VEL 2
> AXIS0 JOG ACC 50
> AXIS0 JOG DEC 50
note P12297 as begin
> AXIS0 JOG INC 1
wait until BIT792 = 0 within 5 s
? (P12297-<begin>)/P12375 -> 1

[case A flag of the user]
changes: BIT128
> SET 128
? BIT128 -> -1

[case A sum]
> ?1+2
3
"""
SETTINGS = ("?P12604", "?P12605", "?P12606", "?BIT128", "?P12553", "?BIT824", "?BIT8499")


@pytest.fixture
def jogs(tmp_path: Path, card: Served) -> Path:
    """The cases, and axis 1 of the card at rest with settings of its user."""
    folder = tmp_path / "manual"
    folder.mkdir()
    (folder / "01-jogs.txt").write_text(JOGS)
    typed(card, "HALT ALL", "AXIS1 PPU 1000", "AXIS1 JOG VEL 7", "AXIS1 JOG ACC 30", "CLR 128")
    return tmp_path


def values(card: Served) -> list[float]:
    with card.call() as terminal:
        return [float(terminal.value(line)) for line in SETTINGS]


def test_an_axis_is_jogged_after_one_question_and_everything_is_put_back(
    jogs: Path, card: Served
) -> None:
    before = values(card)
    report = jogs / "report.json"
    words = ["conform", f"{LOOPBACK}:{card.ascii_port}", "--cases", str(jogs)]
    words += ["--report", str(report)]
    for options, answer, counts in (
        ([], "", (1, 2)), (["--setting"], "", (2, 1)),
        (["--moving", "axis1"], "y\n", (2, 1)), (["--moving", "1", "--setting"], "y\n", (3, 0)),
    ):  # fmt: skip
        result = CliRunner().invoke(app, [*words, *options], input=answer)
        assert result.exit_code == 0, result.output
        found = json.loads(report.read_text())["counts"]
        assert (found["agrees"], found["not run"]) == counts
        assert values(card) == before
        assert result.stderr.count("?") == bool(answer)
    assert "1 case will jog AXIS1 of 127.0.0.1:" in result.stderr
    assert "up to 1 units to either side of where it is, at up to 2 units/s" in result.stderr


def test_without_a_yes_nothing_moves(jogs: Path, card: Served) -> None:
    before = values(card)
    words = ["conform", f"{LOOPBACK}:{card.ascii_port}", "--cases", str(jogs), "--moving", "1"]
    for answer in ("n\n", ""):
        result = CliRunner().invoke(app, words, input=answer)
        assert (result.exit_code, result.stdout.strip(" yn\n")) == (1, "")
        assert values(card) == before


@contextmanager
def jogging(jogs: Path, card: Served) -> Iterator[tuple[Proxy, "Popen[str]"]]:
    """A run over a line while it jogs axis 1."""
    text = JOGS.replace("JOG INC 1", "JOG INC 8").replace("1 units at 2", "8 units at 2")
    (jogs / "manual" / "01-jogs.txt").write_text(text)
    before = values(card)[4]
    with closing(Proxy(f"{LOOPBACK}:{card.ascii_port}")) as line:
        words = ["conform", line.address, "--cases", str(jogs), "--moving", "1"]
        process = warm.Popen(words, stdin=PIPE, stderr=PIPE, text=True)
        assert process.stdin is not None
        process.stdin.write("y\n")
        process.stdin.flush()
        while values(card)[4] < before + 200:
            assert process.poll() is None
        try:
            yield line, process
        finally:
            process.kill()
            process.wait()
            for stream in (process.stdin, process.stderr):
                if stream is not None:
                    stream.close()


def test_ctrl_c_kills_the_motion_and_puts_the_settings_back(jogs: Path, card: Served) -> None:
    before = values(card)
    with jogging(jogs, card) as (_, process):
        process.send_signal(SIGINT)
        process.wait()
    after = values(card)
    assert after[:4] == before[:4]
    assert before[4] < after[4] < before[4] + 8000
    assert values(card) == after  # at rest, and the kill is taken back
    assert after[5:] == [0, 0]


def test_a_cut_line_ends_within_the_travel_and_the_settings_are_named(
    jogs: Path, card: Served
) -> None:
    before = values(card)
    with jogging(jogs, card) as (line, process):
        line.cut()
        _, error = process.communicate(timeout=60)
    assert process.returncode == 2
    assert "not put back: P12604=7, P12605=30, P12606=10" in error
    with card.call() as terminal:
        while terminal.value("?BIT824") != "0":
            pass
        assert float(terminal.value("?P12553")) == before[4] + 8000
        terminal.ask("AXIS1 JOG VEL 100")
        terminal.ask("AXIS1 JOG INC -8")
        while terminal.value("?BIT824") != "0":
            pass


@pytest.mark.parametrize("axis", ["X", "16", "AXIS16", "AXIS", "-1"])
def test_an_axis_is_a_number_of_the_card(axis: str) -> None:
    result = CliRunner().invoke(app, ["conform", LOOPBACK, f"--moving={axis}"])
    assert result.exit_code == 2
    assert result.stderr == f"error: --moving {axis}: expected AXIS0 to AXIS15\n"


def test_only_a_card_with_a_host_is_moved_and_set() -> None:
    for words in (["--moving", "1"], ["--setting"]):
        result = CliRunner().invoke(app, ["conform", *words])
        assert result.exit_code == 2
        assert "--moving and --setting are for a card with a HOST" in result.stderr
