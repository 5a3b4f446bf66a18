"""`openacr bus watch`: a line for every change."""

from collections.abc import Iterator
from contextlib import contextmanager

import pytest
from tests.fieldbus.bus_rig import SegmentLink
from typer.testing import CliRunner

from openacr.cli import bus_watch
from openacr.cli.bus_watch import changes
from openacr.cli.main import app
from openacr.fieldbus.ethercat.emulated.build import drives_world, segment_of
from openacr.fieldbus.ethercat.master.device import Device, scan
from openacr.fieldbus.ethercat.master.master import Master
from openacr.fieldbus.ethercat.master.port import Port
from openacr.fieldbus.ethercat.wire.registers import Register


def test_each_change_of_a_device_is_a_line_and_nothing_else_is() -> None:
    segment = segment_of(drives_world(1), digital=1)
    devices = scan(Port(SegmentLink(segment)))
    before = [""] * 2
    assert list(changes(devices, before)) == ["device 0 (drive): INIT", "device 1 (digital): INIT"]
    assert list(changes(devices, before)) == []
    Master(devices[0].port, [devices[0]]).to_preop()
    assert list(changes(devices, before)) == ["device 0 (drive): PREOP"]
    memory = segment.slaves[0].controller.memory
    memory[Register.RX_ERRORS], memory[Register.RX_ERRORS + 3] = 2, 1
    assert list(changes(devices, before)) == ["device 0 (drive): PREOP, 3 damaged frames"]
    segment.power(1, False)
    said = "device 0 (drive): PREOP, 3 damaged frames, 1 lost link"
    assert list(changes(devices, before)) == [said, "device 1 (digital): does not answer"]
    devices[0].port.write_word(devices[0].station, Register.AL_CONTROL, 8)
    assert "invalid requested state change" in "".join(changes(devices, before))


def test_a_watch_ends_after_its_time(monkeypatch: pytest.MonkeyPatch) -> None:
    @contextmanager
    def found(_interface: str) -> Iterator[list[Device]]:
        yield scan(Port(SegmentLink(segment_of(drives_world(1)))))

    monkeypatch.setattr(bus_watch, "open_bus", found)
    monkeypatch.setattr(bus_watch, "EVERY_S", 0.001)
    result = CliRunner().invoke(app, ["bus", "watch", "eth9", "--seconds", "0.05"])
    assert result.exit_code == 0
    (line,) = result.output.splitlines()
    assert line.strip().endswith("s  device 0 (drive): INIT")
