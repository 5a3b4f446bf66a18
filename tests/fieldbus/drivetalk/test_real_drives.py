"""Drive Talk of a card to drives on serial lines; the far end is modelled, in time of the card."""

from collections.abc import Callable

import pytest
from tests.network.talk import (
    ADDRESS_ERROR,
    LOST,
    TIMEOUT,
    TORQUE,
    Bench,
    axis,
    control,
    talking,
)

from openacr.controller import Controller
from openacr.errors import UserError
from openacr.fieldbus.drivetalk.real_drives import RealDrives
from openacr.plant.bus import rs485
from openacr.plant.describe.load import parse_world
from openacr.plant.describe.real_world import real_world

AUTO, GET, SEND, ERRORL, DATA = range(5)

PAUSE, PAUSE_S = ord("|"), 0.2  # in what a wire says


class Wire:
    """A serial line whose far end is the drives of another machine; answers take 3 ms."""

    def __init__(self, path: str, far: Controller, now_s: Callable[[], float]) -> None:
        self.path, self.far, self.now_s = path, far, now_s
        self.sent: list[str] = []
        self.baud = 0
        self.failure = ""
        self.said: Callable[[str], bytes] | None = None  # instead of the drives
        self._coming: list[tuple[float, bytes]] = []

    def open(self, baud: int) -> None:
        if self.failure:
            raise UserError(self.failure)
        self.baud = baud

    def send(self, data: bytes) -> None:
        if self.failure:
            raise UserError(self.failure)
        text = data.decode().removesuffix("\r")
        self.sent.append(text)
        if self.said is None:
            answers = rs485.exchange(self.far.memory, 2, self.baud, 10, text)
            back = "".join(answers).encode()
        else:
            back = self.said(text)
        at_s, self._coming = self.now_s() + 0.003, []
        for byte in back:
            at_s += PAUSE_S if byte == PAUSE else 0.001
            if byte != PAUSE:
                self._coming.append((at_s, bytes((byte,))))

    def take(self) -> bytes:
        if self.failure:
            raise UserError(self.failure)
        there = [byte for at_s, byte in self._coming if at_s <= self.now_s()]
        self._coming = self._coming[len(there) :]
        return b"".join(there)


class RealBench(Bench):
    """A card with real drives."""

    def __init__(self, *drives: str, is_real: bool = True, far: str = "") -> None:
        super().__init__(axes=2)
        motors = "".join(axis(n, TORQUE) for n in range(2))
        file = parse_world(motors + "".join(drives))
        assert all(each.serial is None for each in real_world(file).drive)
        self.far = Controller(world=parse_world(motors + (far or talking(0, address=1))))
        self.wires: dict[str, Wire] = {}
        self.real = RealDrives(file.drive, self._wire)
        if is_real:
            self.real.allow()
        self.card.networks.connect_drives(self.real)

    def _wire(self, path: str) -> Wire:
        self.wires[path] = Wire(path, self.far, lambda: self.card.time_s)
        return self.wires[path]


def one(**keys: object) -> str:
    return talking(0, serial="/dev/a", **keys)


def test_a_real_drive_is_addressed_asked_and_configured() -> None:
    bench = RealBench(one(), far=talking(0, drive_temp_c=41.5))
    bench.open(0)
    bench.request(0, AUTO)
    bench.request(0, GET)
    assert [bench.card.p[28674 + n] for n in range(6)] == [2, 4000, 4000, 12, 1.5, 0]
    bench.card.p[28676] = 1234
    bench.request(0, SEND)
    bench.card.bit[control(0, 8 + 12)] = True
    bench.request(0, DATA)
    assert bench.troubles() == []
    wire = bench.wires["/dev/a"]
    assert wire.baud == 9600 and wire.sent[:3] == ["ADDR1", "1_ADDR", "1_DMODE"]
    assert "1_SMPER1234" in wire.sent
    assert rs485.exchange(bench.far.memory, 2, 9600, 10, "1_SMPER") == ["*1234\r\n"]


def test_a_terminal_talks_to_a_real_drive() -> None:
    bench = RealBench(one())
    bench.open(0)
    bench.type("DTALK X")
    assert bench.say("TPE") == "*0"
    assert bench.say("TREV", 0.3) == "|*Aries OS Revision 2.00"
    bench.escape()


@pytest.mark.parametrize(
    "said",
    [
        lambda text: f"{text}\r*7\r\n".encode(),  # an echo
        lambda text: f"{text}\r\n*7\r\n".encode(),
        lambda text: f"> {text}\r\n*7\r\n> ".encode(),  # a prompt
        lambda text: b"*7\r",
        lambda text: b"*7",  # without an end
        lambda text: b"*|7\r\n",  # with a pause
        lambda text: f"{text}\r\n|*7\r\n".encode(),
    ],
)
def test_echo_prompt_and_line_ends_of_a_drive_do_not_matter(said: Callable[[str], bytes]) -> None:
    bench = RealBench(one())
    bench.open(0)
    bench.wires["/dev/a"].said = said
    bench.request(0, GET)
    assert [bench.card.p[28674 + n] for n in range(6)] == [7] * 6
    assert bench.troubles() == []
    bench.type("DTALK X")
    assert bench.say("TPE", 0.6) == "*7"


def test_a_drive_that_only_echoes_what_is_written_has_taken_it() -> None:
    bench = RealBench(one())
    bench.open(0)
    bench.wires["/dev/a"].said = lambda text: f"{text}\r\n".encode()
    assert bench.request(0, ERRORL) < 0.5
    assert bench.troubles() == []


