"""`openacr replay`, with journals of `openacr run` and of a served card that was killed."""

import json
import time
from pathlib import Path

import pytest
from tests.io.served import serving
from typer.testing import CliRunner, Result

from openacr.cli.main import app
from openacr.controller import Controller
from openacr.controller.recorder import Recorder
from openacr.controller.ring import journals

BLINK = "DIM P(2)\nPROG0\nPROGRAM\nPBOOT\n_L\nP0 = P0 + 1\nPRINT P0\nDWL 0.3\nGOTO L\nENDP\n"


@pytest.fixture
def blink(tmp_path: Path) -> Path:
    path = tmp_path / "blink.8k"
    path.write_text(BLINK)
    return path


def openacr(*words: object) -> Result:
    return CliRunner().invoke(app, [str(word) for word in words])


@pytest.fixture
def journal(blink: Path, tmp_path: Path) -> Path:
    path = tmp_path / "a.journal"
    assert openacr("run", blink, "--for", 1.5, "--journal", path, "--quiet").exit_code == 0
    return path


def test_a_run_is_replayed_with_what_it_printed(journal: Path, blink: Path) -> None:
    blink.unlink()  # the journal is enough
    result = openacr("replay", journal)
    assert result.exit_code == 0
    assert result.stdout.startswith("1\n2\n3\n4\n")
    assert "PROG0" in result.stdout
    assert "1.5 s replayed, 0 entries: 2 digests equal" in result.stderr


def test_the_report_counts_from_the_beginning_of_the_journal_after_a_restart(
    tmp_path: Path,
) -> None:
    card = Controller()
    card.advance(seconds=0.4)
    card.send("REBOOT\r")
    card.advance(seconds=0.2)
    card.recorder = Recorder(card, tmp_path / "b.journal")
    card.advance(seconds=0.5)
    card.close()
    assert (card.lived_tk, card.tick) == (2200, 1400)
    result = openacr("replay", tmp_path / "b.journal")
    assert "0.5000 s simulated in 1000 ticks" in result.stdout


def test_check_says_one_line(journal: Path) -> None:
    result = openacr("replay", journal, "--check")
    assert result.exit_code == 0
    assert result.output == "1.5 s replayed, 0 entries: 2 digests equal\n"


def moved(folder: Path) -> Path:
    """The journal of a card whose axis X has moved by 0.02 units."""
    path, program = folder / "m.journal", folder / "move.prg"
    program.write_text(
        'PROG0\nATTACH MASTER0\nATTACH SLAVE0 AXIS0 "X"\nPPU X1000\nACC 0 DEC 0 STP 0 VEL 10\n'
        "10 X.02\n"
    )
    assert openacr("run", program, "--for", 0.2, "--journal", path, "--quiet").exit_code == 0
    return path


@pytest.mark.parametrize(("every", "rows"), [((), 400), (("--trace-every", 4), 100)])
def test_the_motion_in_a_journal_is_written_tick_by_tick(
    tmp_path: Path, every: tuple[object, ...], rows: int
) -> None:
    trace = tmp_path / "t.csv"
    result = openacr("replay", moved(tmp_path), "--check", "--trace", trace, *every)
    assert (result.exit_code, result.output.count("digests equal")) == (0, 1)
    head, *lines = trace.read_text().splitlines()
    names = head.split(",")
    assert names[:2] == ["time_s", "axis_0_commanded"]
    assert len(lines) == rows
    x = [float(line.split(",")[1]) for line in lines]
    assert (x[0], x[-1], x == sorted(x)) == (0.0, 0.02, True)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--trace", "t.csv"), "--trace is for one journal: name it"),
        (("a.journal", "--trace", "t.xls"), "t.xls: traces end in .csv or .parquet"),
        (("a.journal", "--trace", "no/t.csv"), "there is no folder no"),
    ],
)
def test_a_trace_that_cannot_be_written_is_refused(
    journal: Path, monkeypatch: pytest.MonkeyPatch, words: tuple[str, ...], message: str
) -> None:
    monkeypatch.chdir(journal.parent)
    result = openacr("replay", *words)
    assert (result.exit_code, message in result.output) == (2, True)


def test_the_journal_changes_nothing(blink: Path, journal: Path, tmp_path: Path) -> None:
    summary = tmp_path / "summary.json"
    openacr("run", blink, "--for", 1.5, "--summary", summary, "--quiet")
    last = json.loads(journal.read_text().splitlines()[-1])
    assert last[1:] == ["end", json.loads(summary.read_text())["digest"]]


def test_until_stops_in_time(journal: Path) -> None:
    result = openacr("replay", journal, "--until", 1.2)
    assert "1.2 s replayed, 0 entries: 1 digests equal" in result.stderr
    result = openacr("replay", journal, "--until", 0.5, "--check")
    assert result.exit_code == 2
    assert "no digest was reached" in result.stderr
    assert openacr("replay", journal, "--until", -1).exit_code == 2


