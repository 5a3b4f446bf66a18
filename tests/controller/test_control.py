"""Programs and motion started, held and ended from a terminal, and the card restarted."""

import pytest
from tests.controller.hosts import X_AND_Y, Host, connected

from openacr.controller import Controller
from openacr.models import MODELS
from openacr.plant.describe import schema


@pytest.mark.req("ACR-KAMR-13", "ACR-KAMR-41", "ACR-KAMR-43")
@pytest.mark.parametrize("key", ["\x18", "\x1a"])
def test_they_reach_the_last_of_sixteen_axes_attached_or_not(key: str) -> None:
    host = connected(model="ACR8020")
    host.send(key)
    host.card.advance(1)
    assert [host.card.bit[8467 + 32 * n] for n in range(16)] == [True] * 16


def test_drive_off_and_on_in_one_breath_lifts_what_a_limit_has_left(axes: Host) -> None:
    axes.type("X1000")
    axes.card.advance(400)
    axes.type("SET 8467")
    axes.card.advance(2000)
    assert axes.ask("?BIT8499") == "-1"
    assert axes.type("CLR 8467", "DRIVE OFF X", "DRIVE ON X") == "P00>" * 3
    axes.card.advance(100)
    assert axes.asks("?BIT8465", "?BIT8499", "?BIT522") == ["-1", "0", "0"]
    assert axes.type("Y5") == "P00>"
    axes.card.advance(2000)
    assert axes.ask("?P12544") == "5000"


def test_a_limit_switch_stops_the_axis_and_the_host_gets_it_going_again() -> None:
    default = schema.default_world(MODELS["ACR9000"])
    limited = schema.Axis(
        number=0, drive=default.axis[0].drive, encoder_lines=1000,
        positive_limit=schema.LimitSwitch(at=20.0, input=0),
    )  # fmt: skip
    world = schema.World(card=default.card, axis=(limited, *default.axis[1:]))
    host = Host(Controller(world=world))
    host.type(*X_AND_Y, "HLIM X3", "HLDEC X1000")
    host.card.advance(100)
    host.type("X100")
    host.card.advance(3000)
    assert host.asks("?BIT516", "?BIT8467") == ["0", "-1"]
    assert int(host.ask("?P4600")) & 7 == 1
    assert 20_000 < int(host.ask("?P12290")) < 40_000
    assert host.type("CLR 8467", "AXIS0 DRIVE OFF", "AXIS0 DRIVE ON") == "P00>" * 3
    host.card.advance(100)
    assert host.type("Y3") == "P00>"
    host.card.advance(2000)
    assert host.ask("?P12544") == "3000"
    assert host.type("X/-30") == "P00>"
    host.card.advance(4000)
    assert int(host.ask("?P4600")) & 7 == 0
    assert host.ask("?BIT8467") == "0"


def test_a_plc_reads_names_with_digits() -> None:
    model = schema.Card(digits_in_names=True).board
    host = Host(Controller(model))
    host.type("DIM PLC0(500)", "DIM DEF(4)", "#DEFINE Valve1 BIT32", "PLC0")
    host.type("#DEFINE Door2 BIT128", "10 LD Door2", "20 OUT Valve1")
    assert host.type("LIST") == "10 LD Door2|20 OUT Valve1|PLC0>"
    host.type("RUN", "SET 128")
    host.card.advance(200)
    assert host.ask("?BIT32") == "-1"
