"""The machine.toml that a scan writes, and what a scan finds of a segment."""

import pytest
from tests.fieldbus.bus_rig import SegmentLink

from openacr.fieldbus.ethercat.emulated.build import drives_world, segment_of
from openacr.fieldbus.ethercat.master.device import scan
from openacr.fieldbus.ethercat.master.master import Master
from openacr.fieldbus.ethercat.master.port import Port
from openacr.fieldbus.ethercat.master.sdo import Objects, SdoError
from openacr.fieldbus.machine.bringing_up import bring_up
from openacr.fieldbus.machine.written import machine_file
from openacr.plant.describe.load import parse_world


def test_a_scan_writes_a_file_with_which_the_bus_comes_up() -> None:
    segment = segment_of(drives_world(2), digital=2, analog=1)
    devices = scan(Port(SegmentLink(segment)))
    assert [device.is_drive for device in devices] == [True, True, False, False, False]
    text = machine_file("eth1", devices)
    world = parse_world(text)
    assert world.bus is not None
    assert [axis.label for axis in world.axis] == ["X", "Y"]
    assert [each.inputs_from for each in world.bus.terminal] == [0, 8, None]
    assert [each.outputs_from for each in world.bus.terminal] == [32, 40, None]
    assert [(each.adcs_from, each.adcs) for each in world.bus.terminal][2] == (0, 4)
    assert "# dacs = 4" in text
    brought = bring_up(SegmentLink(segment), world, 0.0005)
    assert sorted(brought.drives) == [0, 1]


def test_objects_are_read_and_written_by_one_master_after_another() -> None:
    segment = segment_of(drives_world(1))
    for turn in range(9):
        (device,) = scan(Port(SegmentLink(segment)))
        if turn == 0:
            Master(device.port, [device]).to_preop()
        Objects(device).write(0x6085, 0, (1000 + turn).to_bytes(4, "little"))
        assert Objects(device).number(0x6085) == 1000 + turn


def test_a_refused_object_is_named_with_its_reason() -> None:
    (device,) = scan(Port(SegmentLink(segment_of(drives_world(1)))))
    Master(device.port, [device]).to_preop()
    with pytest.raises(SdoError, match=r"object 0x5555:0: the object does not exist"):
        Objects(device).read(0x5555)


def test_a_text_that_is_no_number_of_four_bytes_is_read_whole() -> None:
    segment = segment_of(drives_world(1))
    (device,) = scan(Port(SegmentLink(segment)))
    Master(device.port, [device]).to_preop()
    assert Objects(device).read(0x1008) == b"drive"
