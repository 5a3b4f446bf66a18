"""Passes of a program: one, or repeated if the store enables Repeat Forever."""

from openacr.errors import UserError
from openacr.mill.card.machine_io import MachineIo
from openacr.mill.run.console import Console
from openacr.mill.run.lifecycle import Event, Lifecycle
from openacr.mill.run.program_stream import Entries, ProgramStream
from openacr.mill.run.times import Times


class Passes:
    """Counts and repeats the passes of a program."""

    def __init__(
        self,
        io: MachineIo,
        stream: ProgramStream,
        console: Console,
        lifecycle: Lifecycle,
        times: Times,
    ) -> None:
        self.count = 0  # ends of programs reached
        self._io = io
        self._stream = stream
        self._console = console
        self._lifecycle = lifecycle
        self._times = times
        self._entries: Entries | None = None

    def load(self, entries: Entries) -> None:
        """Load a program; `begin` starts its first pass."""
        self._entries = entries

    def finish(self) -> None:
        """End a pass (M2 or the last block): finish, or start the next."""
        options = self._lifecycle.options
        if not options.is_mdi:
            self.count += 1
            self._console.count_part(self.count)
        if self._io.settings.repeats and options.is_repeated:
            self.begin()
        else:
            self._lifecycle.fire(Event.END)

    def begin(self) -> None:
        """Start a pass at the first block."""
        if self._entries is None:
            raise UserError("no program is loaded")
        self._times.begin_pass()
        options = self._lifecycle.options
        self._stream.begin(self._entries, is_dry=options.is_dry, is_single=options.is_single)
