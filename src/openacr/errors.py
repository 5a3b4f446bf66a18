"""Everything that can go wrong, as types whose fields say what, where and what to do."""

import os
from collections.abc import Iterable
from pathlib import Path

from openacr.messages import Message


def reason(failure: Exception) -> str:
    """What a failure of the system says, without the sentences libraries put around it."""
    number = getattr(failure, "errno", None)
    if number is not None and number > 0:  # below 0 they are those of name look-ups
        return os.strerror(number)
    return getattr(failure, "strerror", None) or str(failure)


class OpenacrError(Exception):
    """Base of all errors a user can cause; `str()` is one complete sentence."""


class CardError(OpenacrError):
    """An error the card reports: `str()` is exactly the text the card prints."""

    def __init__(self, message: Message, detail: object = "") -> None:
        self.message = message
        self.text = message.text.format(detail)
        super().__init__(self.text)


class SourceError(OpenacrError):
    """Something wrong in a file: where it stands, what it is and how to mend it."""

    def __init__(
        self,
        text: str,
        *,
        path: str = "",
        line: int = 0,
        column: int = 0,
        hint: str = "",
    ) -> None:
        self.text, self.path, self.line, self.column, self.hint = text, path, line, column, hint
        self.errors: tuple[SourceError, ...] = (self,)
        super().__init__(text)

    def __str__(self) -> str:
        parts = [self.path] if self.path else []
        parts += [str(number) for number in (self.line, self.column) if number]
        place = ":".join(parts)
        sentence = f"{place}: {self.text}" if place else self.text
        return f"{sentence} ({self.hint})" if self.hint else sentence


class FaultyFileError(SourceError):
    """Everything wrong in a file, in the order of its lines; place and text are of the first."""

    def __init__(self, errors: Iterable[SourceError]) -> None:
        found = tuple(sorted(errors, key=lambda each: (each.line, each.column)))
        first = found[0]
        super().__init__(
            first.text, path=first.path, line=first.line, column=first.column, hint=first.hint
        )
        self.errors = found

    def __str__(self) -> str:
        return "\n".join(map(str, self.errors))


class MapError(OpenacrError):
    """A parameter or flag that does not exist, is read-only or of another kind."""


class UserError(OpenacrError):
    """A wrong option, a missing file, a port in use: bad input at the command line."""


class NoFreeStreamError(OpenacrError):
    """All streams of the card are taken."""


class StoreError(OpenacrError):
    """A snapshot or stored image that cannot be used here."""


# files of users


def read_bytes(path: Path) -> bytes:
    """The bytes of a file the user named, or a sentence why not."""
    try:
        return path.read_bytes()
    except OSError as failure:
        raise unreadable(path, failure) from None


def unreadable(path: Path, failure: OSError) -> UserError:
    """Why a file or folder the user named cannot be read."""
    return UserError(f"{path}: cannot be read: {reason(failure).lower()}")


def unwritable(path: Path, failure: OSError) -> UserError:
    """Why a file or folder the user named cannot be written."""
    return UserError(f"{path}: cannot be written: {reason(failure).lower()}")
