"""Read the files of cases; all that is wrong is found, with its line and what belongs there.

A file has lines for all its cases (`rests on: manual`), then cases: `[case NAME]`, lines about the
case (`proves:`, `source:` ...), steps, and perhaps a table, which makes a case of each of its rows.
Blank lines and lines that begin with `# ` are remarks.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from openacr.conform import words as _words  # noqa: F401  (declares the words)
from openacr.conform import words_loaded as _loaded  # noqa: F401
from openacr.conform import words_part as _part  # noqa: F401
from openacr.conform.facts import needs_of
from openacr.conform.form import (
    ANSWERS,
    BLOCK,
    Case,
    Claim,
    Line,
    Machine,
    Reach,
    Step,
    step_of,
)
from openacr.errors import FaultyFileError, SourceError, UserError, read_bytes
from openacr.models import DEFAULT_MODEL, MODELS

PACKAGE = Path(__file__).parents[1]
INSTALLED = PACKAGE / "conformance"  # which the build (setup.py) copies
RESTS = ("manual", "oracle", "client", "inferred")
MACHINES = "machines"  # the folder of machines, in the folder of the manuals or above it
MAY_BE_EMPTY = ("shows:", "prints:", "says:", "alarm:", "entries:")
_CASE = re.compile(r"\[case (.+)\]")
_ABOUT = re.compile(r"(proves|source|rests on|machine|model|needs|only|moves|changes):(?:\s+(.*))?")
_CLAIM = re.compile(r"\s*([A-Z]+(?:-[A-Z0-9]+)+)\s*(?:\(([^()]*)\))?\s*(?:,|$)")
_MANUAL = re.compile(r"\b00[013] L\d+")
_REACH = re.compile(r"(\d+\.?\d*) units? at (\d+\.?\d*) units/s")
_CHANGED = re.compile(r"(?:P|BIT)\d+")
_COLUMN = re.compile(r"\{([^{}]+)\}")


class _FaultError(Exception):
    """Something wrong in a line."""

    def __init__(self, line: Line, text: str, hint: str = "") -> None:
        self.number, self.text, self.hint = line.number, text, hint


class _Reader:
    """Reads one file and collects what is wrong with it."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.faults: list[SourceError] = []

    def cases(self, text: str) -> list[Case]:
        """The cases of a text, in order."""
        lines = [Line(at, each.rstrip()) for at, each in enumerate(text.split("\n"), 1)]
        first, *groups = _split(lines)
        cases: list[Case] = []
        with self._noting():
            shared, steps = _about(first)
            if steps:
                raise _FaultError(
                    steps[0], f"{steps[0].text}: expected [case NAME] before the first step"
                )
        for group in groups:
            with self._noting():
                cases += self._group(group, shared)
        seen: dict[str, Case] = {}
        for case in cases:
            earlier = seen.setdefault(case.name, case)
            with self._noting():
                if earlier is not case:
                    again = f"{case.name}: the case in line {earlier.line} has the same name"
                    raise _FaultError(Line(case.line, ""), again)
        return cases

    @contextmanager
    def _noting(self) -> Iterator[None]:
        """Keep what is wrong, and continue after it."""
        try:
            yield
        except _FaultError as fault:
            path = str(self.path)
            self.faults.append(
                SourceError(fault.text, path=path, line=fault.number, hint=fault.hint)
            )

    def _group(self, group: Sequence[Line], shared: dict[str, list[Line]]) -> Iterator[Case]:
        """A case, or one for each row of its table."""
        head, *body = group
        title = _CASE.fullmatch(head.text)
        if title is None:
            raise _FaultError(head, f"{head.text}: expected [case NAME]")
        body, rows = _table([head._replace(text=title[1]), *body])
        for row in rows:
            name, *filled = (_filled(line, row) for line in body)
            if row and name.text == title[1]:
                name = name._replace(text=f"{title[1]} [{', '.join(row.values())}]")
            about, lines = _about([line for line in filled if line.text])
            yield self._case(name, shared | about, lines)

    def _case(self, head: Line, about: dict[str, list[Line]], lines: Sequence[Line]) -> Case:
        texts = {key: found[0].text for key, found in about.items()}
        rests, source = texts.get("rests on", ""), texts.get("source", "")
        if rests.split(":")[0] not in RESTS or (rests in RESTS and rests != "manual"):
            kinds = " | ".join(["manual", *(f"{kind}: what" for kind in RESTS[1:])])
            raise _FaultError(
                about.get("rests on", [head])[0], f"rests on: {rests}: expected {kinds}"
            )
        if not _MANUAL.search(source) and rests.split(":")[0] in ("manual", "oracle"):
            text = f"source: {source}: expected a manual and its line, 000 L2011"
            raise _FaultError(about.get("source", [head])[0], text)
        if texts.get("only", "virtual") != "virtual":
            raise _FaultError(about["only"][0], f"only: {texts['only']}: expected virtual")
        if texts.get("model", DEFAULT_MODEL.name) not in MODELS:
            names = ", ".join(MODELS)
            raise _FaultError(about["model"][0], f"model: {texts['model']}: expected {names}")
        try:
            needs = needs_of(texts["needs"]) if "needs" in texts else ()
        except ValueError as error:
            raise _FaultError(about["needs"][0], f"needs: {texts['needs']}: {error}") from None
        steps = tuple(self._steps(lines))
        if not steps:
            raise _FaultError(
                head, f"{head.text}: expected steps below", "> LINE, ? VALUE -> RESULT ..."
            )
        return Case(
            head.text,
            self.path,
            head.number,
            tuple(_claims(about["proves"][0])) if "proves" in about else (),
            source,
            rests,
            self._machine(about["machine"]) if "machine" in about else Machine(),
            texts.get("model", ""),
            needs,
            texts.get("only", ""),
            self._reach(about["moves"][0]) if "moves" in about else None,
            self._changes(about["changes"][0]) if "changes" in about else (),
            steps,
        )

    def _reach(self, line: Line) -> Reach | None:
        found = _REACH.fullmatch(line.text)
        if line.text and not found:
            raise _FaultError(line, f"moves: {line.text}: expected 1 units at 2 units/s")
        return Reach(float(found[1]), float(found[2])) if found else None

    def _changes(self, line: Line) -> tuple[str, ...]:
        names = tuple(each.strip() for each in line.text.split(",")) if line.text else ()
        for name in names:
            if not _CHANGED.fullmatch(name):
                raise _FaultError(line, f"changes: {name}: expected P or BIT with a number, ...")
        return names

    def _machine(self, lines: Sequence[Line]) -> Machine:
        name, *below = lines
        if not name.text:
            return Machine(text="\n".join(line.text for line in below))
        places = [folder / MACHINES for folder in self.path.resolve().parents]
        found = next((place for place in places if place.is_dir()), None)
        there = sorted(each.name for each in found.iterdir() if each.is_dir()) if found else []
        wanted = name.text.replace(" ", "-")
        if found is None or wanted not in there:
            names = ", ".join(there).replace("-", " ")
            raise _FaultError(name, f"machine: {name.text}: the machines are {names}")
        return Machine(found / wanted)

    def _steps(self, lines: Sequence[Line]) -> Iterator[Step]:
        step: Step | None = None
        for line in lines:
            is_indented, below = line.text[0] == " ", step.word.below if step else ""
            if is_indented and below == BLOCK and step:
                step.below.append(line)
                continue
            new = None if is_indented or line.text[0] == "|" else _step(line)
            if new is not None:
                if step:
                    yield _whole(step)
                step = new
            elif below == ANSWERS and step:
                step.below.append(line)
            else:
                text = f"{line.text}: expected a step here"
                raise _FaultError(line, text, "> LINE, ? VALUE -> RESULT, wait TIME ...")
        if step:
            yield _whole(step)


