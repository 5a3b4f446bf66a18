"""Send the files of a project to a card, line by line, as a host would."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from msgspec import Struct

from openacr.basic.channels.session import Session
from openacr.basic.execute.system import System
from openacr.basic.language.loader import file_lines, long_lived_objects
from openacr.basic.language.registry import Level
from openacr.basic.memory.program_store import ProgramStore, StoredLine
from openacr.errors import CardError, SourceError
from openacr.lang.source import Span
from openacr.motion.axis import modules
from openacr.project import Place, Project, SourceFile

PATIENCE_S = 60.0  # a line of a set-up file that waits longer counts as hanging


class LoadError(SourceError):
    """Lines of project files that the card refuses; the first one is the error itself."""

    def __init__(self, errors: Sequence[SourceError]) -> None:
        first = errors[0]
        super().__init__(
            first.text, path=first.path, line=first.line, column=first.column, hint=first.hint
        )
        self.errors = tuple(errors)


class EmptyStart(Struct, frozen=True):
    """The first start of a program or PLC without lines: nothing runs, silently."""

    tick: int  # as `lived_tk`
    origin: tuple[str, int] | None  # file and line of the command; None if it was typed


@dataclass(slots=True)
class Origins:
    """Source positions, in the files of a project, of the stored lines of programs and PLCs."""

    path: str = ""  # of the file that is being read, and its line; none is after loading
    line: int = 0
    _places: dict[tuple[int, int], tuple[str, str, int]] = field(default_factory=dict)

    def note(self, owner: int, stored: StoredLine) -> None:
        """Record that the current line of the current file stored this line."""
        self._places[owner, stored.number] = stored.text, self.path, self.line

    def find(self, programs: ProgramStore, owner: int, number: int) -> tuple[str, int] | None:
        """File and line of a stored line; None if it was changed or came from elsewhere."""
        stored = programs.texts[owner].get(number)
        place = self._places.get((owner, number))
        if stored is None or place is None or place[0] != stored.text:
            return None
        return place[1:]


@dataclass(slots=True)
class Loader:
    """Feeds files to a session of a card; `wait` advances card time until the line is done."""

    system: System
    session: Session
    wait: Callable[[], bool]
    origins: Origins = field(default_factory=Origins)

    def load(self, project: Project) -> list[SourceError]:
        """Load every file; returns the errors the card reports, with their positions."""
        errors: list[SourceError] = []
        programs = self.system.programs
        programs.on_put = self.origins.note
        try:
            for source in project.sources:
                errors.extend(self._load_file(source))
        finally:
            programs.on_put = None
            self.origins.path = ""
        return errors

    def _load_file(self, source: SourceFile) -> list[SourceError]:
        if source.place is Place.SETUP:
            self.session.go(Level.SYS)
        else:
            level = Level.PROG if source.place is Place.PROGRAM else Level.PLC
            self.session.go(level, source.number)
        errors = []
        self.origins.path = str(source.path)
        with long_lived_objects():
            for line in file_lines(source.text):
                self.origins.line = line.number
                problem = self._feed(line.text)
                if problem:
                    span: Span | None = getattr(self.session.last_error, "span", None)
                    number = line.place(span.column)[0] if span else line.number
                    errors.append(SourceError(problem, path=str(source.path), line=number))
        if self.session.capture is not None:
            self._feed("ENDP")
        if source.place is Place.SETUP:
            # A machine is set up with its project once and then switched on again.
            modules.fit(self.system.card, self.system.setup.config)
        return errors

    def _feed(self, text: str) -> str | None:
        self.session.last_error = None
        self.session.feed_line(text)
        if self.session.busy and not self.wait():
            return f"the line is still waiting after {PATIENCE_S:g} s"
        error: CardError | None = self.session.last_error
        return error.text if error is not None else None
