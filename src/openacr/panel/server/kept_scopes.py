"""Set-ups and references of the scope under names: small text files that all browsers share."""

import os
import re
from collections.abc import Iterator
from datetime import datetime
from pathlib import Path
from typing import Annotated, Any, Literal, TypeAlias

import msgspec
from msgspec import Meta, Struct

from openacr.errors import UserError
from openacr.panel.control.operator.orders import PanelError

Kind: TypeAlias = Literal["setup", "reference"]
FOLDER = "scope"
MOST = 64  # of each kind
MOST_BYTES = 4 << 20  # of one
CHANNELS = 9  # the computed one is the last
SAMPLES = 100_000  # of a trace
NAME = re.compile(r"[^\W_][\w .,+-]{0,59}")
WHAT = {"setup": "set-up", "reference": "reference"}

Text = Annotated[str, Meta(max_length=200)]
Finite = Annotated[float, Meta(ge=-1e300, le=1e300)]
Above = Annotated[float, Meta(gt=0.0, le=1e9)]


class Channel(Struct, forbid_unknown_fields=True):
    """The fields of a channel, as they are typed."""

    source: Text
    color: Annotated[str, Meta(pattern="^#[0-9a-fA-F]{6}$")]
    scale: Text
    offset: Text
    unit: Text
    format: Text


class Setup(Struct, forbid_unknown_fields=True):
    """A set-up: channels, the computed one last, and settings by their names."""

    channels: Annotated[list[Channel], Meta(min_length=1, max_length=CHANNELS)]
    settings: Annotated[dict[Text, Text], Meta(max_length=40)]


class Trace(Struct, forbid_unknown_fields=True):
    """A trace of a reference; a missing sample is null."""

    label: Text
    id: Text
    name: Text
    unit: Text
    format: Text
    color: Annotated[str, Meta(pattern="^#[0-9a-fA-F]{6}$")]
    isFlag: bool  # noqa: N815
    scale: Finite
    offset: Finite
    values: Annotated[list[Finite | None], Meta(max_length=SAMPLES)]


class Reference(Struct, forbid_unknown_fields=True):
    """Traces with s between two samples, ms of the first one and of the left edge."""

    traces: Annotated[list[Trace], Meta(min_length=1, max_length=CHANNELS)]
    period: Above
    start: Finite
    from_: Finite = msgspec.field(name="from")


KINDS: dict[str, type[Struct]] = {"setup": Setup, "reference": Reference}


class ScopeFiles:
    """The set-ups and references in a folder, which is made for the first one."""

    def __init__(self, root: Path) -> None:
        self._folder = root / FOLDER

    def entries(self) -> list[dict[str, Any]]:
        """All of them by name: kind, name, bytes, time of the last change."""
        found = []
        for kind in WHAT:
            for file in self._files(kind):
                stat = file.stat()
                changed = datetime.fromtimestamp(stat.st_mtime).astimezone()
                name = file.name.removesuffix(_suffix(kind))
                found.append(
                    {
                        "kind": kind,
                        "name": name,
                        "bytes": stat.st_size,
                        "changed": changed.isoformat(timespec="seconds"),
                    }
                )
        return sorted(found, key=lambda each: (each["kind"], str(each["name"]).casefold()))

    def read(self, kind: Kind, name: str) -> bytes:
        """The text of one; PanelError for a name that is not there, UserError for another text."""
        file = self._existing(kind, name)
        if file.stat().st_size > MOST_BYTES:
            raise UserError(f"{name} has more than {MOST_BYTES} bytes: it is no {WHAT[kind]}")
        return checked(kind, file.read_bytes(), name)

    def store(self, kind: Kind, name: str, text: bytes, *, replace: bool) -> None:
        """Keep one under a name; PanelError where it is taken.

        UserError for another text, a name that is not allowed, and one too many.
        """
        content = checked(kind, text, name)
        file = self._at(kind, name)
        if not file.exists():
            if sum(1 for _ in self._files(kind)) >= MOST:
                raise UserError(f"there are {MOST} of the kind {WHAT[kind]}: delete one first")
        elif not replace:
            raise PanelError("conflict", f"the {WHAT[kind]} {name} is there already")
        partial = file.with_suffix(".partial")
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
            partial.write_bytes(content)
            os.replace(partial, file)
        except OSError as error:
            raise UserError(f"{name} cannot be stored: {error.strerror}") from None

    def rename(self, kind: Kind, name: str, to: str) -> None:
        """Give one another name; PanelError where that is taken."""
        file, target = self._existing(kind, name), self._at(kind, to)
        if target.exists() and not target.samefile(file):
            raise PanelError("conflict", f"the {WHAT[kind]} {to} is there already")
        file.rename(target)

    def delete(self, kind: Kind, name: str) -> None:
        """Delete one; PanelError for a name that is not there."""
        self._existing(kind, name).unlink()

    def _files(self, kind: str) -> Iterator[Path]:
        return self._folder.glob(f"*{_suffix(kind)}")

    def _at(self, kind: Kind, name: str) -> Path:
        if NAME.fullmatch(name) is None or name != name.strip(" .") or len(name.encode()) > 120:
            raise UserError(
                f"{name[:60]!r} is no name: up to 60 letters, digits, spaces and . , + - _ after a"
                " letter or digit"
            )
        return self._folder / f"{name}{_suffix(kind)}"

    def _existing(self, kind: Kind, name: str) -> Path:
        file = self._at(kind, name)
        if not file.is_file():
            raise PanelError("missing", f"there is no {WHAT[kind]} {name}")
        return file


def _suffix(kind: str) -> str:
    return f".{kind}.json"


def checked(kind: Kind, text: bytes, name: str) -> bytes:
    """A set-up or reference in the form in which it is kept; UserError for any other text."""
    try:
        found = msgspec.json.decode(text, type=KINDS[kind])
    except (ValueError, RecursionError) as error:
        raise UserError(f"{name} is no {WHAT[kind]} of the scope: {error}") from None
    return msgspec.json.format(msgspec.json.encode(found), indent=1 if kind == "setup" else -1)
