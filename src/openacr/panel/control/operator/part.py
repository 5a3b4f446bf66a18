"""The part program of one machine: loaded from a file, a library part, a drawing or a batch."""

from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass, field
from math import nan
from pathlib import Path
from typing import Any

from openacr.cnc.canonical import Source
from openacr.cnc.loading.batch import Entry, read_batch
from openacr.errors import OpenacrError, UserError
from openacr.mill.run.lifecycle import State
from openacr.mill.session import Start
from openacr.panel.control.jobs import Jobs
from openacr.panel.control.machine.link import Link
from openacr.panel.control.operator.loaded import Loaded
from openacr.panel.control.operator.orders import Order, failure
from openacr.panel.control.operator.rehearsals import Rehearsals
from openacr.wording import counted

UNDER_WAY = frozenset({State.RUN, State.WAIT, State.PAUSED, State.HOLD})


@dataclass(slots=True)
class _Batch:
    """A batch under way: its runs, and which one it is."""

    name: str
    entries: list[Entry]
    programs: dict[Path, Loaded]
    index: int = 0
    is_running: bool = False
    start: Start = field(default_factory=Start)


class Executing:
    """The block that a part program is at; empty while none runs. Neither MDI nor homing is one."""

    def __init__(self, link: Link) -> None:
        self._link = link
        self.file = ""
        self.line = 0  # of that file
        self.caller: Source | None = None  # the block whose cycle it belongs to
        self.text = ""

    @property
    def is_under_way(self) -> bool:
        """Whether a part program runs, waits or is held."""
        session = self._link.session
        if session is None or session.runner.options.is_mdi:
            return False
        return session.runner.state in UNDER_WAY

    def follow(self, text_of: Callable[[Source], str]) -> None:
        """Note the executing block, and its text when it is another one than before."""
        session = self._link.session
        source = session.runner.source if session is not None and self.is_under_way else None
        found = (source.file, source.line, source.caller) if source is not None else ("", 0, None)
        if found == (self.file, self.line, self.caller):
            return
        self.file, self.line, self.caller = found
        self.text = "" if source is None else (source.text or text_of(source)).strip()