def _step(line: Line) -> Step | None:
    try:
        return step_of(line)
    except ValueError as error:
        raise _FaultError(line, f"{line.text}: {error}") from None


def _whole(step: Step) -> Step:
    """A step with its block moved to the left."""
    if step.word.below != BLOCK:
        return step
    if step.word.form.endswith(":") and not step.below and step.word.form not in MAY_BE_EMPTY:
        raise _FaultError(step.at, f"{step.at.text}: expected indented lines below")
    margin = min((len(line.text) - len(line.text.lstrip()) for line in step.below), default=0)
    return replace(step, below=[Line(line.number, line.text[margin:]) for line in step.below])


def _split(lines: Sequence[Line]) -> list[list[Line]]:
    """The lines before the first case, then those of each case, without remarks."""
    groups: list[list[Line]] = [[]]
    for line in lines:
        if line.text.startswith("["):
            groups.append([])
        if line.text and line.text != "#" and not line.text.startswith("# "):
            groups[-1].append(line)
    return groups


def _about(lines: Sequence[Line]) -> tuple[dict[str, list[Line]], list[Line]]:
    """The lines about a case by their words, each with the indented ones below; and the rest."""
    about: dict[str, list[Line]] = {}
    for at, line in enumerate(lines):
        match = _ABOUT.fullmatch(line.text)
        if match and match[1] in about:
            raise _FaultError(line, f"{match[1]}: there is such a line above")
        if match:
            about[match[1]] = [Line(line.number, match[2] or "")]
        elif line.text[0] == " " and about:
            about[list(about)[-1]].append(line)
        else:
            return about, list(lines[at:])
    return about, []


