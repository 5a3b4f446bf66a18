"""Devices in branches: where each one is, what is refused."""

import pytest
from tests.fieldbus.bus_rig import SegmentLink

from openacr.cli.bus import _line, _record
from openacr.fieldbus.ethercat.emulated.build import drives_world, segment_of
from openacr.fieldbus.ethercat.emulated.segment import Segment
from openacr.fieldbus.ethercat.master.device import Device, scan
from openacr.fieldbus.ethercat.master.port import BusError, Port
from openacr.fieldbus.ethercat.master.topology import open_ports, places
from openacr.fieldbus.ethercat.wire.registers import Register
from openacr.fieldbus.machine.bringing_up import bring_up
from openacr.fieldbus.machine.written import machine_file
from openacr.plant.describe.load import parse_world


@pytest.mark.parametrize(
    ("ports", "expected"),
    [
        ([[1], [1], []], [None, (0, 1), (1, 1)]),
        ([[3, 1], [], []], [None, (0, 3), (0, 1)]),
        ([[3, 1, 2], [1], [], [], []], [None, (0, 3), (1, 1), (0, 1), (0, 2)]),
        ([[1], [3, 2], [1], [], []], [None, (0, 1), (1, 3), (2, 1), (1, 2)]),
        ([[], []], [None, (0, 1)]),
    ],
)
def test_the_next_device_is_at_the_first_free_port_of_the_latest_device_that_has_one(
    ports: list[list[int]], expected: list[tuple[int, int] | None]
) -> None:
    assert places(ports) == expected


def test_open_ports_are_those_that_communicate_in_the_order_of_a_frame() -> None:
    assert open_ports(0x0200) == []
    assert open_ports(0xAA00) == [3, 1, 2]
    assert open_ports(0x8A00) == [3, 1]
    assert open_ports(0x55FF) == []


def branched() -> Segment:
    """Device 0 has device 1 at port 3 and device 2 at port 1."""
    segment = segment_of(drives_world(2), digital=1)
    for slave, status in zip(segment.slaves, (0x8A01, 0x0201, 0x0201), strict=True):
        slave.controller.put(Register.DL_STATUS, status, 2)
    return segment


def found(segment: Segment) -> list[Device]:
    return scan(Port(SegmentLink(segment)))


def test_a_scan_shows_what_is_in_a_branch() -> None:
    devices = found(branched())
    assert [device.is_in_line for device in devices] == [True, True, False]
    lines = [_line(device) for device in devices]
    assert lines[2].endswith("alias 0, in a branch at port 1 of device 0")
    assert "branch" not in lines[0] + lines[1]
    rows = [_record(device) for device in devices]
    assert [(row["after"], row["port"]) for row in rows] == [(None, None), (0, 3), (0, 1)]


def test_clocks_in_branches_are_refused_by_a_sentence_and_the_rest_works() -> None:
    segment = branched()
    text = machine_file("eth1", found(segment))
    with pytest.raises(BusError, match=r"device 2 \(digital\) is in a branch, at port 1 of device"):
        bring_up(SegmentLink(segment), parse_world(text), 0.0005)
    text = text.replace("dc = true", "dc = false")
    assert sorted(bring_up(SegmentLink(segment), parse_world(text), 0.0005).drives) == [0, 1]
