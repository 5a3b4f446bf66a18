"""Drive Talk over a pseudo-terminal with a modelled Aries at its end, which can be killed."""

import os
import pty
import time
import tty
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.network.talk import LOST, TIMEOUT, TORQUE, Bench, axis, control, talking

from openacr.controller import Controller
from openacr.errors import UserError
from openacr.fieldbus.drivetalk.real_drives import RealDrives
from openacr.io.drive_line import DriveLine
from openacr.plant.bus import rs485
from openacr.plant.describe.load import parse_world

LIMIT_S = 60.0
MOTOR = axis(0, TORQUE)


class Aries:
    """A modelled drive at the far end of a pseudo-terminal whose other end is a path."""

    def __init__(self, path: Path) -> None:
        self.drive = Controller(world=parse_world(MOTOR + talking(0, address=1)))
        self._path = path
        self._heard = b""
        self.own = -1
        self.connect()

    def connect(self) -> None:
        self.own, theirs = pty.openpty()
        tty.setraw(theirs)
        os.set_blocking(self.own, False)
        self._path.unlink(missing_ok=True)
        self._path.symlink_to(os.ttyname(theirs))
        os.close(theirs)

    def serve(self) -> None:
        if self.own < 0:
            return
        try:
            self._heard += os.read(self.own, 4096)
        except (BlockingIOError, OSError):  # nothing there, or no one has it open
            return
        *lines, self._heard = self._heard.split(b"\r")
        for line in lines:
            for answer in rs485.exchange(self.drive.memory, 2, 9600, 10, line.decode()):
                os.write(self.own, answer.encode())

    def kill(self) -> None:
        os.close(self.own)
        self.own = -1


@pytest.fixture
def far(tmp_path: Path) -> Iterator[Aries]:
    made = Aries(tmp_path / "drive")
    yield made
    if made.own >= 0:
        made.kill()


class Paced(Bench):
    """A card that is no faster than the clock, with a real drive."""

    def __init__(self, far: Aries, path: Path) -> None:
        super().__init__(axes=1)
        self.far = far
        table = parse_world(MOTOR + talking(0, serial=str(path))).drive
        self.line = DriveLine(str(path))
        drives = RealDrives(table, lambda _: self.line)
        drives.allow()
        self.card.networks.connect_drives(drives)
        self.open(0)

    def get(self) -> None:
        self.card.bit[control(0, 1)] = True
        end = time.monotonic() + LIMIT_S
        while self.card.bit[control(0, 1)]:
            assert time.monotonic() < end
            self.far.serve()
            self.card.advance(2)
            time.sleep(0.001)


def test_a_drive_is_read_killed_missed_and_found_again(
    far: Aries, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    bench = Paced(far, tmp_path / "drive")
    bench.get()
    assert [bench.card.p[28674 + n] for n in range(6)] == [2, 4000, 4000, 12, 1.5, 0]
    assert bench.troubles() == []
    far.kill()
    bench.get()
    assert bench.troubles() == [LOST, TIMEOUT]
    assert f"serial port {tmp_path / 'drive'} failed: Input/output error" in caplog.text
    bench.get()
    assert "cannot open serial port" in caplog.text
    far.connect()
    bench.card.p[28674] = 0
    bench.get()
    assert bench.card.p[28674] == 2
    bench.line.close()


def test_what_arrived_before_a_question_is_no_answer_to_it(far: Aries, tmp_path: Path) -> None:
    bench = Paced(far, tmp_path / "drive")
    bench.get()
    os.write(far.own, b"*99\r\n")
    bench.card.p[28674] = 0
    bench.get()
    assert bench.card.p[28674] == 2
    bench.line.close()


def test_the_speed_follows_the_program(far: Aries, tmp_path: Path) -> None:
    line = DriveLine(str(tmp_path / "drive"))
    with pytest.raises(UserError, match="is not open"):
        line.send(b"x")
    assert line.take() == b""
    for baud in (9600, 19200):
        line.open(baud)
        assert line._port is not None and line._port.baudrate == baud
    line.send(b"TPE\r")
    assert os.read(far.own, 10) == b"TPE\r"
    line.close()
    line.close()
