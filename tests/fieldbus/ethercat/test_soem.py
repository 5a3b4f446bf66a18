"""Emulated slaves as SOEM sees them, a master of others (pysoem), over a cable of this computer."""

import struct
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import pytest
from tests.fieldbus.emulator import Emulator
from tests.fieldbus.ethercat.rig import INPUT, OUTPUT
from tests.fieldbus.ethercat.veth import emulated

pysoem = pytest.importorskip("pysoem", reason="pysoem is not installed")
pytestmark = pytest.mark.evidence("client", "SOEM by pysoem, a master used with real drives")

LIMIT_S = 60.0
WATCHDOG_MS = 6000.0  # tests are not to depend on how busy the computer is
REPLY_US = 200_000


class Soem:
    """A master on an interface."""

    def __init__(self, interface: str) -> None:
        self.master: Any = pysoem.Master()
        self.master.open(interface)

    def scan(self) -> list[Any]:
        self.until(lambda: self.master.config_init() > 0, "slaves are found")
        self.until(self._watched, "the watchdogs of all slaves are set")
        return list(self.master.slaves)

    def _watched(self) -> bool:
        """SOEM waits 2 ms for a frame, which a busy computer may miss."""
        try:
            for slave in self.master.slaves:
                slave.set_watchdog("processdata", WATCHDOG_MS)
        except pysoem.WkcError:
            return False
        return True

    def to_op(self, clock_ns: int = 0) -> None:
        self.master.config_map()
        assert self.master.config_dc()
        for slave in self.master.slaves:
            if clock_ns:
                slave.dc_sync(act=True, sync0_cycle_time=clock_ns)
        wanted = pysoem.SAFEOP_STATE
        assert self.master.state_check(wanted, 5_000_000) == wanted
        self.exchange()
        self.ask(pysoem.OP_STATE)

    def ask(self, state: int) -> None:
        self.master.state = state
        self.master.write_state()

        def is_there() -> bool:
            self.exchange()
            return bool(self.master.state_check(state, 20_000) == state)

        self.until(is_there, f"the slaves are in state {state}")

    def exchange(self) -> int:
        self.master.send_processdata()
        return int(self.master.receive_processdata(REPLY_US))

    def until(self, holds: Callable[[], bool], what: str) -> None:
        end = time.monotonic() + LIMIT_S
        while not holds():
            assert time.monotonic() < end, f"not within {LIMIT_S} s: {what}"

    def put(self, control: int, position: int = 0) -> None:
        for slave in self.master.slaves:
            if len(slave.output) == OUTPUT.size:
                slave.output = OUTPUT.pack(control, position, 0, 0, 0, 8)

    def status(self, slave: int = 0) -> int:
        return int(INPUT.unpack(self.master.slaves[slave].input)[0])

    def position(self, slave: int = 0) -> int:
        return int(INPUT.unpack(self.master.slaves[slave].input)[1])

    def enable(self, slave: int = 0) -> None:
        for control, shown in ((0x06, 0x21), (0x07, 0x23), (0x0F, 0x27)):
            self.put(control)

            def is_shown(wanted: int = shown) -> bool:
                self.exchange()
                return self.status(slave) & 0x6F == wanted

            self.until(is_shown, f"the drive answers {control:#x}")


@contextmanager
def soem(*words: str) -> Iterator[tuple[Soem, Emulator]]:
    with emulated(*words) as slaves:
        one = Soem(slaves.interface)
        try:
            yield one, slaves
        finally:
            one.master.close()


@pytest.mark.parametrize("drives", [1, 2, 8])
def test_soem_brings_drives_and_terminals_to_op(drives: int) -> None:
    with soem("--drives", str(drives), "--digital", "1", "--analog", "1") as (one, slaves):
        found = one.scan()
        names = ["drive"] * drives + ["digital", "analog"]
        assert [slave.name for slave in found] == names
        one.to_op()
        one.until(lambda: one.exchange() == one.master.expected_wkc, "all slaves count")
        assert one.master.expected_wkc == 3 * (drives + 2)
        said = slaves.end()
        assert [line.split(": ")[1].split(",")[0] for line in said.splitlines()[:-1]] == [
            "OP"
        ] * len(names)


