"""The part program that is loaded: from a file, a library part, a drawing, a batch or a line."""

import hashlib
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass, field
from math import nan
from pathlib import Path
from typing import Any

from openacr.cnc.interpreter.replay import Replay
from openacr.cnc.loading.batch import Entry, read_batch
from openacr.cnc.loading.load import load
from openacr.cnc.program.program import Program
from openacr.errors import OpenacrError, UserError
from openacr.mill.config.dialects import choose
from openacr.mill.config.folders import folders_of
from openacr.mill.session import Start
from openacr.panel.control.listing import Listing
from openacr.panel.control.orders import Order, failure
from openacr.panel.control.shared import Shared
from openacr.panel.work.paths import finding_data
from openacr.sysvar import Store

HASH_CHUNK = 1 << 20


@dataclass(slots=True)
class Loaded:
    """A program that is ready to run, and what is known of it."""

    name: str
    path: str  # in the folder of programs
    kind: str
    file: Path
    program: Program
    dialect: str
    listing: Listing
    version: str
    facts: dict[str, Any] = field(default_factory=dict)  # time, extents, tools: known later
    found: list[dict[str, Any]] | None = None  # findings of the whole program: known later
    is_stale: bool = False  # the file was stored again since

    @classmethod
    def read(cls, file: Path, path: str, kind: str, store: Store, dialect: str) -> "Loaded":
        """Load a program from its file; UserError where it cannot be read."""
        choice = choose(file, store, dialect or None)
        folder = store.path.parent if store.path else None
        program = load(file, store, choice.name, folders_of(store, folder))
        return cls(
            file.name, path, kind, file, program, choice.name, Listing(file), version_of(file)
        )

    def data(self) -> dict[str, Any]:
        """What the screens show of it."""
        findings = self.findings()
        errors = [each for each in findings if each["severity"] == "error"]
        return {
            "name": self.name,
            "path": self.path,
            "kind": self.kind,
            "dialect": self.dialect,
            "lines": self.listing.total,
            "errors": len(errors),
            "warnings": len(findings) - len(errors),
            "stale": self.is_stale,
            "id": self.version,
            "seconds": self.facts.get("seconds"),
            "extents": self.facts.get("extents"),
            "tools": self.facts.get("tools"),
        }

    def findings(self) -> list[dict[str, Any]]:
        """Errors and warnings: of the load, and of the whole program when it was read."""
        if self.found is not None:
            return self.found
        return [finding_data(each) for each in self.program.findings]


def version_of(file: Path) -> str:
    """The version of a file: a hash of its bytes."""
    found = hashlib.blake2b(digest_size=16)
    with file.open("rb") as opened:
        while chunk := opened.read(HASH_CHUNK):
            found.update(chunk)
    return found.hexdigest()


@dataclass(slots=True)
class _Batch:
    """A batch under way: its runs, and which one it is."""

    name: str
    entries: list[Entry]
    programs: dict[Path, Loaded]
    index: int = 0
    is_running: bool = False
    start: Start = field(default_factory=Start)


class Part:
    """The program of one machine."""

    def __init__(self, station: Shared) -> None:
        self._station = station
        self.loaded: Loaded | None = None
        self.loading = ""
        self._batch: _Batch | None = None
        self._rehearsed: tuple[str, Start, Replay] | None = None
        self._tokens = 0
        self.text = ""  # of the executing block
        self._text_of: tuple[str, int] = ("", 0)
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

    def rehearse(self, start: Start) -> dict[str, Any]:
        """Read the lines before a start line; what differs is confirmed by the operator."""
        loaded = self.required
        _require_sound(loaded)
        self._station.machine.runner.alarms.require_none()
        replay = self._station.machine.rehearse(loaded.program, start)
        self._tokens += 1
        token = f"{loaded.version[:8]}-{self._tokens}"
        self._rehearsed = (token, start, replay)
        return {
            "token": token,
            "line": start.line,
            "differences": [
                {"name": each.name, "present": each.present, "wanted": each.wanted}
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
        if self._batch is not None:
            self._batch.is_running, self._batch.start = True, start

    def poll(self) -> None:
        """Start the next program of a batch; follow the executing block."""
        session = self._station.machine
        self._follow()
        batch = self._batch
        if batch is None or not batch.is_running or session.runner.is_busy:
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
        """Note the text of the executing block, when it is another one."""
        source = self._station.machine.runner.source
        place = (source.file, source.line) if source is not None else ("", 0)
        if place == self._text_of:
            return
        self._text_of = place
        self.text = "" if source is None else (source.text or self._line(source.file, source.line))

    def _line(self, file: str, line: int) -> str:
        if self.loaded is None or file != self.loaded.program.main.text.name:
            return ""
        found = self.loaded.listing.lines(line, 1)
        return found[0] if found else ""

    def left_s(self) -> float:
        """The predicted time to the end of the program, without overrides; NaN if unknown."""
        session, loaded = self._station.session, self.loaded
        seconds = loaded.facts.get("seconds") if loaded is not None else None
        if session is None or seconds is None or session.runner.options.is_mdi:
            return nan
        return max(0.0, float(seconds) - session.runner.run_s)

    def data(self) -> dict[str, Any]:
        """The program, and where it is."""
        batch = self._batch
        file, line = self._text_of
        return {
            "loaded": self.loaded.data() if self.loaded else None,
            "loading": {"name": self.loading, "done": None} if self.loading else None,
            "line": line,
            "file": file,
            "text": self.text.strip(),
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
    errors = loaded.program.errors
    if errors:
        more = f" and {len(errors) - 1} more errors" if len(errors) > 1 else ""
        raise UserError(f"{loaded.name} cannot be started: {errors[0]}{more}")


def _explained(error: Exception) -> Exception:
    """A failure of loading as the operator reads it."""
    if isinstance(error, OSError) and not isinstance(error, OpenacrError):
        return UserError(f"{error.filename or 'the file'}: {(error.strerror or '').lower()}")
    if isinstance(error, MemoryError):
        return UserError("the program is too big for the memory of this computer")
    return error
