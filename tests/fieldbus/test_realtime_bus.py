"""Drives on a bus whose frames the real-time loop exchanges; the segment is a process beside."""

import ctypes
import json
import select
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from tests.fieldbus.bus_rig import SegmentLink
from tests.fieldbus.test_drives_on_a_card import RAMP, machine

from openacr import compiled
from openacr.channels import StreamKind
from openacr.controller import Controller
from openacr.fieldbus.cia402.states import State
from openacr.fieldbus.ethercat.emulated.build import segment_of
from openacr.fieldbus.ethercat.wire.registers import ERROR
from openacr.fieldbus.ethercat.wire.registers import State as DeviceState
from openacr.fieldbus.machine import exchange_cy as at
from openacr.fieldbus.machine.realtime_bus import RealtimeBus
from openacr.fieldbus.machine.report import BusReport, LoopReport, TimesReport
from openacr.map.rows import axes
from openacr.map.words import af4
from openacr.plant.describe.load import parse_world
from openacr.plant.describe.real_world import real_world

ROOT = Path(__file__).parents[2]
PATIENCE_S = 60.0
PERIOD_S = 0.002  # on a busy computer an emulated segment has to answer in half of it
PATIENT = "lost_frames = 500\nlate_s = 10.0\nenable_s = 10.0\n"

pytestmark = [
    pytest.mark.skipif(sys.platform != "linux", reason="the loop is for Linux"),
    pytest.mark.skipif(not compiled.is_compiled, reason="needs the compiled core"),
]


class PairLink:
    """Frames to a process at the other end of a pair of sockets."""

    name = "pair"

    def __init__(self, end: socket.socket) -> None:
        self._end = end

    def fileno(self) -> int:
        return self._end.fileno()

    def exchange(self, frame: bytes) -> bytes | None:
        self._end.send(frame)
        while select.select([self._end], [], [], 2.0)[0]:
            back = self._end.recv(2048)
            if back[17] == frame[17]:
                return back
        return None

    def now_s(self) -> float:
        return time.monotonic()

    def pause(self, seconds: float) -> None:
        time.sleep(seconds)

    def close(self) -> None:
        """Its sockets are closed by who made them."""


class LiveOnBus:
    """A card in real time with its drives on a bus, and a host at P00."""

    def __init__(self, text: str, link: PairLink, commands: socket.socket) -> None:
        self._commands = commands
        world = real_world(parse_world(text))
        self.made = Controller(world.card.board, world=world)
        numbers = [axis.number for axis in world.axis]
        attached = [f"ATTACH AXIS{n} ENC{n} DAC{n} ENC{n}" for n in numbers]
        slaves = [f'ATTACH SLAVE{n} AXIS{n} "{"XY"[n]}"' for n in numbers]
        scale = [f"MULT {'XY'[n]}4" for n in numbers]
        setup = ["SYS", *attached, "PROG0", "ATTACH MASTER0", *slaves, *scale, *RAMP]
        for line in (*setup, f"PERIOD {PERIOD_S}"):
            self.made.send(line + "\r")
        self.bus = RealtimeBus(self.made.card, world, link, is_real=True)
        self.card = self.made.real_time(PATIENCE_S, self.bus)
        self.card.start()
        self.stream = self.card.open_stream(StreamKind.TERMINAL)
        self.send("PROG0")

    def send(self, text: str) -> None:
        self.card.receive(self.stream, text.encode() + b"\r")

    def until(self, is_met: Callable[[], bool]) -> None:
        limit_s = time.monotonic() + PATIENCE_S
        while not is_met():
            assert time.monotonic() < limit_s, (self.bus.alarm, [d.alarm for d in self.bus.drives])
            self.card.advance()
            self.card.take_output(self.stream)
            self.card.see()
            time.sleep(0.001)

    def states(self, fault: str = "state") -> list[str]:
        """Cause a fault; position and state of each drive."""
        self._commands.send(fault.encode())
        return self._commands.recv(2048).decode().split("\n")

    def drives(self, fault: str = "state") -> list[float]:
        """Cause a fault; where the motors of the drives are [counts]."""
        return [float(line.split()[0]) for line in self.states(fault)]

    def flags(self, n: int = 0) -> int:
        return self.made.memory.I[af4.word[n]]

    def is_enabled(self, n: int = 0) -> bool:
        return bool(self.flags(n) & af4.DRIVE_ENABLED)

    def position(self, n: int = 0) -> int:
        return self.made.memory.I[axes.actual_position[n]]

    def switch_on(self) -> None:
        before = self.bus.memory.rows[at.GOOD]
        self.until(lambda: self.bus.memory.rows[at.GOOD] > before + 5)
        self.send("DRIVE ON X")
        self.until(self.is_enabled)


