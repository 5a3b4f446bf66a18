"""What a panel and the process of its bridge say to each other: a length, then MessagePack.

Only plain data cross the pipe: no message can make the other side run anything.
"""

import struct
from typing import Any

import msgspec

from openacr.bridge.moment import AxisName, Moment
from openacr.bridge.settings import BridgeFile

HEAD = struct.Struct("<I")
LONGEST = 1 << 26  # bytes of a message; a damaged length asks for no memory


class _Message(msgspec.Struct, frozen=True, tag=True):
    """A message; its name tells which one."""


# --- to the process of the bridge -----------------------------------------------------


class Begin(_Message, frozen=True):
    """Publish this machine as its file says; `log_level` and above come back as `Logged`."""

    file: BridgeFile
    folder: str  # of the file
    axes: tuple[AxisName, ...]
    log_level: int


class Reading(_Message, frozen=True):
    """The newest values; answered by `Taken`."""

    moment: Moment


class Written(_Message, frozen=True):
    """The end of a write; `refusal` is empty when it was carried out."""

    number: int
    refusal: str


class End(_Message, frozen=True):
    """End all systems properly. A pipe that ends without it was that of a killed panel."""


# --- from it --------------------------------------------------------------------------


class Opened(_Message, frozen=True):
    """All systems have begun; where hosts find each."""

    places: tuple[str, ...]


class Failed(_Message, frozen=True):
    """The systems cannot begin."""

    why: str


class Taken(_Message, frozen=True):
    """A reading has arrived."""


class Write(_Message, frozen=True):
    """Set a parameter or flag of the card; answered by `Written` with the same number."""

    number: int
    place: int  # of the parameter or flag
    value: float
    is_flag: bool


class Logged(_Message, frozen=True):
    """A line for the log."""

    level: int
    logger: str
    text: str


ToProcess = Begin | Reading | Written | End
FromProcess = Opened | Failed | Taken | Write | Logged
_to_process = msgspec.msgpack.Decoder(ToProcess)
_from_process = msgspec.msgpack.Decoder(FromProcess)


def framed(message: ToProcess | FromProcess) -> bytes:
    """The bytes of a message with its length."""
    data = msgspec.msgpack.encode(message)
    return HEAD.pack(len(data)) + data


def length_of(head: bytes) -> int:
    """How many bytes a message has; ValueError for more than any has."""
    (length,) = HEAD.unpack(head)
    if length > LONGEST:
        raise ValueError(f"a message of {length} bytes is too long")
    return int(length)


def to_process(data: bytes) -> ToProcess:
    """The message to the process in some bytes; ValueError where they hold no message."""
    found: Any = _to_process.decode(data)
    return found  # type: ignore[no-any-return]


def from_process(data: bytes) -> FromProcess:
    """The message from the process in some bytes; ValueError where they hold no message."""
    found: Any = _from_process.decode(data)
    return found  # type: ignore[no-any-return]