# what goes wrong


def test_a_silent_line_times_out_after_a_second_and_a_known_drive_is_lost() -> None:
    bench = RealBench(one())
    bench.open(0)
    wire = bench.wires["/dev/a"]
    wire.said = lambda text: b""
    assert bench.request(0, GET) == pytest.approx(1.0, abs=0.06)
    assert bench.troubles() == [TIMEOUT]
    wire.said = None
    bench.request(0, GET)
    wire.said = lambda text: b""
    bench.request(0, GET)
    assert bench.troubles() == [LOST, TIMEOUT]
    wire.said = None
    bench.request(0, GET)
    assert bench.card.p[28674] == 2


@pytest.mark.parametrize(
    "said", [b"\xff\x80\x13\r\n", b"*1\x00\r\n", b"x" * 257, b"*12\r\n" * 60], ids=range(4)
)
def test_garbage_is_an_address_error_and_ends_in_time(said: bytes) -> None:
    bench = RealBench(one())
    bench.open(0)
    bench.wires["/dev/a"].said = lambda text: said
    assert bench.request(0, GET) < 1.0
    assert bench.troubles() == [ADDRESS_ERROR]
    assert bench.card.p[28674] == 0


def test_a_port_that_is_gone_is_said_once_and_no_drive_answers(
    caplog: pytest.LogCaptureFixture,
) -> None:
    bench = RealBench(one())
    bench.open(0)
    wire = bench.wires["/dev/a"]
    wire.failure = "serial port /dev/a failed: No such device"
    for _ in range(3):
        assert bench.request(0, GET) == pytest.approx(1.0, abs=0.06)
    assert bench.troubles() == [TIMEOUT]
    assert caplog.text.count("No such device") == 1
    wire.failure = ""
    bench.request(0, GET)
    assert bench.card.p[28674] == 2
    bench.card.bit[control(0, GET)] = True
    bench.card.advance(seconds=0.055)
    wire.failure = "gone again"
    assert bench.card.until(control(0, GET), is_=False, timeout_s=2.0)
    assert "gone again" in caplog.text and LOST in bench.troubles()
    wire.failure = ""
    bench.request(0, GET)
    wire.failure = "gone again"
    bench.request(0, GET)
    assert caplog.text.count("gone again") == 2, "it had answered in between"


def test_wrong_settings_of_a_program_reach_no_drive() -> None:
    bench = RealBench(one())
    bench.open(0, device="COM2:9600,E,8,1")
    bench.request(0, GET)
    bench.type("CLOSE #1")
    bench.open(0, device="COM1:9600,N,8,1")
    bench.request(0, GET)
    assert bench.troubles() == [TIMEOUT] and bench.wires["/dev/a"].sent == []


def test_without_leave_a_drive_is_only_read(caplog: pytest.LogCaptureFixture) -> None:
    bench = RealBench(one(), is_real=False)
    bench.open(0)
    bench.request(0, GET)
    assert bench.card.p[28674] == 2 and bench.troubles() == []
    bench.request(0, SEND)
    assert bench.troubles() == [LOST, TIMEOUT]
    assert "was not sent to the drive of axis 0: it is only read" in caplog.text
    bench.type("DTALK X")
    bench.say("TPE:SMPER5", 1.2)
    bench.say("RESET", 1.2)
    assert [text for text in bench.wires["/dev/a"].sent if not text.startswith("1_")] == []
    assert not [text for text in bench.wires["/dev/a"].sent if "5" in text or "RESET" in text]


def test_drives_on_one_line_are_not_addressed_together(caplog: pytest.LogCaptureFixture) -> None:
    far = talking(0, address=1) + talking(1, address=2)
    bench = RealBench(one(), talking(1, serial="/dev/a"), far=far)
    bench.open(0, 1)
    bench.request(1, AUTO)
    assert bench.troubles() == [ADDRESS_ERROR] and bench.wires["/dev/a"].sent == []
    assert "/dev/a leads to 2 drives" in caplog.text
    bench.card.p[28676 + 256] = 77
    bench.request(1, SEND)
    assert rs485.exchange(bench.far.memory, 2, 9600, 10, "2_SMPER") == ["*77\r\n"]


def test_drives_with_lines_of_their_own_are_addressed_each() -> None:
    bench = RealBench(one(), talking(1, serial="/dev/b"), far=talking(0))
    bench.wires["/dev/b"].far = Controller(world=parse_world(axis(0) + talking(0)))
    bench.open(0, 1)
    bench.card.bit[11104] = True  # all axes of COM2
    assert bench.card.until(11104, is_=False, timeout_s=5.0)
    assert bench.wires["/dev/a"].sent == ["ADDR1", "1_ADDR"]
    assert bench.wires["/dev/b"].sent == ["ADDR2", "2_ADDR"]
    assert bench.troubles() == []


def test_modelled_drives_answer_beside_real_ones() -> None:
    bench = RealBench(one(), far=talking(0, address=1))
    modelled = Bench(talking(1, address=2), axes=2)
    modelled.card.networks.connect_drives(bench.real)
    bench.wires["/dev/a"].now_s = lambda: modelled.card.time_s
    modelled.open(0, 1)
    modelled.request(0, GET)
    modelled.request(1, GET)
    assert (modelled.card.p[28674], modelled.card.p[28930], modelled.troubles()) == (2, 2, [])
    assert all(text.startswith("1_") for text in bench.wires["/dev/a"].sent)