@contextmanager
def segment_beside(text: str, digital: int = 0) -> Iterator[tuple[PairLink, socket.socket]]:
    """An emulated segment in a process of its own: a link to it, and a socket for commands."""
    frames, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_DGRAM)
    commands, their_commands = socket.socketpair(socket.AF_UNIX, socket.SOCK_DGRAM)
    numbers = [theirs.fileno(), their_commands.fileno()]
    command = [sys.executable, "-m", "tests.fieldbus.segment_process", *map(str, numbers)]
    with subprocess.Popen(
        [*command, str(digital)], cwd=ROOT, stdin=subprocess.PIPE, pass_fds=numbers, text=True
    ) as process:
        assert process.stdin is not None
        process.stdin.write(text)
        process.stdin.close()
        commands.settimeout(PATIENCE_S)  # the process may have ended
        assert commands.recv(64) == b"ready"
        try:
            yield PairLink(frames), commands
        finally:
            process.kill()
            for each in (frames, theirs, commands, their_commands):
                each.close()


@contextmanager
def live_on_bus(text: str, digital: int = 0) -> Iterator[LiveOnBus]:
    with segment_beside(text, digital) as (link, commands):
        live = LiveOnBus(text, link, commands)
        try:
            yield live
        finally:
            live.card.close()
            live.made.close()


def test_enabling_moves_nothing_and_a_move_arrives_to_the_count() -> None:
    with live_on_bus(machine(more=PATIENT)) as live:
        before = live.drives()[0]
        live.switch_on()
        live.until(lambda: live.card.is_settled)
        assert abs(live.drives()[0] - before) < 1.0
        live.send("X5000")
        live.until(lambda: live.position() == 5000)
        live.send("X-300")
        live.until(lambda: live.position() == -300)
        live.until(lambda: abs(live.drives()[0] - before + 300) < 1.0)
        live.send("DRIVE OFF X")
        live.until(lambda: not live.is_enabled())


def test_python_that_holds_its_lock_stops_no_frame_and_no_move() -> None:
    held = ctypes.PyDLL(None).usleep
    with live_on_bus(machine(more=PATIENT)) as live:
        live.switch_on()
        live.send("X20000")
        live.until(lambda: live.position() > 1000)
        sent, there = live.bus.cycles, live.drives()[0]
        held(400_000)
        assert live.bus.cycles > sent
        assert live.drives()[0] > there + 1000
        live.until(lambda: live.position() == 20000)


def test_who_only_asks_for_the_status_however_often_keeps_no_drive_from_being_led() -> None:
    with live_on_bus(machine(more=PATIENT)) as live:
        before = live.bus.memory.rows[at.GOOD]
        live.until(lambda: live.bus.memory.rows[at.GOOD] > before + 5)
        live.send("DRIVE ON X")
        live.until(lambda: bool(live.card.fast_status()) and live.is_enabled())


def test_frames_that_are_lost_stop_all_drives_and_drive_res_brings_the_bus_up_again() -> None:
    with live_on_bus(machine(more=PATIENT.replace("500", "100"))) as live:
        live.switch_on()
        live.drives("cable-out 0")
        live.until(lambda: "no frame comes back" in live.bus.alarm)
        live.until(lambda: bool(live.flags() & af4.DRIVE_FAULT) and not live.is_enabled())
        live.drives("cable-in")
        live.send("DRIVE RES X")
        live.until(lambda: not live.bus.alarm)
        live.until(lambda: not live.flags() & af4.DRIVE_RESET_REQUEST)
        live.until(lambda: live.bus.drives[0].drive.state is State.DISABLED)


def test_at_the_end_drives_are_switched_off_at_rest_without_a_fault() -> None:
    with live_on_bus(machine(more=PATIENT)) as live:
        live.switch_on()
        live.send("X100000")
        live.until(lambda: live.position() > 1000)
        assert "ENABLED" in live.states()[0]
        live.card.close()
        (state,) = live.states()
        assert " DISABLED at" in state
        there = live.made.memory.I[axes.secondary_setpoint[0]]
        assert 1000 < there < 100_000
        assert abs(live.position() - there) < 50
        (at_rest,) = live.drives()
        time.sleep(0.05)
        assert live.drives() == [pytest.approx(at_rest, abs=1.0)]


