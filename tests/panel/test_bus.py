"""A panel whose card has its bus open: the card in a process of its own, its state, its end."""

import os
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.panel.bench import HandStation
from tests.panel.bus_in_memory import MACHINE, BusInMemory
from tests.waiting import until
from typer.testing import CliRunner

from openacr import compiled
from openacr.cli.main import app
from openacr.cli.panel import _bus as opened_bus
from openacr.errors import UserError
from openacr.panel.machine import embedded
from openacr.panel.machine.project import OnBus, of_project
from openacr.panel.machine.served import ServedCard


@pytest.fixture
def project(tmp_path: Path) -> Path:
    folder = tmp_path / "machine"
    folder.mkdir()
    (folder / "machine.toml").write_text(MACHINE.replace('"emulated"', '"eth9"'))
    return folder


@pytest.fixture
def served(project: Path) -> Iterator[ServedCard]:
    card = ServedCard(project, "emulated", is_real=True)
    yield card
    card.close()


def test_the_card_of_a_bus_reports_from_a_process_of_its_own_and_ends_with_the_panel(
    served: ServedCard,
) -> None:
    until(lambda: served.report is not None and served.report["counters"]["sent"] > 2000)
    report = served.report
    assert report is not None
    assert [one["state"] for one in report["devices"]] == ["OP", "OP"]
    assert [one["axis"] for one in report["drives"]] == ["X", "Y"]
    assert report["is_real"]
    assert os.getpgid(served._process.pid) != os.getpgid(0)  # Ctrl-C does not reach it
    sent = report["counters"]["sent"]
    served.reset_counters()
    until(lambda: served.report is not None and served.report["counters"]["sent"] < sent)
    served.close()
    assert served._process.returncode == 0
    assert served.report is None
    with pytest.raises(UserError, match="the card with the bus has ended"):
        served.reset_counters()


def test_a_panel_opens_the_card_of_a_project_with_its_bus(project: Path, tmp_path: Path) -> None:
    (tmp_path / "parts").mkdir()
    installation = of_project(
        project,
        store=tmp_path / "sysvar.db",
        programs=tmp_path / "parts",
        otherwise=tmp_path,
        bus=OnBus("emulated"),
    )
    try:
        assert (installation.kind, installation.name) == ("project", "machine")
        assert not installation.is_virtual  # its time is never still
        assert installation.bus is not None
        until(lambda: installation.bus is not None and installation.bus.report is not None)
        assert installation.bus.report is not None
        assert not installation.bus.report["is_real"]
    finally:
        installation.close()


def test_a_bus_that_does_not_come_up_is_an_error_of_the_start(project: Path) -> None:
    with pytest.raises(UserError, match="has not started: the lines above say why"):
        ServedCard(project, "no-such-if", is_real=False)


def test_a_card_in_real_time_is_asked_for_and_what_bars_it_is_seen(
    project: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(UserError, match="has not started"):
        ServedCard(project, "emulated", is_real=False, is_real_time=True)
    assert "--realtime: the devices of --bus emulated live in the time" in capfd.readouterr().err


@pytest.mark.parametrize(("bus", "why"), [(None, ""), ("emulated", "not served in real time: ")])
def test_the_bus_of_a_panel_is_in_real_time_or_a_sentence_says_why_not(
    project: Path, bus: str | None, why: str, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    monkeypatch.setattr(compiled, "is_compiled", True)
    monkeypatch.setattr(sys, "platform", "linux")
    found = opened_bus(str(project), bus, is_real=True, is_sure=True)
    assert found == OnBus(bus, is_real=True, is_real_time=not why)
    said = capsys.readouterr().err
    assert said == "" if not why else why in said


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (["--real"], "--bus and --real need a project"),
        (["127.0.0.1:1", "--real"], "--bus and --real need a project"),
        (["{project}", "--real"], "--real lets drives be enabled and outputs switched: say --yes"),
        (["{plain}", "--real"], "--real: nothing of machine.toml is on a bus"),
        (["{plain}", "--bus", "eth1"], "the project has no machine.toml with [bus]"),
    ],
)
def test_what_cannot_be_opened_is_refused_before_anything_starts(
    project: Path, tmp_path: Path, words: list[str], text: str
) -> None:
    plain = tmp_path / "plain"
    plain.mkdir()
    (plain / "machine.toml").write_text("")
    given = [word.format(project=project, plain=plain) for word in words]
    result = CliRunner().invoke(app, ["panel", *given, "--no-browser"])
    assert result.exit_code == 2
    assert text in result.output


def test_counters_of_a_bus_are_reset_by_service_alone_and_not_without_a_bus(tmp_path: Path) -> None:
    hand = HandStation(tmp_path, installation=embedded(tmp_path))
    try:
        error = hand.refused("bus.reset")
        assert "the panel has opened no bus: openacr panel PROJECT --real" in error["text"]
        hand.installation.bus = bus = BusInMemory()
        assert bus.rig.machine.cycles > 100
        hand.do("bus.reset")
        assert bus.rig.machine.cycles == 0
    finally:
        hand.close()
