"""The part program of one machine: loaded from a file, a library part, a drawing or a batch."""

from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass, field
from math import nan
from pathlib import Path
from typing import Any

from openacr.cnc.interpreter.replay import Rehearsal, Replay
from openacr.cnc.loading.batch import Entry, read_batch
from openacr.errors import OpenacrError, UserError
from openacr.mill.session import Start
from openacr.panel.control.executing import Executing
from openacr.panel.control.loaded import Loaded
from openacr.panel.control.orders import Order, failure
from openacr.panel.control.shared import Shared
from openacr.wording import counted

AT_ONCE = 100  # moves and outputs of a rehearsal between two steps of the machine


@dataclass(slots=True)
class _Batch:
    """A batch under way: its runs, and which one it is."""

    name: str
    entries: list[Entry]
    programs: dict[Path, Loaded]
    index: int = 0
    is_running: bool = False
    start: Start = field(default_factory=Start)


@dataclass(slots=True)
class _Rehearsing:
    """The lines before a start line while they are read, and who waits for what differs."""

    steps: Rehearsal
    loaded: Loaded
    start: Start
    order: Order


class Part:
    """The program of one machine."""

    def __init__(self, station: Shared) -> None:
        self._station = station
        self.loaded: Loaded | None = None
        self.loading = ""
        self._batch: _Batch | None = None
        self._rehearsed: tuple[str, Start, Replay] | None = None
        self._rehearsing: _Rehearsing | None = None
        self._tokens = 0
        self._first_line = 1  # of the run
        self.executing = Executing(station)
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
    def bar(self) -> str:
        """Why the loaded program cannot be started; empty if it can."""
        return "" if self.loaded is None else _errors(self.loaded)

    # --- loading ----------------------------------------------------------------------

    def require_free(self) -> None:
        """Refuse another program while one runs or is being loaded."""
        session = self._station.session
        if session is not None and session.runner.is_busy and not session.runner.options.is_mdi:
            raise UserError(f"a program runs: the state is {session.runner.state.name}")
        if self.loading:
            raise UserError(f"{self.loading} is being loaded")

    def load(self, file: Path, path: str, order: Order, *, kind: str, dialect: str) -> None:
        """Load a program beside the control thread; the order is answered at the end."""
        self.require_free()
        store = self._station.installation.store
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

        self._station.jobs.begin(lambda: Loaded.read(file, path, kind, store, dialect), done)

    def take(self, loaded: Loaded | None) -> None:
        """Make a program the one that START starts."""
        self.loaded, self._batch, self._rehearsed = loaded, None, None
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
        store = self._station.installation.store
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

        self._station.jobs.begin(work, done)

    # --- running ----------------------------------------------------------------------

    def rehearse(self, start: Start, order: Order) -> None:
        """Read the lines before a start line; what differs is confirmed by the operator.

        They are read between the steps of the control thread; the order is answered at the end.
        """
        loaded = self.required
        _require_sound(loaded)
        session = self._station.machine
        session.runner.require_start()
        if self._rehearsing is not None:
            raise UserError("the lines before a start line are being read: wait")
        self._rehearsing = _Rehearsing(
            session.rehearsal(loaded.program, start), loaded, start, order
        )

    def rehearse_on(self, is_awaited: Callable[[], bool]) -> None:
        """Go on reading the lines before a start line, for AT_ONCE steps or until a stop waits."""
        under_way = self._rehearsing
        if under_way is None:
            return
        try:
            self._station.machine.runner.require_start()  # the machine is where it was
            if self.loaded is not under_way.loaded:
                raise UserError("another program was loaded")
            for _ in range(AT_ONCE):
                if is_awaited():
                    return
                next(under_way.steps)
        except StopIteration as done:
            self._rehearsing = None
            result = self._confirmable(done.value, under_way)
            under_way.order.answer({"ok": True, "result": {"rehearsal": result}})
        except Exception as error:
            self._rehearsing = None
            under_way.order.answer({"ok": False, "error": failure(error)})

    def _confirmable(self, replay: Replay, under_way: _Rehearsing) -> dict[str, Any]:
        loaded, start = under_way.loaded, under_way.start
        self._tokens += 1
        token = f"{loaded.version[:8]}-{self._tokens}"
        self._rehearsed = (token, start, replay)
        return {
            "token": token,
            "line": start.line,
            "differences": [
                {
                    "name": each.name,
                    "present": each.shown(each.present),
                    "wanted": each.shown(each.wanted),
                }
                for each in replay.differences
            ],
            "warnings": [str(each) for each in replay.warnings],
            "needs_tool": replay.needs_tool,
            "safe_z": replay.safe_level(),
        }

    def begin(self, start: Start, confirm: str) -> None:
        """Start the loaded program; a later line only with what its rehearsal was confirmed by."""
        loaded = self.required
        _require_sound(loaded)
        replay = None
        if start.line > 1:
            if self._rehearsed is None or self._rehearsed[0] != confirm:
                raise UserError(f"line {start.line}: what differs there is confirmed first")
            _token, rehearsed, replay = self._rehearsed
            if rehearsed.line != start.line or rehearsed.is_dry != start.is_dry:
                raise UserError(f"line {start.line}: line {rehearsed.line} was confirmed")
        self._rehearsed = None
        self._station.machine.start(loaded.program, start, replay)
        self._first_line = start.line
        if self._batch is not None:
            self._batch.is_running, self._batch.start = True, start

    def poll(self) -> None:
        """Start the next program of a batch; follow the executing block."""
        self._follow()
        batch = self._batch
        if batch is None or not batch.is_running:
            return
        session = self._station.machine
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
        session, loaded = self._station.session, self.loaded
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