def test_another_state_is_found(journal: Path) -> None:
    lines = journal.read_text().splitlines()
    tick = json.loads(lines[2])[0]
    lines.insert(2, f'[{tick - 5}, "parameter", 1, 7.0]')
    journal.write_text("\n".join([*lines, ""]))
    result = openacr("replay", journal, "--check")
    assert result.exit_code == 1
    assert f"the state differs from the journal at 1 s (tick {tick})" in result.stderr
    assert openacr("replay", journal).exit_code == 0


def test_a_torn_journal_is_replayed_to_its_last_record(journal: Path) -> None:
    journal.write_bytes(journal.read_bytes()[:-20])
    result = openacr("replay", journal, "--check")
    assert result.exit_code == 0
    assert "was not closed" in result.stderr
    assert "1 s replayed, 0 entries: 1 digests equal" in result.stdout


@pytest.mark.parametrize("content", [None, b"", b"PROG0\n"])
def test_what_is_no_journal_is_bad_input(tmp_path: Path, content: bytes | None) -> None:
    path = tmp_path / "x"
    if content is not None:
        path.write_bytes(content)
    result = openacr("replay", path)
    assert result.exit_code == 2
    assert result.stderr.startswith("error: ")


def test_a_journal_that_cannot_be_written_is_refused_before_the_run(blink: Path) -> None:
    result = openacr("run", blink, "--journal", "/no/such/folder/a")
    assert result.exit_code == 2
    assert "/no/such/folder" in result.stderr


# serve


def await_digest(journal: Path) -> None:
    """Wait for the first digest; long before that is due everything has been typed."""
    for _ in range(600):
        if b'"digest", "' in journal.read_bytes():
            return
        time.sleep(0.1)
    raise AssertionError("no digest is written")


def test_a_killed_card_has_its_data_and_its_last_minutes(tmp_path: Path) -> None:
    data = tmp_path / "data"
    with serving("--data", data, "--speed", "4") as served, served.call() as host:
        for line in (
            "DIM P(3)",
            "PROG0",
            "10 PBOOT",
            "20 P1 = P1 + 1",
            "30 DWL 0.01",
            "40 GOTO 20",
        ):
            host.ask(line)
        host.ask("SYS")
        host.ask("FLASH SAVE")
        host.ask("AXIS0 PPU 77")
        host.ask("ESAVE")
        host.ask("PBOOT")
        (journal,) = journals(data / "journal")
        await_digest(journal)
        assert int(host.value("?P1")) > 5
        served.process.kill()
    result = openacr("replay", journal, "--check")
    assert result.exit_code == 0, result.output
    assert "was not closed" in result.stderr
    with serving("--data", data) as served, served.call() as host:
        assert host.value("AXIS0 PPU") == "77"
        assert host.value("?BIT1024") == "-1"  # PBOOT
        assert served.end()[0] == 0
    assert len(journals(data / "journal")) == 2


def test_a_served_card_keeps_its_last_minutes_without_being_asked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("OPENACR_JOURNALS", str(tmp_path))
    assert "no journals" in openacr("replay").output
    with serving() as served, served.call() as host:
        host.ask("?1")
        assert served.end() == (0, "")
    (journal,) = journals(tmp_path / "1")
    assert str(journal) in openacr("replay").output.replace("\n", "")
    result = openacr("replay", journal, "--check")
    assert result.exit_code == 0, result.output
    with serving("--no-journal") as served:
        assert served.end() == (0, "")
    assert journals(tmp_path / "1") == [journal]


def test_a_card_is_served_where_no_journal_can_be_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("OPENACR_JOURNALS", str(tmp_path / "file"))
    with serving() as served, served.call() as host:
        assert host.value("?2") == "2"
        code, error = served.end()
    assert code == 0
    assert "no journal is kept" in error


def test_a_project_does_not_overwrite_what_the_card_has(blink: Path, tmp_path: Path) -> None:
    blink.write_text(BLINK + "SYS\nHALT ALL\nFLASH IMAGE\n")
    with serving(blink, "--data", tmp_path / "data") as served:
        assert served.end()[0] == 0
    with serving(blink, "--data", tmp_path / "data") as served:
        code, error = served.end()
    assert code == 0
    assert "warning: the card has programs in" in error


def test_a_data_folder_in_use_is_refused(tmp_path: Path) -> None:
    with serving("--data", tmp_path):
        result = openacr("serve", "--data", tmp_path, "--ascii-port", 0, "--binary-port", 0)
    assert result.exit_code == 2
    assert "is in use by another card" in result.stderr
