"""A jog of any axis of a card whose panel is lost: what it has changed is set back."""

import multiprocessing
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from tests.mill.live import Plant
from tests.panel.remote import Remote
from tests.waiting import until

from openacr.map.rows import axes
from openacr.panel.control.operator.left_jogs import NAME

SETUP = """PROG0
ATTACH MASTER0
ATTACH SLAVE0 AXIS0 "X"
PPU X1000
JOG ACC X10
JOG DEC X10
JOG VEL X0.25
"""
OWN, SPEED = 0.25, 0.5  # units/s
skip = pytest.mark.skipif(sys.platform == "win32", reason="no signals of this kind")


@pytest.fixture
def plant(tmp_path: Path) -> Iterator[Plant]:
    """A served card with one axis, and a folder for panels."""
    project = tmp_path / "project"
    project.mkdir()
    (project / "machine.toml").write_text('[card]\nmodel = "ACR9000"\n')
    (project / "setup.8k").write_text(SETUP)
    (tmp_path / "panel").mkdir()
    plant = Plant(tmp_path, str(project))
    yield plant
    plant.close()


def jog(address: str, folder: Path) -> None:
    """A panel that moves the axis until its process is killed."""
    panel = Remote(address, folder, is_agreed=False)
    tick = panel.call(lambda station: station.snapshot.tick_ms)
    far = {"axis": "AXIS0", "direction": 1, "distance": 1000.0, "speed": SPEED}
    assert panel.send("jog.increment", tick=tick, **far)["ok"]
    threading.Event().wait()


@contextmanager
def panel_of(plant: Plant, folder: Path) -> Iterator[Remote]:
    panel = Remote(plant.address, folder / "panel", is_agreed=False)
    try:
        yield panel
    finally:
        panel.close()


def step(panel: Remote) -> dict[str, Any]:
    """An increment of the axis."""
    tick = panel.call(lambda station: station.snapshot.tick_ms)
    return {"axis": "AXIS0", "direction": 1, "distance": 0.1, "speed": 0.4, "tick": tick}


def speed_and_offset(plant: Plant) -> tuple[float, float]:
    values = plant.card.read_many([axes.jog_veloc_setting[0], axes.jog_offset[0]])
    return float(values[0]), float(values[1])


def said(panel: Remote) -> list[str]:
    return panel.call(lambda station: [each["text"] for each in station.screens.said])  # type: ignore[no-any-return]


def killed_while_it_jogs(plant: Plant, folder: Path) -> None:
    panel = multiprocessing.get_context("spawn").Process(
        target=jog, args=(plant.address, folder), daemon=True
    )
    panel.start()
    try:
        until(lambda: speed_and_offset(plant)[1] > 100.0, about="the axis moves")
    finally:
        panel.kill()
        panel.join()
    assert plant.card.wait(lambda: plant.is_at_rest)  # within its leash
    assert speed_and_offset(plant)[0] == SPEED


@skip
def test_what_a_panel_that_was_killed_while_it_jogs_leaves_on_the_card_is_set_back_by_the_next(
    plant: Plant, tmp_path: Path
) -> None:
    killed_while_it_jogs(plant, tmp_path / "panel")
    offset, at = speed_and_offset(plant)[1], plant.places()
    with panel_of(plant, tmp_path) as panel:
        until(lambda: speed_and_offset(plant) == (OWN, 0.0))
        until(lambda: bool(said(panel)))
        (text,) = said(panel)
        assert text == (
            f"axis X: a jog was cut off before its end; its offset {offset / 1000.0:g} is position"
            " now (JOG RES), its jog speed is 0.25 again"
        )
        assert plant.places() == at
    with panel_of(plant, tmp_path) as panel:
        plant.card.command("AXIS0 JOG VEL 0.5", program=0)  # no note is left
        assert panel.send("jog.increment", **step(panel))["ok"]
        until(lambda: not panel.call(lambda station: station.card_jogs.are_active))
        assert (said(panel), speed_and_offset(plant)) == ([], (SPEED, 0.0))
        assert (tmp_path / "panel" / NAME).read_bytes() == b"[]"  # of a jog that has ended


@skip
@pytest.mark.parametrize("is_paused", [False, True])
def test_it_is_not_set_back_under_a_program_whose_targets_would_shift(
    plant: Plant, tmp_path: Path, is_paused: bool
) -> None:
    killed_while_it_jogs(plant, tmp_path / "panel")
    for line in ("PROGRAM", "_again", "DWL 0.01", "GOTO again", "ENDP"):
        plant.card.command(line, program=0)
    plant.card.run(0)
    if is_paused:
        plant.card.command("PAUSE PROG0")
    left = speed_and_offset(plant)
    with panel_of(plant, tmp_path) as panel:
        text = panel.send("jog.increment", **step(panel))["error"]["text"]
        assert "a jog that was cut off is set back first" in text
        assert speed_and_offset(plant) == left
        plant.card.command("HALT PROG0")
        until(lambda: speed_and_offset(plant) == (OWN, 0.0))


@skip
def test_what_another_host_has_set_since_is_left_alone(plant: Plant, tmp_path: Path) -> None:
    killed_while_it_jogs(plant, tmp_path / "panel")
    plant.card.command("AXIS0 JOG VEL 0.75", program=0)
    offset = speed_and_offset(plant)[1]
    with panel_of(plant, tmp_path) as panel:
        until(lambda: (tmp_path / "panel" / NAME).read_bytes() == b"[]")
        assert (said(panel), speed_and_offset(plant)) == ([], (0.75, offset))
