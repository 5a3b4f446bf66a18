"""Find out what a user handed over: a project folder or one controller file.

Everything is checked before anything starts: a missing, unreadable, empty or binary file
is reported with its place, and no controller exists until the whole project is readable.
"""

import codecs
import re
from collections.abc import Iterable, Iterator, Mapping
from enum import Enum
from functools import lru_cache
from pathlib import Path

from msgspec import Struct, field

from openacr.errors import SourceError, UserError, read_bytes, unreadable

PROGRAM_COUNT = 16
PLC_COUNT = 8
PART_PROGRAM_SHARE = 4  # at least one line in this many is a block of G or M codes

_NOTHING: Mapping[Path, bytes] = {}
_NUMBERED = re.compile(r"(prog|plc)(\d+)\.8k", re.IGNORECASE)
_BLOCK = re.compile(r"(?:N\d+\s*)?[GM]\d+(?:\.\d)?(?![A-Za-z0-9]*\s*=)", re.IGNORECASE)
# Text files hold these control characters: tab, line feed, form feed, carriage return, the
# end-of-file mark of old editors, and escape (which terminals send and captures contain).
_TEXT_CONTROLS = frozenset(b"\t\n\x0c\r\x1a\x1b")
# Single bytes are read as the typographic characters of the Windows code page; the five
# holes of that code page become the control characters of the same number.
_SINGLE_BYTES = {
    byte: bytes([byte]).decode("cp1252", errors="ignore") or chr(byte) for byte in range(128, 256)
}


class Place(Enum):
    """What a controller file is for."""

    SETUP = "setup"
    PROGRAM = "prog"
    PLC = "plc"


def _one_single_byte(error: UnicodeError) -> tuple[str, int]:
    """Decode only the byte at which UTF-8 failed; decoding continues with the bytes after it."""
    if not isinstance(error, UnicodeDecodeError):
        raise error
    return _SINGLE_BYTES[error.object[error.start]], error.start + 1


codecs.register_error("openacr-single-byte", _one_single_byte)


def decode(data: bytes) -> str:
    """Turn controller text into characters: UTF-8 where it is valid, else byte by byte."""
    return data.decode("utf-8", errors="openacr-single-byte").removeprefix("\ufeff")


class SourceFile(Struct, frozen=True):
    """One controller file: where it is, what it is for and the bytes it holds."""

    path: Path
    data: bytes
    place: Place = Place.SETUP
    number: int = 0

    @property
    def text(self) -> str:
        """The file as characters, typographic ones still in place."""
        return decode(self.data)


class Project(Struct, frozen=True):
    """The files of one machine, all read and known to be text."""

    root: Path
    setup: SourceFile | None = None
    programs: tuple[SourceFile, ...] = ()
    plcs: tuple[SourceFile, ...] = ()
    machine: Path | None = None
    scenario: Path | None = None
    ignored: tuple[Path, ...] = field(default=())

    @property
    def fingerprint(self) -> str:
        """The identity of a project: all its files except the scenario."""
        from hashlib import blake2b  # OpenSSL: 2 ms of a start

        found = blake2b(digest_size=16)
        machine = [read_bytes(self.machine)] if self.machine else []
        for data in [*machine, *(source.data for source in self.sources)]:
            found.update(len(data).to_bytes(8, "little") + data)
        return found.hexdigest()

    @property
    def sources(self) -> tuple[SourceFile, ...]:
        """The controller files in the order in which they are loaded."""
        return ((self.setup,) if self.setup else ()) + self.plcs + self.programs


def find_project(path: Path | str, unsaved: Mapping[Path, bytes] = _NOTHING) -> Project:
    """Read the project folder or the single controller file at `path`.

    `unsaved` are controller files as an editor holds them, which need not exist.
    """
    place = Path(path)
    if is_folder(place, unsaved):
        return _folder(place, unsaved)
    if not place.exists() and place not in unsaved:
        raise UserError(f"{place}: no such file or folder")
    if place.suffix.lower() == ".toml":
        raise UserError(f"{place}: give the project folder {place.parent}, not a file inside it")
    source = read_source(place, unsaved=unsaved)
    _refuse_part_program(source)
    return Project(place, source)


def is_folder(place: Path, unsaved: Mapping[Path, bytes] = _NOTHING) -> bool:
    """Whether a path is a folder, be it one of files that only an editor holds."""
    return place.is_dir() or any(each.parent == place for each in unsaved)


def _refuse_part_program(source: SourceFile) -> None:
    """Refuse a file most of whose lines are blocks of G and M codes, and name who reads it."""
    if source.path.suffix.lower() == ".8k":
        return
    lines = [line.strip() for line in source.text.splitlines()]
    blocks = [line for line in lines if _BLOCK.match(line)]
    if len(blocks) * PART_PROGRAM_SHARE >= sum(map(bool, lines)):
        raise SourceError(
            f"a part program, not a controller file: {blocks[0][:40]}",
            path=str(source.path),
            line=lines.index(blocks[0]) + 1,
            hint=f"`openacr mill check {source.path}` reads it",
        )


