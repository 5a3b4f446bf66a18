"""Restore a backup; nothing is cleared before the card is known to accept it.

First every setting of the backup is queried, so that a setting unknown to the card (another
model, an extension of openacr) ends the restore before anything has changed. Then the contents
of the card are read; if it still refuses a line, they are restored.
"""

import re
from collections.abc import Iterator
from pathlib import Path

from msgspec import Struct

from openacr.basic.language import registry
from openacr.basic.language.registry import Command
from openacr.client.backup import Files, backup, files_of
from openacr.client.effects import Op
from openacr.client.errors import ClientError, DownloadError, RefusedError, RestoreError
from openacr.client.requests import SYS, Level
from openacr.client.talk import Talk
from openacr.client.transfer import Progress, Report, download
from openacr.errors import UserError
from openacr.messages import INVALID_ARGUMENT, NOT_SUPPORTED, SYNTAX_ERROR, UNKNOWN_COMMAND

_SETTING = re.compile(
    r"(?P<query>.+?) (?:\([^()]*\)|-?[\d.]+(?:[Ee][-+]?\d+)?|ON|OFF|(?<=SRC )[A-Z]+\d*)"
)
_AXIS = re.compile(r"AXIS\d+ ")
_OBJECT = re.compile(r"([A-Z]+)\d+ ")
_UNKNOWN = (UNKNOWN_COMMAND, SYNTAX_ERROR, INVALID_ARGUMENT, NOT_SUPPORTED)


def restore(talk: Talk, files: Files, progress: Progress | None = None) -> Op[list[Report]]:
    """Stop everything, clear the card and send a backup.

    DownloadError if the card does not know a setting: nothing has changed. RestoreError
    if it fails later: the card then has its former contents, or the error holds them.
    """
    yield from _needs_known_settings(talk, files)
    former = yield from backup(talk, progress)
    try:
        return (yield from _send(talk, files, progress))
    except (ClientError, UserError, KeyboardInterrupt) as failure:
        yield from _put_back(talk, former, failure)
        raise


def _send(talk: Talk, files: Files, progress: Progress | None = None) -> Op[list[Report]]:
    reports: list[Report] = []
    for path, level, text in files:
        reports.append((yield from download(
            talk, text, path=str(path), to=level, progress=progress
        )))  # fmt: skip
    yield from talk.go(SYS)
    return reports


def _put_back(talk: Talk, former: dict[str, str], failure: BaseException) -> Op[None]:
    """Restore the former contents; raises RestoreError, after Ctrl-C only if that fails."""
    try:
        yield from _send(talk, files_of(former))
    except (ClientError, UserError, KeyboardInterrupt) as second:
        raise RestoreError(failure, former, second) from None
    if not isinstance(failure, KeyboardInterrupt):
        raise RestoreError(failure, former) from None


# --- what the card knows ------------------------------------------------------------------


class _Setting(Struct, frozen=True):
    """A line of a backup that sets a value, and the query for the value."""

    row: Command
    query: str
    level: Level
    path: Path
    line: int


def _needs_known_settings(talk: Talk, files: Files) -> Op[None]:
    home = talk.level
    asked: set[tuple[str, Level]] = set()
    for setting in (each for file in files for each in _settings(*file)):
        if (setting.query, setting.level) in asked:
            continue
        asked.add((setting.query, setting.level))
        try:
            yield from talk.query(setting.query, at=setting.level)
        except RefusedError as refused:
            if refused.message in _UNKNOWN:
                raise _unknown(setting, refused.text) from None
    yield from talk.go(home)


def _unknown(setting: _Setting, text: str) -> DownloadError:
    why = "an extension of openacr: real cards refuse it; " if setting.row.is_extension else ""
    return DownloadError(
        f"the card does not know {setting.query}: {text}",
        path=str(setting.path),
        line=setting.line,
        hint=f"{why}nothing was changed",
    )


def _settings(path: Path, level: Level, text: str) -> Iterator[_Setting]:
    """The settings of the set-up file; programs and PLCs have none."""
    if level != SYS:
        return
    for number, line in enumerate(text.splitlines(), start=1):
        level = Level.of_line(line) or level
        found = _SETTING.fullmatch(line)
        if found is not None and (row := command_of(found["query"])) is not None:
            yield _Setting(row, found["query"], level, path, number)


def command_of(query: str) -> Command | None:
    """The command that a query such as `AXIS0 PGAIN` or `ENC3 MULT` asks for, if it is saved."""
    words = _OBJECT.sub(r"\1 # ", query, count=1)
    for name in (query, _AXIS.sub("", query, count=1), words):
        row = registry.known(name)
        if row is not None and row.saved:
            return row
    return None
