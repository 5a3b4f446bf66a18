"""The line that is being typed on a stream."""

from dataclasses import dataclass, field

from openacr.lang.lexer import LINE_LIMIT
from openacr.protocol.events import LineTooLong, ReceivedLine


@dataclass(slots=True)
class TypedLine:
    """The line being typed; of an overlong one only the length is kept."""

    kept: bytearray = field(default_factory=bytearray)
    excess: int = 0

    def add(self, data: bytes) -> None:
        """Append characters."""
        room = LINE_LIMIT - len(self.kept)  # 0 where there is excess
        self.kept += data[:room]
        self.excess += max(0, len(data) - room)

    def erase(self) -> bool:
        """Take the last character back; False when there is none."""
        if self.excess:
            self.excess -= 1
        elif self.kept:
            self.kept.pop()
        else:
            return False
        return True

    def finish(self) -> ReceivedLine | LineTooLong:
        """End the line, and begin an empty one."""
        event = LineTooLong() if self.excess else ReceivedLine(text_of(self.kept))
        self.clear()
        return event

    def clear(self) -> None:
        """Forget what was typed."""
        self.kept.clear()
        self.excess = 0


def text_of(line: bytes | bytearray) -> str:
    """Typed bytes as text: UTF-8 where they are; other bytes stay what they are (PEP 383)."""
    return line.decode("utf-8", "surrogateescape")


def bytes_of(text: str) -> bytes:
    """The typed bytes of a text."""
    return text.encode("utf-8", "surrogateescape")