def test_soem_reads_and_writes_objects() -> None:
    with soem("--drives", "1") as (one, _):
        (drive,) = one.scan()
        assert drive.sdo_read(0x1008, 0) == b"drive"
        drive.sdo_write(0x6085, 0, struct.pack("<I", 123_456))
        assert drive.sdo_read(0x6085, 0) == struct.pack("<I", 123_456)
        with pytest.raises(pysoem.SdoError) as refused:
            drive.sdo_write(0x6041, 0, b"\0\0")
        assert refused.value.abort_code == 0x06010002
        with pytest.raises(pysoem.SdoError) as unknown:
            drive.sdo_read(0x2000, 0)
        assert unknown.value.abort_code == 0x06020000


def test_soem_reads_what_objects_there_are() -> None:
    with soem("--drives", "1") as (one, _):
        (drive,) = one.scan()
        listed = {each.index: each for each in drive.od}
        assert listed[0x6040].name == b"Controlword"
        assert [entry.bit_length for entry in listed[0x60C2].entries] == [8, 8, 8]


@pytest.mark.parametrize("clock_ns", [0, 1_000_000])
def test_an_axis_moves_a_thousand_counts_in_csp(clock_ns: int) -> None:
    with soem("--drives", "2") as (one, _):
        one.scan()
        one.to_op(clock_ns)
        one.enable()
        for step in range(0, 1001, 10):
            one.put(0x0F, step)
            one.exchange()

        def is_there() -> bool:
            one.exchange()
            return [one.position(0), one.position(1)] == [1000, 1000]

        one.until(is_there, "both axes are at 1000")
        assert one.status() & 0x6F == 0x27


def test_another_mapping_is_exchanged() -> None:
    with soem("--drives", "1") as (one, _):
        (drive,) = one.scan()

        def mapped(_: int) -> None:
            for index, pdo in ((0x1C12, 0x1601), (0x1C13, 0x1A01)):
                drive.sdo_write(index, 0, b"\0")
                drive.sdo_write(index, 1, struct.pack("<H", pdo))
                drive.sdo_write(index, 0, b"\1")

        drive.config_func = mapped
        one.to_op()
        assert (len(drive.output), len(drive.input)) == (6, 6)
        assert one.exchange() == 3


def test_a_slave_without_power_is_missed_and_recovered() -> None:
    with soem("--digital", "2") as (one, slaves):
        one.scan()
        one.to_op()
        last = one.master.slaves[1]
        assert slaves.say("power-off 1") == "slave 1 has no power"
        one.until(lambda: one.exchange() == 3, "one slave counts")
        one.master.read_state()
        assert (one.master.slaves[0].state, last.state) == (pysoem.OP_STATE, pysoem.NONE_STATE)
        assert slaves.say("power-on 1") == "slave 1 has power"
        last.is_lost = True
        one.until(lambda: last.recover(20_000) > 0, "the slave is found again")
        one.until(lambda: last.reconfig(20_000) >= pysoem.SAFEOP_STATE, "it is configured anew")
        one.ask(pysoem.OP_STATE)
        one.until(lambda: one.exchange() == 6, "both slaves count")


def test_a_cable_that_is_pulled_out_leaves_the_slaves_before_it() -> None:
    with soem("--digital", "3") as (one, slaves):
        one.scan()
        one.to_op()
        slaves.say("cable-out 1")
        one.until(lambda: one.exchange() == 3, "the first slave alone counts")
        slaves.say("cable-in")
        one.until(lambda: one.exchange() == 9, "all slaves count")


def test_an_emergency_arrives_when_a_drive_fails() -> None:
    with soem("--drives", "1") as (one, slaves):
        (drive,) = one.scan()
        heard: list[Any] = []
        drive.add_emergency_callback(heard.append)
        one.to_op()
        one.enable()
        slaves.say("drive-fault 0 0x7305")

        def has_failed() -> bool:
            one.exchange()
            return one.status() & 0x6F == 0x08

        one.until(has_failed, "the drive shows its fault")
        assert drive.sdo_read(0x603F, 0) == struct.pack("<H", 0x7305)
        assert [each.error_code for each in heard] == [0x7305]
