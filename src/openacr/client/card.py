"""One ACR card for ordinary, blocking programs."""

from collections.abc import Callable, Generator, Iterable
from contextlib import suppress
from pathlib import Path
from threading import RLock
from typing import Generic, Self, TypeVar

from openacr.client import stored, transfer, values
from openacr.client.drive import carry_out
from openacr.client.effects import Op
from openacr.client.errors import ConnectionLostError
from openacr.client.links import DEFAULT_BAUD, Host, Link, link_to
from openacr.client.moves import MoveStream
from openacr.client.names import What
from openacr.client.objects import Axis, Master
from openacr.client.options import Options
from openacr.client.requests import Follow, Level, Press
from openacr.client.stored import ListedLine, Room
from openacr.client.talk import Talk
from openacr.client.transfer import Progress, Report
from openacr.client.values import Number, next_due_s
from openacr.closing import Closing
from openacr.protocol.events import ControlKey
from openacr.protocol.move import Move
from openacr.protocol.packets import Packet

T = TypeVar("T")


class Cells(Generic[T]):
    """Parameters or flags by number or name: `card.p[12288]`, `card.bit["master0.in motion"]`."""

    def __init__(self, read: Callable[[What], T], write: Callable[[What, T], None]) -> None:
        self._read, self._write = read, write

    def __getitem__(self, what: What) -> T:
        return self._read(what)

    def __setitem__(self, what: What, value: T) -> None:
        self._write(what, value)


