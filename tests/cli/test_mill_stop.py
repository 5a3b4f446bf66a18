"""`openacr mill stop`: what it says of a machine it brings to rest."""

from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from openacr.cli.main import app
from openacr.client import Card
from openacr.controller import Controller
from openacr.sysvar import Store

ESTOP_INPUT = 4
AT_REST = "the machine is at rest at X   0.0000 Y   0.0000 Z   0.0000 inch;"


@pytest.fixture
def card(own_store: Path, monkeypatch: pytest.MonkeyPatch) -> Controller:
    """A card of --host, whatever is named there, with an emergency stop."""
    with Store(own_store) as store:
        store.write(400_004, ESTOP_INPUT)
    controller, opened = Controller(), Card.open
    monkeypatch.setattr(Card, "open", lambda _host, *rest: opened(controller, *rest))
    return controller


def stopped() -> tuple[int, list[str]]:
    result: Any = CliRunner().invoke(app, ["mill", "stop", "--host", "card"])
    return result.exit_code, result.output.splitlines()


def test_an_emergency_stop_is_called_by_its_name_by_mill_stop(card: Controller) -> None:
    code, lines = stopped()
    assert (code, [line.startswith(AT_REST) for line in lines]) == (0, [True])
    card.set_input(ESTOP_INPUT, True)
    code, lines = stopped()
    assert (code, lines[0]) == (0, "alarm 10: Emergency stop")
    assert lines[1].startswith(AT_REST)


def test_mill_stop_names_the_unit_of_the_position_it_prints(
    card: Controller, tmp_path: Path
) -> None:
    with Store(tmp_path / "sysvar.db") as store:
        store.write(250_001, 1)  # Default Units
        store.write(850_030, 21)  # Control Mode
    code, lines = stopped()
    assert (code, [" mm; `openacr mill acknowledge`" in line for line in lines]) == (0, [True])


def test_mill_stop_stops_what_other_hosts_have_begun(card: Controller) -> None:
    other = Card.open(card)
    other.command("ATTACH MASTER1", program=1)
    other.command('ATTACH SLAVE0 AXIS5 "W"', program=1)
    for line in ("AXIS5 JOG ACC 5000", "AXIS5 JOG DEC 5000", "AXIS5 JOG VEL 900", "AXIS5 JOG FWD"):
        other.command(line, program=1)
    for line in ("PROGRAM", "_again", "DWL 0.1", "GOTO again", "ENDP"):
        other.command(line, program=3)
    other.run(3)
    card.advance(seconds=0.2)
    code, lines = stopped()
    assert code == 0
    assert lines[:2] == ["stopped: PROG3 halted", "stopped: AXIS5 stopped"]
    place = card.p[12294 + 5 * 256]
    card.advance(seconds=0.5)
    assert card.p[12294 + 5 * 256] == place > 0
