"""Process variables over Channel Access, with the client of caproto."""

import socket
from collections.abc import Iterator
from typing import Any

import pytest
from caproto import AlarmSeverity, Beacon, Broadcaster, CaprotoError
from caproto.sync import client
from tests.bridge.bench import RUNNING, VALUES, GivenFeed, bridged
from tests.waiting import until

from openacr.bridge.epics import channel_of, shown, written
from openacr.bridge.items import items_of
from openacr.bridge.load import parse_bridge
from openacr.errors import SourceError

LIMIT_S = 30.0
SHOWN = """
[[value]]
name = "shown"
parameter = "axis1.actual position"
low = -5
high = 2.5
[[value]]
name = "half"
parameter = "axis2.actual position"
low = 1
"""


def free_port() -> int:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as found:
        found.bind(("127.0.0.1", 0))
        return int(found.getsockname()[1])


@pytest.fixture
def feed() -> GivenFeed:
    return GivenFeed()


@pytest.fixture
def served(feed: GivenFeed, monkeypatch: pytest.MonkeyPatch) -> Iterator[str]:
    port = free_port()
    monkeypatch.setenv("EPICS_CA_SERVER_PORT", str(port))
    monkeypatch.setenv("EPICS_CA_ADDR_LIST", "127.0.0.1")
    monkeypatch.setenv("EPICS_CA_AUTO_ADDR_LIST", "NO")
    monkeypatch.setenv("EPICS_CAS_AUTO_BEACON_ADDR_LIST", "NO")
    monkeypatch.setenv("EPICS_CAS_BEACON_ADDR_LIST", "127.0.0.1")
    text = f'name = "mill"\nrate_hz = 50\n[epics]\nport = {port}\n{VALUES}{SHOWN}'
    with bridged(text, feed) as bridge:
        yield bridge.places[0]


def read(name: str, kind: str = "native") -> Any:
    return client.read(f"mill:{name}", repeater=False, timeout=LIMIT_S, data_type=kind)


def value(name: str) -> Any:
    data = read(name).data
    return bytes(data).decode() if name in ("program", "alarms", "tools") else data[0]


def test_hosts_read_values_with_units_and_see_a_machine_that_is_lost(
    served: str, feed: GivenFeed
) -> None:
    assert served.endswith(" mill:")
    until(lambda: value("line") == 12)
    assert value("X:actual") == 1.5
    assert value("execution") == b"ACTIVE"
    assert value("program") == "plate.nc"
    assert value("alarms") == "34 X: drive is off"
    assert value("tools") == "T3 diameter 6 mm, length 50.25 mm, flat; T12 length -7.5 mm, ball"
    assert (value("spindle_on"), value("flood")) == (1, 0)
    assert (value("user:pulses"), value("user:gate")) == (400.0, 1)
    controlled = read("X:actual", "control").metadata
    assert (controlled.units, controlled.precision) == (b"mm", 4)
    assert read("user:pulses", "control").metadata.units == b"pulses"
    assert read("time_left", "time").metadata.severity == AlarmSeverity.INVALID_ALARM
    assert read("line", "time").metadata.severity == AlarmSeverity.NO_ALARM
    feed.lose()
    until(lambda: value("available") == 0)
    until(lambda: read("line", "time").metadata.severity == AlarmSeverity.INVALID_ALARM)
    assert value("line") == 0
    feed.moment = RUNNING
    until(lambda: value("line") == 12)


def test_beacons_that_no_repeater_takes_are_no_failure(
    feed: GivenFeed, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    sent = list[object]()
    send = Broadcaster.send

    def counted(self: Broadcaster, *commands: object) -> object:
        sent.extend(each for each in commands if isinstance(each, Beacon))
        return send(self, *commands)

    monkeypatch.setattr(Broadcaster, "send", counted)
    monkeypatch.setenv("EPICS_CAS_AUTO_BEACON_ADDR_LIST", "NO")
    monkeypatch.setenv("EPICS_CAS_BEACON_ADDR_LIST", f"127.0.0.1:{free_port()}")
    with bridged(f"[epics]\nport = {free_port()}", feed):
        until(lambda: len(sent) > 5)
    assert not [record for record in caplog.records if record.exc_info]


def test_only_what_the_file_lists_is_written_and_within_its_limits(
    served: str, feed: GivenFeed, caplog: pytest.LogCaptureFixture
) -> None:
    def write(name: str, given: object) -> None:
        client.write(f"mill:{name}", given, notify=True, repeater=False, timeout=LIMIT_S)

    until(lambda: value("line") == 12)
    write("user:pulses", 1000.0)
    write("user:gate", 0)
    assert feed.written == [(12290, 1000.0, False), (2, 0.0, True)]
    for name, given in (("user:pulses", 1000.5), ("user:pulses", 0.5), ("line", 5)):
        with pytest.raises(CaprotoError):
            write(name, given)
    assert len(feed.written) == 2
    lines = [each.getMessage() for each in caplog.records if each.name == "caproto.circ"]
    assert [line for line in lines if line.startswith("refused: ")][:2] == [
        "refused: pulses: 1000.5 is not in -1000..1000",
        "refused: pulses is a whole number: 0.5 is not",
    ]
    assert not [record for record in caplog.records if record.exc_info]
    until(lambda: read("user:pulses", "time").metadata.severity == AlarmSeverity.NO_ALARM)


def limits(name: str) -> tuple[float, ...]:
    """Display limits, control limits and those of alarms, as a client reads them."""
    data = read(name, "control").metadata
    return (
        data.lower_disp_limit, data.upper_disp_limit,
        data.lower_ctrl_limit, data.upper_ctrl_limit,
        data.lower_alarm_limit, data.upper_alarm_limit,
    )  # fmt: skip


def test_limits_of_the_file_are_those_of_displays_and_of_what_is_written_of_controls(
    served: str,
) -> None:
    until(lambda: value("line") == 12)
    assert limits("user:pulses") == (-1000.0, 1000.0, -1000.0, 1000.0, 0.0, 0.0)
    assert limits("user:shown") == (-5.0, 2.5, 0.0, 0.0, 0.0, 0.0)
    assert limits("user:half") == limits("X:actual") == (0.0,) * 6


def test_other_computers_have_to_be_allowed() -> None:
    with pytest.raises(SourceError, match=r"other computers reach 192\.0\.2\.1, without"):
        parse_bridge('[epics]\naddress = "192.0.2.1"\n')
    assert parse_bridge('[epics]\naddress = "192.0.2.1"\ninsecure = true\n').epics is not None


def test_what_hosts_write_is_one_plain_value() -> None:
    assert [written(x) for x in ([1.5], 2, "on", ["off"], [1, 2])] == [1.5, 2, 1, 0, [1, 2]]


def test_values_that_do_not_fit_are_cut_or_unknown() -> None:
    items = {item.name: item for item in items_of(GivenFeed().axes)}
    line, block = items["line"], items["block"]
    assert shown(line, (1 << 31) - 1) == (1 << 31) - 1
    assert shown(line, 1 << 31) is None
    assert shown(block, "é" * 300) == "é" * 199
    assert channel_of(items["C.actual"]).units == "deg"