class Card(Closing):
    """A card at the other end of a link. Threads may share it; each call is one exchange."""

    def __init__(self, link: Link, options: Options | None = None) -> None:
        self._link = link
        self._talk = Talk(link.name, link.kind, options or Options(), link.now_s)
        self._lock = RLock()
        self.p = Cells[Number](self.read, self.write)
        self.bit = Cells[bool](self.read_bit, self.write_bit)

    @classmethod
    def open(
        cls, target: str | Host, options: Options | None = None, *, baud: int = DEFAULT_BAUD
    ) -> Self:
        """Connect to `HOST[:PORT]`, a serial port, or a card in this process."""
        link = link_to(target, baud)
        card = cls(link, options)
        try:
            card.connect()
        except BaseException:
            link.close()  # a card that answers nothing keeps no socket open
            raise
        return card

    def _do(self, op: Op[T]) -> T:
        with self._lock:
            return carry_out(op, self._link)

    def perform(self, talks: Callable[[Talk], Op[T]]) -> T:
        """Carry out an operation made of several exchanges, without another in between."""
        return self._do(talks(self._talk))

    @property
    def name(self) -> str:
        """The address of the card."""
        return self._talk.name

    @property
    def level(self) -> Level:
        """The level at which lines are typed."""
        return self._talk.level

    @property
    def connections(self) -> int:
        """Connections made so far; packets sent just before a new one may have been lost."""
        return self._talk.connections

    def now_s(self) -> float:
        """The clock that time-outs use [s]."""
        return self._link.now_s()

    def pause(self, seconds: float) -> None:
        """Let time pass: real time, or card time for a card in this process."""
        if seconds > 0:
            self._link.pause(seconds)

    def connect(self) -> None:
        """Connect now; otherwise the first request connects."""
        self._do(self._talk.query(""))

    def close(self) -> None:
        """Disconnect; motion and programs continue."""
        self._do(self._talk.close())

    # --- lines ------------------------------------------------------------------------

    def go(self, level: Level) -> None:
        """Change to a level: `Level()` is SYS, `Level.program(3)`, `Level.plc(0)`."""
        self._do(self._talk.go(level))

    def command(
        self, line: str, *, program: int | None = None, timeout_s: float | None = None
    ) -> list[str]:
        """Type a line, at a program if given, and return the output; RefusedError."""
        at = None if program is None else Level.program(program)
        return list(self._do(self._talk.command(line, at=at, wait_s=timeout_s)))

    def ask(self, expression: str, *, program: int | None = None) -> Number:
        """The value of an expression, computed by the card: `card.ask("P0+2*P1")`."""
        at = None if program is None else Level.program(program)
        return self._do(values.ask(self._talk, expression, at=at))

    # --- parameters, flags, variables -------------------------------------------------

    def read(self, what: What) -> Number:
        """Read one parameter."""
        return self._do(values.read(self._talk, what))

    def read_many(self, whats: Iterable[What]) -> list[Number]:
        """Read several parameters in order, up to eight of a kind at once."""
        return self._do(values.read_many(self._talk, whats))

    def write(self, what: What, value: Number) -> None:
        """Set a parameter."""
        self._do(values.write(self._talk, what, value))

    def read_bit(self, what: What) -> bool:
        """Whether a flag is set."""
        return self._do(values.read_bit(self._talk, what))

    def read_bits(self, whats: Iterable[What]) -> list[bool]:
        """Read several flags in order."""
        return self._do(values.read_bits(self._talk, whats))

    def write_bit(self, what: What, on: bool) -> None:
        """Set or clear a flag."""
        self._do(values.write_bit(self._talk, what, on))

    def axis(self, number: int) -> Axis[Number, bool, None]:
        """One axis: `card.axis(0).following_error`."""
        return Axis(number, self.read, self.read_bit, self.write, self.write_bit)

    def master(self, number: int) -> Master[Number, bool, None]:
        """One master: `card.master(0).is_in_motion`."""
        return Master(number, self.read, self.read_bit, self.write, self.write_bit)

    def array_length(self, program: int, array: str) -> int:
        """Count of elements of an array of a program; 0 if it is not dimensioned."""
        return self._do(values.array_length(self._talk, program, array))

    def read_array(self, program: int, array: str, part: range | None = None) -> list[Number]:
        """Read an array of a program: `card.read_array(0, "LA0")`."""
        return self._do(values.read_array(self._talk, program, array, part))

    def write_array(
        self, program: int, array: str, numbers: Iterable[Number], first: int = 0
    ) -> None:
        """Set elements of an array of a program."""
        self._do(values.write_array(self._talk, program, array, numbers, first))

    def wait(
        self, is_reached: Callable[[], bool], *, timeout_s: float = 60.0, every_s: float = 0.02
    ) -> bool:
        """Poll until a condition holds; False if it does not in time."""
        end_s = self.now_s() + timeout_s
        while not is_reached():
            if self.now_s() >= end_s:
                return False
            self.pause(every_s)
        return True

    def watch(
        self, whats: Iterable[What], every_s: float = 0.1
    ) -> Generator[list[Number], None, None]:
        """Sample parameters at a steady rate, resuming after a lost connection."""
        chosen, due_s = list(whats), self.now_s()
        while True:
            yield self.read_many(chosen)
            due_s = next_due_s(due_s, every_s, self.now_s())
            self.pause(due_s - self.now_s())

    # --- programs ---------------------------------------------------------------------

    def run(self, program: int) -> None:
        """Start a program."""
        self._do(self._talk.order(f"RUN PROG{program}"))

    def halt(self, program: int | None = None) -> None:
        """End a program, or all of them; their coordinated motion stops."""
        self._do(self._talk.order("HALT ALL" if program is None else f"HALT PROG{program}"))

    def listen(self, program: int, *, run: bool = False) -> Generator[str, None, None]:
        """Yield what a program prints, as it arrives; after `run`, ends with the program.

        Leave the loop to stop listening; the program keeps running. An empty text is yielded
        after every quarter of a second in which nothing was printed.
        """
        self._do(self._talk.go(Level.program(program)))
        self._do(self._talk.exchange(Follow("LRUN" if run else "LISTEN")))
        try:
            while (text := self._do(self._talk.hear(0.25))) is not None:
                yield text
        finally:
            with suppress(ConnectionLostError):
                self._do(self._talk.leave())

    def download(
        self,
        text: str,
        *,
        path: str = "",
        to: Level | None = None,
        progress: Progress | None = None,
        is_verified: bool = True,
    ) -> Report:
        """Send a controller file; DownloadError, VerificationError."""
        op = transfer.download(
            self._talk, text, path=path, to=to, progress=progress, is_verified=is_verified
        )
        return self._do(op)

    def upload(self, level: Level) -> str:
        """Read the text of a program or PLC, as a file that can be downloaded again."""
        return self._do(transfer.upload(self._talk, level))

    def listing(self, level: Level) -> list[ListedLine]:
        """The lines of a program or PLC as LIST shows them, each with its number."""
        return self._do(stored.listing(self._talk, level))

    def rooms(self) -> dict[Level, Room]:
        """The memory of every program and PLC that has some."""
        return self._do(stored.rooms(self._talk))

    def read_all(self, progress: Progress | None = None) -> dict[str, str]:
        """The files of a backup by name, without storing them."""
        from openacr.client.backup import backup

        return self._do(backup(self._talk, progress))

    def backup(self, folder: str | Path, progress: Progress | None = None) -> list[str]:
        """Store everything a terminal can read in a folder; returns the file names."""
        from openacr.client.backup import write_folder

        files = self.read_all(progress)
        write_folder(files, Path(folder))
        return list(files)

    def restore(self, folder: str | Path, progress: Progress | None = None) -> list[Report]:
        """Stop everything, clear the card and restore a backup.

        DownloadError: the card does not know one of its settings; nothing was changed.
        RestoreError: it failed later; the card has its former contents, or the error holds them.
        """
        from openacr.client.backup import read_folder
        from openacr.client.restore import restore

        return self._do(restore(self._talk, read_folder(Path(folder)), progress))

    # --- keys -------------------------------------------------------------------------

    def kill_all(self, *, disable: bool = False) -> None:
        """Stop all motion and end all programs (Ctrl-X); drives off as well (Ctrl-Z)."""
        key = ControlKey.CTRL_Z if disable else ControlKey.CTRL_X
        self._do(self._talk.send(Press(key)))

    def clear_kills(self) -> None:
        """Let the axes move again (Ctrl-Y)."""
        self._do(self._talk.send(Press(ControlKey.CTRL_Y)))

    # --- packets ----------------------------------------------------------------------

    def tell(self, *packets: Packet) -> None:
        """Send packets the card does not answer: flags, overrides, moves."""
        self._do(self._talk.tell(packets))

    def send_moves(self, moves: Iterable[Move], stream: MoveStream | None = None) -> int:
        """Send binary moves as fast as the card's buffer accepts them; returns their count.

        A `MoveStream` continues where its last moves ended and knows which have started.
        """
        return self._do((stream or MoveStream()).send(self._talk, moves))

    def moves_started(self, stream: MoveStream) -> int:
        """How many moves of a stream have started."""
        return self._do(stream.update(self._talk))
