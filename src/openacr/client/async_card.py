"""One ACR card for asyncio programs: the same requests as `Card`, awaited."""

from asyncio import Lock
from collections.abc import AsyncGenerator, Awaitable, Callable, Iterable
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Self, TypeVar

from openacr.client import transfer, values
from openacr.client.async_links import AsyncLink, for_asyncio
from openacr.client.drive import carry_out_async
from openacr.client.effects import Op
from openacr.client.errors import ConnectionLostError
from openacr.client.links import DEFAULT_BAUD, Host, link_to
from openacr.client.moves import MoveStream
from openacr.client.names import What
from openacr.client.objects import Axis, Master
from openacr.client.options import Options
from openacr.client.requests import Follow, Level, Press
from openacr.client.talk import Talk
from openacr.client.transfer import Progress, Report
from openacr.client.values import Number, next_due_s
from openacr.protocol.events import ControlKey
from openacr.protocol.move import Move
from openacr.protocol.packets import Packet

T = TypeVar("T")


class AsyncCard:
    """A card at the other end of a link. Tasks may share it; each call is one exchange."""

    def __init__(self, link: AsyncLink, options: Options | None = None) -> None:
        self._link = link
        self._talk = Talk(link.name, link.kind, options or Options(), link.now_s)
        self._lock = Lock()

    @classmethod
    async def open(
        cls, target: str | Host, options: Options | None = None, *, baud: int = DEFAULT_BAUD
    ) -> Self:
        """Connect to `HOST[:PORT]`, a serial port, or a card in this process."""
        card = cls(for_asyncio(link_to(target, baud)), options)
        await card.connect()
        return card

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        await self.close()

    async def _do(self, op: Op[T]) -> T:
        async with self._lock:
            return await carry_out_async(op, self._link)

    @property
    def name(self) -> str:
        """The address of the card."""
        return self._talk.name

    @property
    def level(self) -> Level:
        """The level at which lines are typed."""
        return self._talk.level

    def now_s(self) -> float:
        """The clock that time-outs use [s]."""
        return self._link.now_s()

    async def pause(self, seconds: float) -> None:
        """Let time pass: real time, or card time for a card in this process."""
        if seconds > 0:
            await self._link.pause(seconds)

    async def connect(self) -> None:
        """Connect now; otherwise the first request connects."""
        await self._do(self._talk.query(""))

    async def close(self) -> None:
        """Disconnect; motion and programs continue."""
        await self._do(self._talk.close())

    # --- lines ------------------------------------------------------------------------

    async def go(self, level: Level) -> None:
        """Change to a level: `Level()` is SYS, `Level.program(3)`, `Level.plc(0)`."""
        await self._do(self._talk.go(level))

    async def command(
        self, line: str, *, program: int | None = None, timeout_s: float | None = None
    ) -> list[str]:
        """Type a line, at a program if given, and return the output; RefusedError."""
        at = None if program is None else Level.program(program)
        return list(await self._do(self._talk.command(line, at=at, wait_s=timeout_s)))

    async def ask(self, expression: str, *, program: int | None = None) -> Number:
        """The value of an expression, computed by the card."""
        at = None if program is None else Level.program(program)
        return await self._do(values.ask(self._talk, expression, at=at))

    # --- parameters, flags, variables -------------------------------------------------

    async def read(self, what: What) -> Number:
        """Read one parameter."""
        return await self._do(values.read(self._talk, what))

    async def read_many(self, whats: Iterable[What]) -> list[Number]:
        """Read several parameters in order, up to eight of a kind at once."""
        return await self._do(values.read_many(self._talk, whats))

    async def write(self, what: What, value: Number) -> None:
        """Set a parameter."""
        await self._do(values.write(self._talk, what, value))

    async def read_bit(self, what: What) -> bool:
        """Whether a flag is set."""
        return await self._do(values.read_bit(self._talk, what))

    async def read_bits(self, whats: Iterable[What]) -> list[bool]:
        """Read several flags in order."""
        return await self._do(values.read_bits(self._talk, whats))

    async def write_bit(self, what: What, on: bool) -> None:
        """Set or clear a flag."""
        await self._do(values.write_bit(self._talk, what, on))

    def axis(self, number: int) -> Axis[Awaitable[Number], Awaitable[bool], Awaitable[None]]:
        """One axis: `await card.axis(0).following_error`."""
        return Axis(number, self.read, self.read_bit, self.write, self.write_bit)

    def master(self, number: int) -> Master[Awaitable[Number], Awaitable[bool], Awaitable[None]]:
        """One master: `await card.master(0).is_in_motion`."""
        return Master(number, self.read, self.read_bit, self.write, self.write_bit)

    async def array_length(self, program: int, array: str) -> int:
        """Count of elements of an array of a program; 0 if it is not dimensioned."""
        return await self._do(values.array_length(self._talk, program, array))

    async def read_array(self, program: int, array: str, part: range | None = None) -> list[Number]:
        """Read an array of a program."""
        return await self._do(values.read_array(self._talk, program, array, part))

    async def write_array(
        self, program: int, array: str, numbers: Iterable[Number], first: int = 0
    ) -> None:
        """Set elements of an array of a program."""
        await self._do(values.write_array(self._talk, program, array, numbers, first))

    async def wait(
        self,
        is_reached: Callable[[], Awaitable[bool]],
        *,
        timeout_s: float = 60.0,
        every_s: float = 0.02,
    ) -> bool:
        """Poll until a condition holds; False if it does not in time."""
        end_s = self.now_s() + timeout_s
        while not await is_reached():
            if self.now_s() >= end_s:
                return False
            await self.pause(every_s)
        return True

    async def watch(
        self, whats: Iterable[What], every_s: float = 0.1
    ) -> AsyncGenerator[list[Number], None]:
        """Sample parameters at a steady rate, resuming after a lost connection."""
        chosen, due_s = list(whats), self.now_s()
        while True:
            yield await self.read_many(chosen)
            due_s = next_due_s(due_s, every_s, self.now_s())
            await self.pause(due_s - self.now_s())

    # --- programs ---------------------------------------------------------------------

    async def run(self, program: int) -> None:
        """Start a program."""
        await self._do(self._talk.order(f"RUN PROG{program}"))

    async def halt(self, program: int | None = None) -> None:
        """End a program, or all of them; their coordinated motion stops."""
        await self._do(self._talk.order("HALT ALL" if program is None else f"HALT PROG{program}"))

    async def listen(self, program: int, *, run: bool = False) -> AsyncGenerator[str, None]:
        """Yield what a program prints, as it arrives; after `run`, ends with the program."""
        await self._do(self._talk.go(Level.program(program)))
        await self._do(self._talk.exchange(Follow("LRUN" if run else "LISTEN")))
        try:
            while (text := await self._do(self._talk.hear(0.25))) is not None:
                yield text
        finally:
            with suppress(ConnectionLostError):
                await self._do(self._talk.leave())

    async def download(
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
        return await self._do(op)

    async def upload(self, level: Level) -> str:
        """Read the text of a program or PLC, as a file that can be downloaded again."""
        return await self._do(transfer.upload(self._talk, level))

    async def backup(self, folder: str | Path, progress: Progress | None = None) -> list[str]:
        """Store everything a terminal can read in a folder; returns the file names."""
        from openacr.client.backup import backup, write_folder

        files = await self._do(backup(self._talk, progress))
        write_folder(files, Path(folder))
        return list(files)

    async def restore(self, folder: str | Path, progress: Progress | None = None) -> list[Report]:
        """Stop everything, clear the card and restore a backup.

        DownloadError: the card does not know one of its settings; nothing was changed.
        RestoreError: it failed later; the card has its former contents, or the error holds them.
        """
        from openacr.client.backup import read_folder
        from openacr.client.restore import restore

        return await self._do(restore(self._talk, read_folder(Path(folder)), progress))

    # --- keys -------------------------------------------------------------------------

    async def kill_all(self, *, disable: bool = False) -> None:
        """Stop all motion and end all programs (Ctrl-X); drives off as well (Ctrl-Z)."""
        key = ControlKey.CTRL_Z if disable else ControlKey.CTRL_X
        await self._do(self._talk.send(Press(key)))

    async def clear_kills(self) -> None:
        """Let the axes move again (Ctrl-Y)."""
        await self._do(self._talk.send(Press(ControlKey.CTRL_Y)))

    # --- packets ----------------------------------------------------------------------

    async def tell(self, *packets: Packet) -> None:
        """Send packets the card does not answer: flags, overrides, moves."""
        await self._do(self._talk.tell(packets))

    async def send_moves(self, moves: Iterable[Move], stream: MoveStream | None = None) -> int:
        """Send binary moves as fast as the card's buffer accepts them; returns their count.

        A `MoveStream` continues where its last moves ended and knows which have started.
        """
        return await self._do((stream or MoveStream()).send(self._talk, moves))

    async def moves_started(self, stream: MoveStream) -> int:
        """How many moves of a stream have started."""
        return await self._do(stream.update(self._talk))
