"""Small files that are kept under names where the panel runs, and that all browsers share."""

import os
import re
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from datetime import datetime
from functools import lru_cache
from pathlib import Path
from threading import Lock
from typing import Any

from openacr.errors import UserError, unreadable, unwritable
from openacr.panel.control.operator.orders import PanelError
from openacr.panel.server.kept_kinds import KINDS, Kind, KindWord
from openacr.panel.work.project_texts import write

# A file on every system: Windows has devices of these names, whatever follows the point.
NAME = re.compile(r"(?!(?:con|prn|aux|nul|com\d|lpt\d)(?: *\.|$))[^\W_][\w .,+-]{0,59}", re.I)
_CHANGES = Lock()  # browsers may change them at the same time


class KeptFiles:
    """The files of one kind below a folder; without a folder nothing is listed or stored."""

    def __init__(self, root: Path | None, word: KindWord) -> None:
        self._word, self._kind = word, KINDS[word]
        self._suffix = f".{word}.json"
        self._folder = None if root is None else root / self._kind.folder

    def entries(self) -> list[dict[str, Any]]:
        """What there is, by name: kind, name, bytes, time of the last change, what its kind says.

        What cannot be read, or was not stored here, is left out.
        """
        found = []
        for file in self._folder.glob(f"*{self._suffix}") if self._folder is not None else ():
            name = file.name.removesuffix(self._suffix)
            with suppress(OSError, UserError, ValueError):
                _require_name(name)
                stat = file.stat()
                about = _about(self._kind, file, (stat.st_ino, stat.st_mtime_ns, stat.st_size))
                changed = datetime.fromtimestamp(stat.st_mtime).astimezone().isoformat()
                entry = {"kind": self._word, "name": name, "bytes": stat.st_size}
                found.append({**entry, "changed": changed, **about})
        return sorted(found, key=lambda each: each["name"].casefold())

    def read(self, name: str) -> bytes:
        """The text of one; PanelError for a name that is not there, UserError for another text."""
        file = self._existing(name)
        try:
            text = _bounded(self._kind, file)
        except OSError as error:
            raise unreadable(file, error) from None
        return self._checked(name, text)

    def store(self, name: str, text: bytes, *, replace: bool) -> None:
        """Keep one under a name; PanelError where it is taken.

        UserError for another text, a name that is not allowed, one too many, and without a folder.
        """
        content = self._checked(name, text)
        file = self._at(name)
        with _changing(file):
            if file.exists() and not replace:
                raise self._taken(name)
            if not file.exists() and len(self.entries()) >= self._kind.most:
                raise UserError(
                    f"{name}: {self._kind.most} of the kind {self._kind.noun} are kept, the most"
                    " there can be: delete one first"
                )
            file.parent.mkdir(parents=True, exist_ok=True)
            write(file, content.decode())

    def rename(self, name: str, to: str) -> None:
        """Give one another name; PanelError where that is taken."""
        target = self._at(to)
        with _changing(target):
            file = self._existing(name)
            if target.exists() and not target.samefile(file):
                raise self._taken(to)
            os.replace(file, target)

    def delete(self, name: str) -> None:
        """Delete one; PanelError for a name that is not there."""
        with _changing(self._at(name)):
            self._existing(name).unlink()

    def _at(self, name: str) -> Path:
        _require_name(name)
        if self._folder is None:
            raise UserError(
                f"no {self._kind.noun} is kept here: the store is in memory; name a store"
                " (--store FILE) or a project"
            )
        return self._folder / f"{name}{self._suffix}"

    def _existing(self, name: str) -> Path:
        file = self._at(name)
        if not file.is_file():
            raise PanelError("missing", f"there is no {self._kind.noun} {name}")
        return file

    def _taken(self, name: str) -> PanelError:
        return PanelError("conflict", f"the {self._kind.noun} {name} is there already")

    def _checked(self, name: str, text: bytes) -> bytes:
        try:
            content = self._kind.text_of(self._kind.parsed(text))
        except ValueError as error:
            raise UserError(f"{name} is no {self._kind.noun}: {error}") from None
        _require_size(self._kind, name, len(content))  # 0 has become 0.0
        return content


def root_of(project: Path | None, store: Path | None) -> Path | None:
    """Where files are kept: in the folder of the project, else beside the store; None: nowhere."""
    return project or (None if store is None else store.parent)


@contextmanager
def _changing(file: Path) -> Iterator[None]:
    """One change at a time; UserError where the system refuses it."""
    with _CHANGES:
        try:
            yield
        except OSError as error:
            raise unwritable(file, error) from None


@lru_cache(maxsize=512)
def _about(kind: Kind, file: Path, _state: tuple[int, int, int]) -> dict[str, Any]:
    """What a list says of a file, read once as long as it is the same."""
    return kind.about(kind.parsed(_bounded(kind, file)))


def _bounded(kind: Kind, file: Path) -> bytes:
    _require_size(kind, file.name, file.stat().st_size)
    return file.read_bytes()


def _require_size(kind: Kind, name: str, size: int) -> None:
    if size > kind.most_bytes:
        raise UserError(f"{name} has {size} bytes: a {kind.noun} has {kind.most_bytes} at most")


def _require_name(name: str) -> None:
    if NAME.fullmatch(name) is None or name != name.strip(" .") or len(name.encode()) > 120:
        raise UserError(
            f"{name[:60]!r} is no name: up to 60 letters, digits, spaces and . , + - _ after a"
            " letter or digit, and none of a device (CON, NUL, COM1 ...)"
        )
