"""Drip feed: runs a program while it arrives over a serial line.

The sender is held back while enough of the program waits to be read, and released when it
runs low. When the sender stalls, the machine comes to rest on its path and continues with the
next lines; M2, Ctrl-Z or a failure of the line ends the program.
"""

from collections.abc import Callable, Iterator
from typing import TypeAlias

from msgspec.structs import replace

from openacr.cnc import canonical as c
from openacr.cnc.interpreter.interpreter import Interpreter
from openacr.cnc.interpreter.interpreter import Options as Reading
from openacr.cnc.interpreter.mdi import Mdi
from openacr.cnc.loading.arriving import ArrivingText, NotYetError
from openacr.cnc.loading.load import Folders, load_blank
from openacr.cnc.program.flow import Level
from openacr.cnc.program.program import Program
from openacr.cnc.reading.findings import BlockError, found
from openacr.cnc.state.hosts import Cells
from openacr.errors import UserError
from openacr.mill.config.communications import Line
from openacr.mill.run.feeding import Starved
from openacr.mill.run.handshake import SerialInput
from openacr.mill.run.run_host import RunHost

FULL, LOW = 16_384, 4_096  # unread bytes at which the sender is held back, and released
NAME = "DRIP"

Entries: TypeAlias = Iterator[c.Entry | Starved]


class Drip:
    """A program that arrives over a serial port."""

    def __init__(
        self,
        line: Line,
        store: Cells,
        dialect: str = "acromill",
        *,
        is_dry: bool = False,
        folders: Folders | None = None,
    ) -> None:
        self._input = SerialInput(line)
        self._store, self._dialect, self._is_dry = store, dialect, is_dry
        self.program: Program = load_blank(store, dialect, folders, name=NAME)
        self.text = ArrivingText(NAME, self.program.main.labels)
        self.program.main.text = self.text
        self.text.of_part(self.program.main)
        self._guarded(self._input.release)

    @property
    def is_held_back(self) -> bool:
        """Whether the sender was asked to pause."""
        return self._input.is_held_back

    def close(self) -> None:
        """Close the port."""
        self._input.close()

    def poll(self) -> None:
        """Read what has arrived, up to `FULL` unread bytes."""
        self._guarded(self._take)

    def _take(self) -> None:
        while not self.text.is_complete and self.text.unread < FULL:
            data = self._input.read(FULL)
            if not data:
                break
            self.text.add(data)
        if self.text.is_complete:
            return
        if self.text.unread >= FULL:
            self._input.hold_back()
        elif self.text.unread <= LOW:
            self._input.release()

    def _guarded(self, work: Callable[[], None]) -> None:
        """Use the port; when it fails, nothing more arrives."""
        try:
            work()
        except UserError:
            self.text.complete()

    # --- entries ----------------------------------------------------------------------

    def entries(self, host: RunHost) -> Entries:
        """Yield the entries that have arrived, and `Starved` while more are missing."""
        reading = Reading(is_dry=self._is_dry, has_block_ends=True)
        run = Interpreter(self.program, self._store, host, self._dialect, reading)
        Mdi(run)  # makes the supplied cycles available without $I
        source: Callable[[], Iterator[c.Entry]] = run.entries
        while True:
            self.poll()
            try:
                yield from source()
                return
            except NotYetError:
                self._refuse_open_macros(run)
                yield Starved()
            except BlockError as error:
                raise self._unreached(error) from None
            source = run.go_on

    def _refuse_open_macros(self, run: Interpreter) -> None:
        """Refuse a call of a macro whose text has not arrived completely."""
        if any(frame.level is not Level.SUB for frame in run.flow.frames):
            raise self._too_early(run)

    def _too_early(self, run: Interpreter) -> BlockError:
        node = run.execution.node
        line = node.line if node else 1
        return BlockError(found("E108", NAME, line, 1, "the macro has not arrived"))

    def _unreached(self, error: BlockError) -> BlockError:
        """Report a jump to a label that has not arrived."""
        if error.finding.code != "E220":
            return error
        return BlockError(replace(error.finding, code="E108", hint="it has not arrived"))
