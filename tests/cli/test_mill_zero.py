"""`openacr mill zero set`, `clear`, `goto`: what they say and what they end with."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from openacr.cli.main import app
from openacr.client import Card
from openacr.controller import Controller
from openacr.mill.session import MillSession
from openacr.sysvar import Store


@pytest.fixture(autouse=True)
def card(own_store: Path, monkeypatch: pytest.MonkeyPatch) -> Controller:
    """A card of --host, whatever is named there; its axes need no homing."""
    with Store(own_store) as store:
        for axis in range(3):
            store.write(200_007 + 1000 * axis, 0)
    controller, real = Controller(), MillSession.real

    monkeypatch.setattr(MillSession, "real", lambda _host, *rest: real(controller, *rest))
    mill("zero", "clear")  # the axes are set up
    with Card.open(controller) as host:
        host.command("DRIVE ON X Y Z", program=0)
    return controller


def mill(*words: str) -> tuple[int, str]:
    result = CliRunner().invoke(app, ["mill", *words, "--host", "card"])
    return result.exit_code, result.output


def zero(*words: str) -> list[str]:
    """What a command says that has succeeded."""
    code, text = mill("zero", *words)
    assert code == 0, text
    return [" ".join(line.split()) for line in text.splitlines()]


def test_zero_is_set_for_axes_cleared_and_gone_to_over_the_command_line() -> None:
    assert mill("mdi", "G0 X1.588 Y-2.12")[0] == 0
    assert zero("set", "--axes", "y") == ["X 1.5880 Y 0.0000 Z 0.0000 inch"]
    assert zero("set") == ["X 0.0000 Y 0.0000 Z 0.0000 inch"]
    assert zero("clear") == ["X 1.5880 Y -2.1200 Z 0.0000 inch"]
    assert zero("goto", "--axes", "YZ") == ["X 1.5880 Y 0.0000 Z 0.0000 inch"] * 2


def test_an_axis_that_does_not_exist_is_refused() -> None:
    code, text = mill("zero", "set", "--axes", "Q")
    assert (code, "Q" in text, "Traceback" in text) == (2, True, False)


def test_an_alarm_of_goto_zero_is_its_exit_code(card: Controller) -> None:
    card.bit[8467] = True  # killed by another host
    code, text = mill("zero", "goto")
    assert (code, "alarm 14" in text) == (2, True)