def test_a_drive_that_reports_a_fault_stops_its_axis() -> None:
    with live_on_bus(machine(axes=2, more=PATIENT)) as live:
        live.switch_on()
        live.send("DRIVE ON Y")
        live.until(lambda: live.is_enabled(1))
        live.drives("drive-fault 0")
        live.until(lambda: bool(live.flags(0) & af4.DRIVE_FAULT) and not live.is_enabled(0))
        assert live.is_enabled(1)
        live.until(lambda: bool(live.bus.drives[0].alarm))
        assert "fault" in live.bus.drives[0].alarm or "operation" in live.bus.drives[0].alarm


def test_a_position_that_jumps_stops_its_axis_within_the_loop() -> None:
    with live_on_bus(machine(more=PATIENT)) as live:
        live.switch_on()
        live.drives("encoder-jump 0 1000000")
        live.until(lambda: "its position jumped by" in live.bus.drives[0].alarm)
        live.until(lambda: bool(live.flags() & af4.DRIVE_FAULT) and not live.is_enabled())


def states(report: BusReport) -> list[str]:
    return [one["state"] for one in report["devices"]]


def test_a_bus_in_real_time_reports_devices_drives_counters_and_the_figures_of_its_loop() -> None:
    with live_on_bus(machine(axes=2, more=PATIENT), digital=1) as live:
        live.switch_on()
        live.until(lambda: states(live.card.report()) == ["OP", "OP", "PREOP"])
        live.until(lambda: live.card.report()["drives"][0]["state"] == "OPERATING")
        report = json.loads(json.dumps(live.card.report()))
        assert (report["interface"], report["is_real"], report["alarm"]) == ("pair", True, "")
        assert (report["cycle_s"], report["loop"]["period_s"]) == (PERIOD_S, PERIOD_S)
        assert [one["name"] for one in report["devices"]] == ["drive", "drive", "digital"]
        shown = [(one["axis"], one["mode"], one["is_enabled"]) for one in report["drives"]]
        assert shown == [("X", 8, True), ("Y", 8, False)]
        assert 0 < report["counters"]["sent"] <= report["loop"]["cycles"] + 1
        late = report["loop"]["late"]
        assert 0.0 < late["median_s"] <= late["most_s"] <= late["worst_s"]
        live.send("X5000")
        live.until(lambda: live.position() == 5000)
        live.until(lambda: live.card.report()["drives"][0]["target"] == 5000)
        live.drives("power-off 2")
        live.until(lambda: states(live.card.report())[2] == "")


def test_counters_and_figures_of_a_loop_begin_at_0_when_they_are_reset() -> None:
    with live_on_bus(machine(more=PATIENT)) as live:
        live.until(lambda: live.card.report()["counters"]["sent"] > 20)
        before = live.card.report()
        live.card.reset_counters()
        live.until(lambda: live.card.report()["counters"]["sent"] < before["counters"]["sent"])
        loop = live.card.report()["loop"]
        assert loop is not None
        assert loop["cycles"] < 20


class InMemory(SegmentLink):
    """A link for a bus whose loop does not live."""

    def fileno(self) -> int:
        return -1


def test_what_a_device_has_answered_is_shown_with_its_error_in_words() -> None:
    text = machine(axes=2)
    world = real_world(parse_world(text))
    made = Controller(world.card.board, world=world)
    link = InMemory(segment_of(parse_world(text), digital=1))
    bus = RealtimeBus(made.card, world, link, is_real=False)
    bus.connect()
    times = TimesReport(median_s=1e-6, most_s=2e-6, worst_s=3e-6)
    loop = LoopReport(period_s=0.0005, cycles=7, missed=0, lost_s=0.0, late=times, computing=times)
    report = bus.report(loop)
    assert states(report) == ["OP", "OP", "PREOP"]
    assert (report["is_real"], report["loop"], report["drives"][1]["state"]) == (False, loop, "")
    heard = at.FIRST_DEVICE + at.DEVICE_ROWS
    bus.memory.rows[heard + at.AL_STATUS] = DeviceState.SAFEOP | ERROR
    bus.memory.rows[heard + at.AL_CODE] = 0x1B
    bus.memory.rows[heard + at.DEVICE_ROWS + at.AL_STATUS] = 0
    _, second, third = bus.report(loop)["devices"]
    assert (second["state"], second["code"]) == ("SAFEOP", 0x1B)
    assert second["text"] == "sync manager watchdog"
    assert (third["state"], third["code"], third["text"]) == ("", 0, "")
