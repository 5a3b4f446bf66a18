"""STOP of a panel on what other processes have begun, over TCP and a serial line."""

import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

import pytest
from tests.mill.live import Plant, Process, serial_line
from tests.mill.planned import ACCEL, JERK, SPEED, TOLERANCE, highest, off_path, wave
from tests.mill.test_planned_lost_host import PULSES, ROUNDING, cells, text_of
from tests.mill.test_stop_of_others import begin
from tests.panel.remote import Remote
from tests.waiting import until

from openacr.cnc.occupied import HEARTBEAT
from openacr.engine.samples import Sample
from openacr.engine.watches import Watched
from openacr.map.rows import axes
from openacr.mill import session
from openacr.mill.card.owner import Owner
from openacr.sysvar.tabs import CONTROL

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="no signals of this kind")

POINTS = wave(5000)  # some 20 s at full speed
NO_WATCHDOG: dict[int, float] = {CONTROL.watchdog_program: -1}
SETUP = 'PROG0\nATTACH MASTER0\nATTACH SLAVE0 AXIS0 "X"\nPPU X1000\n'
PBOOT = "PROG0\nPROGRAM\nPBOOT\nDRIVE ON X\nVEL 1\n_again\nX3\nX0\nGOTO again\nENDP\n"


@contextmanager
def plant_and_port(folder: Path, *words: str, is_serial: bool) -> Iterator[tuple[Plant, str]]:
    """A served card and the port at which panels find it."""
    with ExitStack() as stack:
        far: tuple[str, ...] = ()
        near = ""
        if is_serial:
            near, end = stack.enter_context(serial_line())
            far = ("--serial", end)
        plant = Plant(folder, *words, *far)
        stack.callback(plant.close)
        yield plant, near or plant.address


@contextmanager
def remote(port: str, folder: Path, *, is_agreed: bool = False) -> Iterator[Remote]:
    place = folder / "panel"
    place.mkdir()
    panel = Remote(port, place, is_agreed=is_agreed)
    try:
        yield panel
    finally:
        panel.close()


def stopped(panel: Remote) -> list[str]:
    """What the last stop has found, once its watch is over and nothing moves."""
    until(lambda: panel.call(lambda station: not station.stopping.is_watching))
    found = panel.call(lambda station: station.stopping.data())["found"]
    until(  # of a card on a busy computer axes still ramp down where the watch ends
        lambda: panel.call(lambda station: station.stopping.data())["moving"] == []
    )
    return list(found)


@pytest.mark.parametrize("is_serial", [False, True])
def test_stop_breaks_off_the_attempt_to_open_a_card(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, is_serial: bool
) -> None:
    has_begun = threading.Event()
    silent = Owner._require_silence

    def listening(owner: Owner, listen_s: float) -> int:
        has_begun.set()
        return silent(owner, listen_s)

    monkeypatch.setattr(Owner, "_require_silence", listening)
    monkeypatch.setattr(session, "LISTEN_S", 1000.0)  # much longer than any limit here
    with plant_and_port(tmp_path, is_serial=is_serial) as (plant, port):
        plant.card.command("DIM P(100)")
        plant.card.command(f"P{HEARTBEAT}=5")
        begin(plant.card)
        until(lambda: plant.is_moving)
        place = tmp_path / "panel"
        place.mkdir()
        panel = Remote(port, place, is_awaited=False)
        try:
            assert has_begun.wait(60.0)
            assert panel.send("stop.hold")["ok"]
            assert stopped(panel) == ["PROG0 paused", "MASTER0 held"]
            until(lambda: plant.is_at_rest)
            until(lambda: panel.link() == "ok")  # the card as it is
            assert panel.installation.lacks
            assert panel.send("run.resume")["ok"]
            until(lambda: plant.is_moving)
        finally:
            panel.close()


@pytest.mark.parametrize("is_serial", [False, True])
def test_a_program_that_began_at_power_up_is_stopped_by_a_panel_that_was_just_opened(
    tmp_path: Path, is_serial: bool
) -> None:
    project = tmp_path / "project"
    project.mkdir()
    (project / "machine.toml").write_text('[card]\nmodel = "ACR9000"\n')
    (project / "setup.8k").write_text(SETUP)
    (project / "prog0.8k").write_text(PBOOT)
    with plant_and_port(tmp_path, str(project), is_serial=is_serial) as (plant, port):
        until(lambda: plant.is_moving)
        with remote(port, tmp_path) as panel:
            assert panel.send("stop.hold")["ok"]
            assert stopped(panel) == ["PROG0 paused", "MASTER0 held"]
            assert plant.is_at_rest


def test_moves_of_a_host_that_was_killed_are_stopped(tmp_path: Path) -> None:
    with plant_and_port(tmp_path, is_serial=False) as (plant, port):
        plant.wire(NO_WATCHDOG)
        part = plant.part("G21 G91 F60\n" + "G1 X20\nG1 X-20\n" * 100)
        run = plant.mill("run", part, "--quiet")
        until(lambda: plant.is_moving, about=run.text)
        run.signal(signal.SIGKILL)
        run.ended()
        assert plant.is_moving
        with remote(port, tmp_path) as panel:
            assert panel.send("stop.hold")["ok"]
            assert stopped(panel) == ["MASTER0 held"]
            assert plant.is_at_rest
            assert panel.send("stop.all")["ok"]
            stopped(panel)
            assert not plant.card.read_bit("master0.move buffered")


def other_run(plant: Plant) -> Process:
    plant.wire(cells())
    part = plant.part(text_of(POINTS))
    run = plant.mill("run", part, "--dialect", "rs274ngc", "--quiet")
    until(lambda: plant.places()[0] > 100_000, about=run.text)
    return run


@pytest.mark.parametrize("stop", ["stop.hold", "stop.all"])
def test_a_planned_path_of_another_process_comes_to_rest_within_its_limits_and_stays(
    tmp_path: Path, stop: str
) -> None:
    plant = Plant(tmp_path, is_journalled=True)
    try:
        run = other_run(plant)
        with remote(plant.address, tmp_path) as panel:
            until(lambda: panel.link() == "ok")
            assert panel.send(stop)["ok"]
            assert "MASTER0" in " ".join(stopped(panel))
            until(lambda: plant.is_at_rest)
            place = plant.places()
            if stop == "stop.all":
                assert run.ended() != 0
                said = ("Card killed moves", "Card does not make the moves it was sent")
                assert any(text in run.text for text in said)  # one that looks late sees the second
            plant.card.pause(1.0)
            assert plant.places() == place
        rows = [axes.psp_cnt[axis] for axis in range(3)]
        trace = plant.lived_again(*(Sample(Watched.FP64, row) for row in rows))
        places = trace.values / PULSES
        speed, accel, jerk = highest(places, 0.0005)
        assert 0.5 * SPEED < speed <= SPEED * (1 + 1e-4)
        assert accel <= ACCEL * (1 + 1e-4)
        assert jerk <= JERK * (1 + ROUNDING)
        assert off_path(places[::20], POINTS[:1000]) <= 2 * TOLERANCE
    finally:
        plant.close()
