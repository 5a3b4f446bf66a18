"""Cards with drives that talk."""

from openacr.controller import Controller
from openacr.map.rows import bus_drives
from openacr.plant.describe.load import parse_world

LOST, TIMEOUT, ADDRESS_ERROR = 18, 19, 20
COM2 = 11104
MOTOR = "motor = {inertia_kgm2 = 1.9e-5, torque_nm_per_a = 0.45}\n"
TORQUE = MOTOR + 'drive = {mode = "torque", amps_per_volt = 1.5, peak_amps = 12.0}\n'
VELOCITY = MOTOR + 'drive = {mode = "velocity", revs_per_s_per_volt = 10.0, peak_amps = 8.0}\n'


def axis(number: int, drive: str = TORQUE) -> str:
    """A motor in the words of machine.toml."""
    return f"[[axis]]\nnumber = {number}\nencoder_lines = 1000\n{drive}"


def talking(number: int, **keys: object) -> str:
    """The serial side of its drive."""
    given = {"axis": number, "type": "aries", **keys}
    lines = (f'{k} = "{v}"' if isinstance(v, str) else f"{k} = {v}" for k, v in given.items())
    return "\n".join(["[[drive]]", *lines, ""])


class Bench:
    """A card at P00 with named axes; its drives as said."""

    def __init__(self, *drives: str, axes: int = 8, motor: str = TORQUE) -> None:
        world = "".join(axis(n, motor) for n in range(axes)) + "".join(drives)
        self.card = Controller(world=parse_world(world))
        self.card.is_journalled = False
        self.type("ECHO 4", "PROG0", "ATTACH MASTER0")
        for number, name in enumerate("XYZABCUV"[:axes]):
            self.type(f'ATTACH SLAVE{number} AXIS{number} "{name}"', f"AXIS{number} DRIVE ON")
            self.type(f"ENC{number} MULT 4")
        self.card.advance(10)

    def type(self, *lines: str) -> str:
        """What lines print, `|` between them."""
        said = "".join(self.card.send(f"{line}\r") for line in lines)
        return said.removesuffix("\r\n").replace("\r\n", "|")

    def open(self, *axes: int, device: str = "COM2:9600,N,8,1", number: int = 1) -> None:
        """Open Drive Talk for axes."""
        assert self.type(f'OPEN DTALK "{device}" AS #{number}') == ""
        for n in axes:
            self.card.p[28672 + 256 * n], self.card.p[28673 + 256 * n] = number, 0

    def request(self, axis: int, index: int, timeout_s: float = 5.0) -> float:
        """Set a control flag and wait until it clears itself; how long that took [s]."""
        flag, begin = control(axis, index), self.card.tick
        self.card.bit[flag] = True
        assert self.card.until(flag, is_=False, timeout_s=timeout_s)
        return (self.card.tick - begin) * self.card.period_s

    def troubles(self, first: int = COM2) -> list[int]:
        """The error flags of the stream that are set: 18 lost, 19 timeout, 20 address."""
        return [index for index in (LOST, TIMEOUT, ADDRESS_ERROR) if self.card.bit[first + index]]

    def say(self, line: str, seconds: float = 0.2) -> str:
        """Type a line for a drive; everything that is seen."""
        seen = self.card.send(f"{line}\r")
        self.card.advance(seconds=seconds)
        seen += self.card.take_output(self.card.console).decode()
        return seen.removesuffix("\r\n").replace("\r\n", "|")

    def escape(self) -> str:
        """Press ESC."""
        return self.card.send("\x1b")

    def address(self, axis: int) -> int:
        """The address a drive has."""
        return self.card.memory.I[bus_drives.address[axis]]


def control(axis: int, index: int) -> int:
    """A control flag of an axis."""
    return 10496 + 32 * axis + index
