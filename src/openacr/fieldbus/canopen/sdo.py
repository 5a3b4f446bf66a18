"""Objects of a node (SDO), without waiting: frames go in, frames come out.

A *script* is a generator that yields accesses and is sent what the node has answered:

    kind = yield Read(0x1000)
    yield Write(0x1017, 0, bytes(2))

A refusal of the node is thrown into it as `RefusedError`; silence ends it.
"""

from collections.abc import Callable, Generator
from dataclasses import dataclass
from typing import Generic, TypeVar

from openacr.errors import UserError
from openacr.fieldbus.canopen.frames import Cob, Frame
from openacr.fieldbus.ethercat.wire import coe
from openacr.fieldbus.ethercat.wire.frames import WireError

ANSWER_S = 0.5  # a node may take to answer
SEGMENT = 7
LONGEST = 4096
STRAYS = 3  # answers to nothing, in one conversation: a repeated frame is no second node


class NodeError(UserError):
    """A node does not answer, refuses, or is another one than it has to be."""


class RefusedError(NodeError):
    """The node has aborted an access, with a code."""

    def __init__(self, text: str, code: int) -> None:
        super().__init__(text)
        self.code = code


@dataclass(frozen=True, slots=True)
class Read:
    """Reads an object."""

    index: int
    subindex: int = 0


@dataclass(frozen=True, slots=True)
class Write:
    """Writes an object."""

    index: int
    subindex: int
    data: bytes


T = TypeVar("T")
Access = Read | Write
Script = Generator[Access, bytes, T]


class Talk(Generic[T]):
    """A conversation with one node."""

    def __init__(
        self, node: int, script: Script[T], send: Callable[[Frame], object], now_s: float
    ) -> None:
        self.result: T | None = None
        self.failure: NodeError | None = None
        self.is_over = False
        self._size: int | None = None  # of a transfer that has begun
        self._data, self._toggle = b"", False
        self._node, self._script, self._put = node, script, send
        self._strays = 0
        self._asked_s = now_s
        self._proceed(lambda: next(script))

    def hear(self, data: bytes, now_s: float) -> None:
        """An answer of the node has arrived."""
        if self.is_over:
            return
        try:
            reply = coe.parse_reply(data)
        except WireError:
            reply = None
        if reply is None or not self._fits(reply):
            self._strays += 1
            if self._strays > STRAYS:
                self._end(NodeError(f"more than one node answers for id {self._node}"))
            return
        self._asked_s = now_s
        if isinstance(reply, coe.Aborted):
            refusal = RefusedError(f"object {self._label}: {reply.text}", reply.code)
            self._proceed(lambda: self._script.throw(refusal))
        elif isinstance(self._access, Read):
            self._read(reply)
        else:
            self._written()

    def look(self, now_s: float) -> None:
        """Give up a node that has not answered in time."""
        if not self.is_over and now_s - self._asked_s > ANSWER_S:
            self._end(NodeError(f"object {self._label}: no answer in {ANSWER_S:g} s"))

    @property
    def _label(self) -> str:
        return f"0x{self._access.index:04X}:{self._access.subindex}"

    def _fits(self, reply: coe.Reply) -> bool:
        """Whether this is the answer to what was asked last."""
        place = (self._access.index, self._access.subindex)
        if isinstance(reply, coe.Aborted):
            return (reply.index, reply.subindex) == place
        if isinstance(self._access, Read):
            if isinstance(reply, coe.Segment):
                return self._size is not None and reply.toggle is self._toggle
            return isinstance(reply, coe.Uploaded) and self._size is None and (
                reply.index, reply.subindex
            ) == place  # fmt: skip
        if isinstance(reply, coe.DownloadedNext):
            return self._size is not None and reply.toggle is self._toggle
        return isinstance(reply, coe.Downloaded) and self._size is None and (
            reply.index, reply.subindex
        ) == place  # fmt: skip

    def _read(self, reply: coe.Reply) -> None:
        if isinstance(reply, coe.Uploaded):
            self._size = reply.size
            if reply.data:  # all of it, in one frame
                self._proceed(lambda: self._script.send(reply.data))
                return
        elif isinstance(reply, coe.Segment):
            self._data += reply.data
            self._toggle = not self._toggle
            if reply.is_last:
                self._proceed(lambda: self._script.send(self._data))
                return
        if len(self._data) > LONGEST:
            self._end(NodeError(f"object {self._label}: longer than {LONGEST} bytes"))
        else:
            self._send(coe.UploadNext(self._toggle))

    def _written(self) -> None:
        if self._size is None:
            self._size = len(self._data)
        else:
            self._toggle = not self._toggle
        if not self._data:
            self._proceed(lambda: self._script.send(b""))
            return
        part, self._data = self._data[:SEGMENT], self._data[SEGMENT:]
        self._send(coe.DownloadNext(self._toggle, part, not self._data))

    def _proceed(self, step: Callable[[], Access]) -> None:
        """Let the script run to its next access."""
        try:
            self._access = access = step()
        except StopIteration as end:
            self.result, self.is_over = end.value, True
            return
        except NodeError as failure:
            self._end(failure)
            return
        self._size, self._data, self._toggle = None, b"", False
        if isinstance(access, Read):
            self._send(coe.Upload(access.index, access.subindex))
            return
        size = len(access.data)
        first = access.data if size <= coe.EXPEDITED else b""
        self._data = b"" if first else access.data
        self._send(coe.Download(access.index, access.subindex, first, size))

    def _send(self, request: coe.Request) -> None:
        self._put(Frame(Cob.SDO + self._node, request.pack()[coe.COE_SIZE :]))

    def _end(self, failure: NodeError) -> None:
        self.failure, self.is_over = failure, True
        self._script.close()


def read(index: int, subindex: int = 0) -> Script[bytes]:
    """Read one object."""
    return (yield Read(index, subindex))


def write(index: int, subindex: int, data: bytes) -> Script[None]:
    """Write one object."""
    yield Write(index, subindex, data)


def number(index: int, subindex: int = 0) -> Script[int]:
    """Read an object that is a whole number without a sign."""
    return int.from_bytes((yield Read(index, subindex)), "little")