def read_source(
    path: Path,
    place: Place = Place.SETUP,
    number: int = 0,
    unsaved: Mapping[Path, bytes] = _NOTHING,
) -> SourceFile:
    """Read one controller file; a file that is empty or not text is refused."""
    data = unsaved[path] if path in unsaved else read_bytes(path)
    require_text(path, data)
    if not data.strip(b" \t\r\n\x1a"):
        raise SourceError("the file is empty", path=str(path))
    return SourceFile(path, data, place, number)


def place_of(path: Path) -> tuple[Place, int]:
    """Say what a file is for by its name: progN.8k and plcN.8k, else set-up."""
    match = _NUMBERED.fullmatch(path.name)
    return (Place(match[1].lower()), int(match[2])) if match else (Place.SETUP, 0)


@lru_cache
def _binary(controls: bytes) -> re.Pattern[bytes]:
    """What no text file holds; `controls`: further characters that may be there."""
    refused = set(range(32)) - _TEXT_CONTROLS | {0x7F}
    return re.compile(b"[" + re.escape(bytes(refused - set(controls))) + b"]")


def require_text(
    path: Path, data: bytes, *, controls: bytes = b"", what: str = "controller files"
) -> None:
    """Refuse data that is not text; `controls`: further characters allowed in such files."""
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        hint = "save it as UTF-8 or plain text"
        raise SourceError("the file is UTF-16", path=str(path), line=1, column=1, hint=hint)
    found = _binary(controls).search(data)
    if found is None:
        return
    at = found.start()
    line_start = data.rfind(b"\n", 0, at) + 1
    raise SourceError(
        f"not a text file: byte 0x{data[at]:02X} at offset {at}",
        path=str(path),
        line=data.count(b"\n", 0, at) + 1,
        column=at - line_start + 1,
        hint=f"{what} are plain text",
    )


def _folder(root: Path, unsaved: Mapping[Path, bytes]) -> Project:
    try:
        found = {entry for entry in root.iterdir() if entry.is_file()} if root.is_dir() else set()
    except OSError as error:
        raise unreadable(root, error) from None
    entries = sorted(found.union(path for path in unsaved if path.parent == root))
    by_name = _by_name(entries)
    numbered = list(_numbered(entries))
    setup = by_name.get("setup.8k")
    if setup is None and not numbered and "machine.toml" not in by_name:
        raise UserError(
            f"{root}: not an openacr project: it holds none of machine.toml, setup.8k, "
            f"prog0.8k .. prog{PROGRAM_COUNT - 1}.8k, plc0.8k .. plc{PLC_COUNT - 1}.8k"
        )
    used = {setup, *(path for path, _, _ in numbered)}
    return Project(
        root=root,
        setup=read_source(setup, unsaved=unsaved) if setup else None,
        programs=_read(numbered, Place.PROGRAM, unsaved),
        plcs=_read(numbered, Place.PLC, unsaved),
        machine=by_name.get("machine.toml"),
        scenario=by_name.get("scenario.toml"),
        ignored=tuple(e for e in entries if e.suffix.lower() == ".8k" and e not in used),
    )


def _by_name(entries: Iterable[Path]) -> dict[str, Path]:
    """Index the entries by lower-case name: controller files come from systems without case."""
    found: dict[str, Path] = {}
    for entry in entries:
        other = found.setdefault(entry.name.lower(), entry)
        if other is not entry:
            raise UserError(f"{entry}: {other.name} in the same folder is the same file; keep one")
    return found


def _numbered(entries: Iterable[Path]) -> Iterator[tuple[Path, Place, int]]:
    """Program and PLC files with their numbers; a number the card does not have is refused."""
    seen: dict[tuple[Place, int], Path] = {}
    for entry in entries:
        match = _NUMBERED.fullmatch(entry.name)
        if match is None:
            continue
        place, number = Place(match[1].lower()), int(match[2])
        count = PROGRAM_COUNT if place is Place.PROGRAM else PLC_COUNT
        if number >= count:
            raise UserError(
                f"{entry}: there is no {place.value.upper()}{number}; "
                f"the files are {place.value}0.8k .. {place.value}{count - 1}.8k"
            )
        other = seen.setdefault((place, number), entry)
        if other is not entry:
            raise UserError(f"{entry}: {other.name} already is {place.value.upper()}{number}")
        yield entry, place, number


def _read(
    numbered: Iterable[tuple[Path, Place, int]], place: Place, unsaved: Mapping[Path, bytes]
) -> tuple[SourceFile, ...]:
    chosen = sorted((n, path) for path, kind, n in numbered if kind is place)
    return tuple(read_source(path, place, number, unsaved) for number, path in chosen)