def _table(lines: list[Line]) -> tuple[list[Line], list[dict[str, str]]]:
    """The lines before a table, and its rows by column; without a table one row of nothing."""
    at = next((at for at, line in enumerate(lines) if line.text == "table:"), None)
    if at is None:
        return lines, [{}]
    body, (title, *table) = lines[:at], lines[at:]
    if len(table) < 2:
        raise _FaultError(title, "table: expected a line of columns and lines of values below")
    columns, *cells = ([each.strip() for each in line.text.split("|")] for line in table)
    for line, row in zip(table[1:], cells, strict=True):
        if len(row) != len(columns):
            raise _FaultError(line, f"expected {len(columns)} values ({' | '.join(columns)})")
    used = {name for line in body for name in _COLUMN.findall(line.text)}
    for name in columns:
        if name not in used:
            raise _FaultError(table[0], f"{name}: no line above has {{{name}}}")
    return body, [dict(zip(columns, row, strict=True)) for row in cells]


def _filled(line: Line, row: dict[str, str]) -> Line:
    """A line with the values of a row in place of its columns; without a table as it is."""
    if not row:
        return line

    def cell(match: re.Match[str]) -> str:
        if match[1] not in row:
            raise _FaultError(line, f"{match[0]}: the columns are {', '.join(row)}")
        return row[match[1]]

    return line._replace(text=_COLUMN.sub(cell, line.text).rstrip())


def _claims(line: Line) -> Iterator[Claim]:
    at = 0
    while at < len(line.text):
        match = _CLAIM.match(line.text, at)
        if match is None:
            raise _FaultError(
                line, f"proves: {line.text[at:].strip()}: expected ID or ID (clause), ID ..."
            )
        yield Claim(match[1], match[2] or "")
        at = match.end()


def read(path: Path) -> list[Case]:
    """The cases of a file; FaultyFileError with all that is wrong, UserError if unreadable."""
    try:
        text = read_bytes(path).decode()
    except UnicodeDecodeError as error:
        raise UserError(f"{path}: not UTF-8: {error.reason}") from None
    reader = _Reader(path)
    cases = reader.cases(text)
    if reader.faults:
        raise FaultyFileError(reader.faults)
    return cases


def files(folder: Path) -> list[Path]:
    """The files of cases in a folder and its subfolders, in the order of their names."""
    return sorted(path for path in folder.rglob("*.txt") if MACHINES not in path.parts)


def supplied() -> Path:
    """The folder of the cases that come with the package, or of the source tree."""
    return INSTALLED if INSTALLED.is_dir() else PACKAGE.parents[1] / "conformance"
