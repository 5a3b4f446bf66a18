"""Findings of an editor's text, what changes it, and places where a name stands."""

from pathlib import Path
from typing import NamedTuple

from msgspec import Struct

from openacr.editing.document import Edit, Span


class Location(NamedTuple):
    """A span of a file."""

    path: Path
    span: Span


class Fix(NamedTuple):
    """A change that may mend what was found."""

    title: str
    edit: Edit


class Finding(Struct, frozen=True):
    """What is wrong at a place; a warning is something that is accepted."""

    span: Span
    message: str
    hint: str = ""
    code: str = ""
    is_warning: bool = False
    fix: Fix | None = None

    @property
    def text(self) -> str:
        """Message and hint, as the command line prints them."""
        return f"{self.message} ({self.hint})" if self.hint else self.message
