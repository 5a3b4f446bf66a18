"""Lights, limits and encoder faults as a host sees them; why there is no connection."""

import json
import socket
from collections.abc import Iterator

import pytest
from tests.client.cards import EXAMPLES, wrapped
from tests.io.served import LOOPBACK, Served, serving
from typer.testing import CliRunner

from openacr.cli.live.loop import read_loop
from openacr.cli.live.status import AxisStatus, Status, _lines, read_status
from openacr.cli.main import app
from openacr.client import Card, ConnectionLostError
from openacr.client.lights import Light, axis_light, bus_light, power_light
from openacr.client.links import DEFAULT_BAUD, ProcessLink, SerialLink, TcpLink
from openacr.controller import Controller
from openacr.map.words import af1


@pytest.fixture
def card() -> Controller:
    card = Controller()
    card.send("AXIS3 OFF\rAXIS4 OFF\rAXIS5 OFF\rAXIS6 OFF\rAXIS7 OFF\rAXIS1 HLBIT 3\r")
    return card


def of_axis(card: Controller, axis: int) -> AxisStatus:
    card.advance(seconds=0.1)
    with Card(ProcessLink(card)) as host:
        return read_status(host).axes[axis]


@pytest.mark.req("ACR-TRB-01")
def test_the_power_light(card: Controller) -> None:
    def shown() -> str:
        with Card(ProcessLink(card)) as host:
            return read_status(host).power

    assert shown() == "green"
    card.memory.I[7044] = 1 << 5  # VEE fails
    assert shown() == "red"
    card.bit[5656] = True  # boot flash invalid
    assert shown() == "red and green in turn"
    assert power_light(is_there=False) is Light.OFF


@pytest.mark.req("ACR-TRB-02")
def test_the_light_of_an_axis_and_the_motion_it_bars(card: Controller) -> None:
    lines = ("PROG0", "ATTACH MASTER0", 'ATTACH SLAVE0 AXIS0 "X"', "SET 8468", "JOG VEL X1")
    card.send("\r".join((*lines, "")))
    assert of_axis(card, 0).light == "off"
    card.send("DRIVE ON X\r")
    assert of_axis(card, 0).light == "green"
    card.send("SET 8453\r")  # the fault input is on without a cable
    assert of_axis(card, 0).light == "red"
    assert of_axis(card, 0).is_killed
    assert "Kill Motion Request Active" in card.send("JOG FWD X\r")
    card.send("DRIVE ON X\r")
    assert not of_axis(card, 0).is_enabled
    card.send("CLR 8453\rDRIVE ON X\r")
    assert of_axis(card, 0).light == "green"


def test_lights_by_flags_alone() -> None:
    states = [(False, False), (False, True), (True, False), (True, True)]
    assert [axis_light(is_faulty=a, is_enabled=b) for a, b in states] == [
        Light.OFF, Light.GREEN, Light.RED, Light.RED,
    ]  # fmt: skip


@pytest.mark.req("ACR-TRB-03")
def test_the_light_of_the_bus_by_its_state() -> None:
    """P32779 from 0; no value of it is a sync error, so three flashes are not shown."""
    shown = [bus_light(state, is_installed=True) for state in range(-1, 12)]
    assert shown == [
        "off",  # unknown
        "off", "blinking green", "green", "red", "red", "blinking green",
        "one red flash", "two red flashes", "blinking red", "blinking red", "red",
        "off",  # unknown
    ]  # fmt: skip
    assert [bus_light(state, is_installed=False) for state in (2, 6, 7)] == ["off"] * 3


@pytest.mark.req("ACR-TRB-09")
@pytest.mark.parametrize("fault", [2560, 2561])
def test_encoder_faults_are_shown_and_keep_the_drive_off(card: Controller, fault: int) -> None:
    card.send('PROG0\rATTACH MASTER0\rATTACH SLAVE0 AXIS1 "X"\rSET 8500\r')
    card.bit[fault + 32] = True
    card.send("DRIVE ON X\r")
    found = of_axis(card, 1)
    assert (found.encoder_fault, found.encoder_lost) == (fault == 2560, fault == 2561)
    assert not found.is_enabled
    card.send("ENC1 RES 0\rDRIVE ON X\r")
    found = of_axis(card, 1)
    assert (found.encoder_fault, found.encoder_lost, found.is_enabled) == (False, False, True)


