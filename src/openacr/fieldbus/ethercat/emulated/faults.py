"""Faults of an emulated segment on request: of the cable, of frames, of slaves.

`Line` is between a master and the segment: what it sends of a frame may be nothing, late, twice or
wrong. What is drawn comes from a seed, so that a run can be repeated.
"""

import random
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, replace

from openacr.errors import UserError
from openacr.fieldbus.ethercat.emulated.controller import Controller
from openacr.fieldbus.ethercat.emulated.drive import Drive
from openacr.fieldbus.ethercat.emulated.segment import Segment
from openacr.fieldbus.ethercat.emulated.slave import Slave
from openacr.fieldbus.ethercat.wire import sii
from openacr.fieldbus.ethercat.wire.frames import COUNTER_SIZE, FIRST, HEADER_SIZE, LENGTH_MASK
from openacr.fieldbus.ethercat.wire.registers import Register, State
from openacr.wording import counted

US = 1000
MOST_EACH = 1_000_000_000
_STRANGE = 0x8000_0000  # of the product code of a wrong device


@dataclass(frozen=True, slots=True)
class Sent:
    """A frame that goes back to the master after a delay."""

    delay_ns: int
    frame: bytes


class Line:
    """The cable to a segment with its faults, and counts of what happened."""

    def __init__(self, segment: Segment, seed: int = 0) -> None:
        self.segment = segment
        self.counts: Counter[str] = Counter()
        self.lose_each = self.double_each = self.damage_each = self.miscount_each = 0
        self.burst = 0
        self.late_ns = 0
        self._random = random.Random(seed)
        self._right: dict[int, bytes] = {}

    def send(self, frame: bytes, now: int) -> list[Sent]:
        """What comes back of a frame, if anything."""
        self.counts["frames"] += 1
        is_lost = self._is_drawn(self.lose_each)
        if self.burst:
            self.burst -= 1
            is_lost = True
        # Half of the lost frames are lost on their path back: the slaves have served them.
        if is_lost and self._random.random() < 0.5:
            self.counts["lost"] += 1
            self.segment.advance(now)
            return []
        back = self.segment.process(frame, now)
        if not back:
            self.counts["unanswered"] += 1
            return []
        if is_lost:
            self.counts["lost"] += 1
            return []
        if self._is_drawn(self.miscount_each):
            self.counts["wrong working counters"] += 1
            back = _miscounted(back)
        if self._is_drawn(self.damage_each):
            self.counts["damaged"] += 1
            back = self._damaged(back)
        if self.late_ns:
            self.counts["late"] += 1
        sent = [Sent(self.late_ns, back)]
        if self._is_drawn(self.double_each):
            self.counts["duplicated"] += 1
            sent.append(sent[0])
        return sent

    def _is_drawn(self, each: int) -> bool:
        return each > 0 and self._random.randrange(each) == 0

    def _damaged(self, frame: bytes) -> bytes:
        """One byte of the datagrams changed, as by noise that a checksum missed."""
        control = self.segment.slaves[0].controller
        errors = control.memory[Register.RX_ERRORS]
        control.memory[Register.RX_ERRORS] = min(255, errors + 1)
        changed = bytearray(frame)
        changed[self._random.randrange(FIRST, len(frame))] ^= 1 << self._random.randrange(8)
        return bytes(changed)

    # -- commands ----------------------------------------------------------------------------

    def command(self, text: str) -> str:
        """Do a command of `FAULTS`; what was done. UserError if it is not one."""
        fault, numbers = self.check(text)
        return fault.act(self, *numbers)

    def check(self, text: str) -> tuple["Fault", list[int]]:
        """A command and its numbers; UserError if it is not one."""
        name, *given = text.split() or [""]
        fault = FAULTS.get(name)
        if fault is None:
            raise UserError(f"{name or 'nothing'}: the faults are {', '.join(FAULTS)}")
        least, most = len([n for n in fault.arguments if n.isupper()]), len(fault.arguments)
        if not least <= len(given) <= most:
            raise UserError(f"{text}: write {fault.usage(name)}")
        numbers = [_number(each, text) for each in given]
        last = len(self.segment.slaves) - 1
        if fault.arguments[:1] == ("SLAVE",) and not 0 <= numbers[0] <= last:
            raise UserError(f"{text}: slaves are numbered from 0 to {last}")
        return fault, numbers

    def drive(self, number: int) -> Drive:
        """A slave that is a drive; UserError if it is another device."""
        slave = self.segment.slaves[number]
        if not isinstance(slave, Drive):
            raise UserError(f"slave {number} is {slave.name}, which is not a drive")
        return slave

    def replace_device(self, number: int, wrong: bool) -> None:
        """Put another device, or the right one, in the place of a slave; it starts anew."""
        slave = self.segment.slaves[number]
        control: Controller = slave.controller
        if wrong and number not in self._right:
            self._right[number] = bytes(control.eeprom.data)
            control.eeprom.data[:] = sii.build(_stranger(slave))
        elif not wrong and number in self._right:
            control.eeprom.data[:] = self._right.pop(number)
        self.segment.power(number, False)
        self.segment.power(number, True)

    def states(self) -> str:
        """A line for each slave."""
        return "\n".join(
            f"{number} {slave.name}: {_state(slave)}"
            for number, slave in enumerate(self.segment.slaves)
        )

    def summary(self) -> str:
        """The counts, in words."""
        frames = counted(self.counts["frames"], "frame")
        others = [f"{count} {what}" for what, count in self.counts.items() if what != "frames"]
        return ", ".join([frames, *others])


def _state(slave: Slave) -> str:
    if not slave.is_powered:
        return "no power"
    machine = slave.machine
    text = State(machine.state).name + (
        f" + ERROR, {machine.code.text}" if machine.is_error else ""
    )
    return f"{text}, {slave.shown()}" if slave.shown() else text