class Part:
    """The program of one machine."""

    def __init__(self, link: Link, jobs: Jobs) -> None:
        self._link, self._jobs = link, jobs
        self.loaded: Loaded | None = None
        self.loading = ""
        self._batch: _Batch | None = None
        self._rehearsals = Rehearsals(link)
        self._first_line = 1  # of the run
        self.executing = Executing(link)
        self.is_single = False
        self.is_skipping = False
        self.stops_optionally = False
        self.changed: Callable[[], None] = lambda: None  # another program is loaded

    @property
    def required(self) -> Loaded:
        """The loaded program; UserError if there is none."""
        if self.loaded is None:
            raise UserError("no program is loaded")
        return self.loaded

    @property
    def name(self) -> str:
        """The name of the loaded program; that of a program over a serial line is not known."""
        return self.loaded.name if self.loaded is not None else "the part program"

    @property
    def path(self) -> str:
        """Where the loaded program is in the folder of programs; empty without one."""
        return "" if self.loaded is None else self.loaded.path

    @property
    def bar(self) -> str:
        """Why the loaded program cannot be started; empty if it can."""
        return "" if self.loaded is None else _errors(self.loaded)

    # --- loading ----------------------------------------------------------------------

    def require_free(self) -> None:
        """Refuse another program while one runs or is being loaded."""
        session = self._link.session
        if session is not None and session.runner.is_busy and not session.runner.options.is_mdi:
            raise UserError(f"a program runs: the state is {session.runner.state.name}")
        if self.loading:
            raise UserError(f"{self.loading} is being loaded")

    def load(self, file: Path, path: str, order: Order, *, kind: str, dialect: str) -> None:
        """Load a program beside the control thread; the order is answered at the end."""
        self.require_free()
        store = self._link.installation.store
        self.loading = file.name

        def done(future: Future[Loaded]) -> None:
            self.loading = ""
            try:
                loaded = future.result()
            except Exception as error:
                order.answer({"ok": False, "error": failure(_explained(error))})
                return
            self.take(loaded)
            order.answer({"ok": True, "result": loaded.data()})

        self._jobs.begin(lambda: Loaded.read(file, path, kind, store, dialect), done)

    def take(self, loaded: Loaded | None) -> None:
        """Make a program the one that START starts."""
        self.loaded, self._batch = loaded, None
        self._rehearsals.forget()
        self.changed()

    def note_facts(
        self, version: str, facts: dict[str, Any], findings: list[dict[str, Any]]
    ) -> None:
        """Note what reading the whole program has shown."""
        if self.loaded is not None and self.loaded.version == version:
            self.loaded.facts, self.loaded.found = facts, findings

    def note_stored(self, path: str) -> None:
        """A file was stored: a loaded program stays as it was."""
        if self.loaded is not None and self.loaded.path == path:
            self.loaded.is_stale = True

    def close(self) -> None:
        """Unload the program."""
        self.require_free()
        self.take(None)

    def load_batch(self, file: Path, order: Order, place: Callable[[Path], str]) -> None:
        """Load all programs of a batch file; it runs them one after the other."""
        self.require_free()
        store = self._link.installation.store
        self.loading = file.name

        def work() -> _Batch:
            batch = read_batch(file)
            programs = {
                each: Loaded.read(each, place(each), "batch", store, "") for each in batch.programs
            }
            for each in programs.values():
                _require_sound(each)
            return _Batch(file.name, list(batch.runs()), programs)

        def done(future: Future[_Batch]) -> None:
            self.loading = ""
            try:
                batch = future.result()
            except Exception as error:
                order.answer({"ok": False, "error": failure(_explained(error))})
                return
            self.take(batch.programs[batch.entries[0].path])
            self._batch = batch
            order.answer({"ok": True, "result": self.required.data()})

        self._jobs.begin(work, done)

    # --- running ----------------------------------------------------------------------

    def rehearse(self, start: Start, order: Order) -> None:
        """Read the lines before a start line; the order is answered at the end."""
        _require_sound(self.required)
        self._rehearsals.begin(self.required, start, order)

    def rehearse_on(self) -> None:
        """Go on reading the lines before a start line, for a while."""
        self._rehearsals.go_on(self.loaded)

    def begin(self, start: Start, confirm: str) -> None:
        """Start the loaded program; a later line only with what its rehearsal was confirmed by."""
        loaded = self.required
        _require_sound(loaded)
        replay = self._rehearsals.confirmed(start, confirm) if start.line > 1 else None
        self._rehearsals.forget()
        self._link.machine.start(loaded.program, start, replay)
        self._first_line = start.line
        if self._batch is not None:
            self._batch.is_running, self._batch.start = True, start

    def poll(self) -> None:
        """Start the next program of a batch; follow the executing block."""
        self._follow()
        batch = self._batch
        if batch is None or not batch.is_running:
            return
        session = self._link.machine
        if session.runner.is_busy:
            return
        if session.runner.was_aborted or session.runner.alarms.bars_start:
            batch.is_running = False
            return
        batch.index += 1
        if batch.index >= len(batch.entries):
            batch.index = 0
            batch.is_running = session.runner.settings.repeats
            if not batch.is_running:
                return
        self.loaded = batch.programs[batch.entries[batch.index].path]
        self.changed()
        session.start(self.loaded.program, batch.start)

    def _follow(self) -> None:
        loaded = self.loaded
        self.executing.follow(loaded.text_of if loaded is not None else lambda _source: "")

    @property
    def line(self) -> int:
        """The executing line of the loaded text, that of the call while a cycle executes.

        0 in an included text, and while none runs.
        """
        executing, loaded = self.executing.caller or self.executing, self.loaded
        return executing.line if loaded is not None and loaded.has(executing.file) else 0

    def left_s(self) -> float:
        """The predicted time to the end of the program that runs, without overrides, s.

        NaN if it is unknown: while no program runs, and in a dry run, in a run from a later line
        and in one over a serial line, which have no prediction.
        """
        session, loaded = self._link.session, self.loaded
        seconds = loaded.facts.get("seconds") if loaded is not None else None
        if session is None or loaded is None or seconds is None:
            return nan
        is_whole = session.program is loaded.program and self._first_line == 1
        if not self.executing.is_under_way or not is_whole or session.runner.options.is_dry:
            return nan
        return max(0.0, float(seconds) - session.runner.pass_s)

    def data(self) -> dict[str, Any]:
        """The program, and where it is."""
        batch, executing = self._batch, self.executing
        return {
            "loaded": self.loaded.data() if self.loaded else None,
            "loading": {"name": self.loading, "done": None} if self.loading else None,
            "line": executing.line,
            "file": executing.file,
            "text": executing.text,
            "batch": None
            if batch is None
            else {
                "name": batch.name,
                "index": batch.index,
                "count": len(batch.entries),
                "names": [each.path.name for each in batch.entries],
            },
        }


def _require_sound(loaded: Loaded) -> None:
    if bar := _errors(loaded):
        raise UserError(bar)


def _errors(loaded: Loaded) -> str:
    """Why a program with errors is not started; empty without any."""
    errors = loaded.program.errors
    if not errors:
        return ""
    more = f" and {counted(len(errors) - 1, 'more error')}" if len(errors) > 1 else ""
    return f"{loaded.name} cannot be started: {errors[0]}{more}"


def _explained(error: Exception) -> Exception:
    """A failure of loading as the operator reads it."""
    if isinstance(error, OSError) and not isinstance(error, OpenacrError):
        return UserError(f"{error.filename or 'the file'}: {(error.strerror or '').lower()}")
    if isinstance(error, MemoryError):
        return UserError("the program is too big for the memory of this computer")
    return error