@pytest.mark.req("ACR-TRB-23")
def test_inputs_and_enables_of_limits_stand_side_by_side(card: Controller) -> None:
    card.bit[4] = True  # negative limit of axis 1
    limits = of_axis(card, 1).limits
    assert [(limit.input, limit.is_on, limit.is_enabled) for limit in limits] == [
        (3, False, False),
        (4, True, False),  # toggles without effect
    ]
    card.bit[16132 + 32] = True  # encountered before, on the positive side
    assert [limit.is_latched for limit in of_axis(card, 1).limits] == [True, False]
    card.send("AXIS1 HLIM 2\r")
    enabled = of_axis(card, 1).limits[1]
    assert (enabled.is_on, enabled.is_active, enabled.is_enabled) == (True, True, True)


@pytest.fixture(scope="module")
def served() -> Iterator[Served]:
    with serving(EXAMPLES / "gantry") as served:
        yield served


def test_the_command_shows_it(served: Served) -> None:
    target = f"{LOOPBACK}:{served.ascii_port}"
    lines = CliRunner().invoke(app, ["status", target]).stdout.splitlines()
    assert lines[:5] == [
        "power light     green",
        "CANopen light   off",
        "motion enable   closed",
        "axis 0: light off, no output: the drive is not enabled",
        "  positive limit  input 0 1  active 0  enabled 1  latched 0",
    ]
    found = json.loads(CliRunner().invoke(app, ["status", target, "--json"]).stdout)
    assert [axis["axis"] for axis in found["axes"]] == [0, 1, 2]


@pytest.mark.req("ACR-TRB-05")
def test_serial_lines_begin_with_38400_baud_8n1_and_xon_xoff(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    import serial

    asked: dict[str, object] = {}
    real = serial.serial_for_url

    def opened(url: str, **options: object) -> serial.SerialBase:
        asked.update(options)
        return real("loop://", **options)

    monkeypatch.setattr(serial, "serial_for_url", opened)
    link = SerialLink("/dev/ttyACR")
    link.open()
    port = link._port
    assert port is not None
    assert (DEFAULT_BAUD, port.baudrate, port.xonxoff) == (38400, 38400, True)
    assert (port.bytesize, port.parity, port.stopbits) == (8, "N", 1)
    link.close()


@pytest.mark.req("ACR-TRB-06")
@pytest.mark.parametrize(
    ("failure", "said"),
    [
        (ConnectionRefusedError(111, "refused"), "10061: no card listens at this address"),
        (TimeoutError("timed out"), "11010: wrong cable, or wrong address of the card"),
        (socket.gaierror(-2, "unknown"), "11003: wrong cable, or wrong address or mask"),
        (OSError(101, "unreachable"), "11003: wrong cable, or wrong address or mask"),
        (OSError(5, "in/out"), "17080: the card cannot be reached"),
    ],
)
def test_a_failed_connection_has_its_code_and_cause(
    monkeypatch: pytest.MonkeyPatch, failure: Exception, said: str
) -> None:
    def refuse(*_: object) -> socket.socket:
        raise failure

    monkeypatch.setattr(socket, "create_connection", refuse)
    with pytest.raises(ConnectionLostError) as lost:
        TcpLink("192.168.10.40").open()
    assert said in str(lost.value)


@pytest.mark.req("ACR-TRB-06")
def test_a_port_that_is_not_there_lacks_its_driver() -> None:
    with pytest.raises(ConnectionLostError, match="17054: no driver for the USB or serial port"):
        SerialLink("/dev/ttyNothing").open()


def test_wrapped_cards_are_read_too() -> None:
    host, _ = wrapped()
    assert len(read_status(host).axes) == 8


def test_why_an_axis_has_no_output_is_shown(card: Controller) -> None:
    card.send('PROG0\rATTACH MASTER0\rATTACH SLAVE0 AXIS0 "X"\rATTACH SLAVE1 AXIS1 "Y"\r')
    card.send("DRIVE OFF Y\r")
    assert of_axis(card, 0).no_output == ""
    found = of_axis(card, 1)
    assert found.no_output == "the drive was disabled"
    shown = list(_lines(Status("green", "off", "closed", (found,))))
    assert shown[3] == "axis 1: light off, no output: the drive was disabled"
    card.send("SET 8468\r")
    assert of_axis(card, 0).no_output == "the drive is not enabled"
    card.send("DRIVE ON X Y\r")
    assert [of_axis(card, axis).no_output for axis in (0, 1)] == ["", ""]
    card.p[af1.word[1]] = int(card.p[af1.word[1]]) | af1.CLAMP_OUTPUT_SIGNAL
    assert of_axis(card, 1).no_output == "the output is clamped"
    card.p[af1.word[0]] = int(card.p[af1.word[0]]) | af1.OPEN_SERVO_LOOP
    with Card(ProcessLink(card)) as host:
        loops = [read_loop(host, axis) for axis in (0, 1)]
    assert [one.no_output for one in loops] == ["the servo loop is open", "the output is clamped"]