def _stranger(slave: Slave) -> sii.Description:
    who = slave.description.identity
    identity = replace(who, product=who.product ^ _STRANGE)
    return replace(slave.description, identity=identity, name="another device")


def _miscounted(frame: bytes) -> bytes:
    """The working counter of the first datagram is one less."""
    changed = bytearray(frame)
    size = int.from_bytes(frame[FIRST + 6 : FIRST + 8], "little") & LENGTH_MASK
    place = FIRST + HEADER_SIZE + size
    counter = int.from_bytes(frame[place : place + COUNTER_SIZE], "little")
    changed[place : place + COUNTER_SIZE] = (max(0, counter - 1)).to_bytes(2, "little")
    return bytes(changed)


def _number(text: str, whole: str) -> int:
    try:
        number = int(text, 0)
    except ValueError:
        raise UserError(f"{whole}: {text} is not a whole number") from None
    if abs(number) > MOST_EACH:
        raise UserError(f"{whole}: numbers are from {-MOST_EACH} to {MOST_EACH}")
    return number


@dataclass(frozen=True, slots=True)
class Fault:
    """A command: its arguments (small letters: may be left out), what it does, in words."""

    arguments: tuple[str, ...]
    act: Callable[..., str]
    text: str

    def usage(self, name: str) -> str:
        """How it is written."""
        parts = [each if each.isupper() else f"[{each.upper()}]" for each in self.arguments]
        return " ".join([name, *parts])


def _cable_out(line: Line, number: int) -> str:
    line.segment.connect(number)
    return f"the cable in front of slave {number} is out"


def _cable_in(line: Line) -> str:
    line.segment.connect(None)
    return "the cable is in"


def _power_off(line: Line, number: int) -> str:
    line.segment.power(number, False)
    return f"slave {number} has no power"


def _power_on(line: Line, number: int) -> str:
    line.segment.power(number, True)
    return f"slave {number} has power"


def _setting(name: str, text: str) -> Callable[[Line, int], str]:
    def act(line: Line, value: int) -> str:
        if value < 0:
            raise UserError(f"{value}: 0 or more")
        setattr(line, name, value)
        return text.format(value) if value else "no longer"

    return act


def _late(line: Line, microseconds: int) -> str:
    if not 0 <= microseconds <= 1_000_000:
        raise UserError(f"{microseconds} us: a frame is 0 to 1000000 us late")
    line.late_ns = microseconds * US
    return f"frames come {microseconds} us late"


def _wrong(line: Line, number: int) -> str:
    line.replace_device(number, True)
    return f"slave {number} is another device"


def _right(line: Line, number: int) -> str:
    line.replace_device(number, False)
    return f"slave {number} is the right device"


def _drive_fault(line: Line, number: int, code: int = 0xFF01) -> str:
    if not 1 <= code <= 0xFFFF:
        raise UserError(f"{code}: error codes are from 1 to 0xFFFF")
    line.drive(number).fault(code, held=True)
    return f"drive {number} has error 0x{code:04X} until drive-mend {number}"


def _drive_mend(line: Line, number: int) -> str:
    line.drive(number).mend()
    return f"the error of drive {number} can be reset"


def _jump(line: Line, number: int, counts: int) -> str:
    line.drive(number).jump(counts)
    return f"the encoder of drive {number} jumped by {counts} counts"


def _probe(line: Line, number: int, on: int) -> str:
    line.drive(number).probe.touch(bool(on))
    return f"the probe input of drive {number} is {'on' if on else 'off'}"


def _show(line: Line) -> str:
    return line.states()


FAULTS: dict[str, Fault] = {
    "cable-out": Fault(("SLAVE",), _cable_out, "pull the cable in front of a slave out"),
    "cable-in": Fault((), _cable_in, "put the cable in again"),
    "power-off": Fault(("SLAVE",), _power_off, "switch a slave off"),
    "power-on": Fault(("SLAVE",), _power_on, "switch a slave on"),
    "lose": Fault(("N",), _setting("lose_each", "one frame in {} is lost"), "lose one frame in N"),
    "burst": Fault(("N",), _setting("burst", "the next {} frames are lost"), "lose N frames"),
    "late": Fault(("US",), _late, "send frames back late by microseconds"),
    "duplicate": Fault(
        ("N",), _setting("double_each", "one frame in {} comes twice"), "send one frame in N twice"
    ),
    "damage": Fault(
        ("N",), _setting("damage_each", "one frame in {} is damaged"), "damage one frame in N"
    ),
    "miscount": Fault(
        ("N",),
        _setting("miscount_each", "one frame in {} has a wrong working counter"),
        "one working counter in N is one too small",
    ),
    "wrong": Fault(("SLAVE",), _wrong, "put another device in the place of a slave"),
    "right": Fault(("SLAVE",), _right, "put the right device back"),
    "drive-fault": Fault(("SLAVE", "code"), _drive_fault, "a fault of a drive, by its error code"),
    "drive-mend": Fault(("SLAVE",), _drive_mend, "take the cause of that fault away"),
    "encoder-jump": Fault(("SLAVE", "COUNTS"), _jump, "let an encoder jump"),
    "probe": Fault(("SLAVE", "LEVEL"), _probe, "set the probe input of a drive to 0 or 1"),
    "state": Fault((), _show, "show all slaves"),
}


def helped() -> str:
    """All faults, a line each."""
    lines = [(fault.usage(name), fault.text) for name, fault in FAULTS.items()]
    width = max(len(usage) for usage, _ in lines)
    return "\n".join(f"{usage:<{width}}  {text}" for usage, text in lines)
