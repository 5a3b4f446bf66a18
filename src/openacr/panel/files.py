"""The folder of part programs: names from browsers stay inside it."""

from datetime import datetime
from pathlib import Path
from typing import Any

from openacr.errors import UserError

KINDS = {".dxf": "dxf", ".bat": "batch", ".lst": "batch"}
PROGRAMS = frozenset({".nc", ".txt", ".ngc", ".tap", ".cnc", ".gcode", ".g", ".mpf", ""})
RESERVED = frozenset('<>:"|?*\\')
MOST_PATH_BYTES = 1000  # of a path within the folder: below what every system takes
REPLACEMENT = "\N{REPLACEMENT CHARACTER}"


class Folder:
    """A folder whose files are named by paths like `jobs/flange.nc`."""

    def __init__(self, root: Path) -> None:
        self.root = root

    def at(self, path: str) -> Path:
        """The place of a path, whether something is there or not; UserError outside the folder."""
        if len(path.encode()) > MOST_PATH_BYTES:
            raise UserError(f"{path[:40]}...: a path has at most {MOST_PATH_BYTES} bytes")
        parts = [part for part in path.split("/") if part]
        for part in parts:
            if part in (".", "..") or part.startswith(".") or not part.isprintable():
                raise UserError(f"{path}: this name is not allowed")
            if RESERVED & set(part) or len(part.encode()) > 200:
                raise UserError(f"{path}: this name is not allowed")
        place = self.root.joinpath(*parts)
        root = self.root.resolve()
        if not place.resolve().is_relative_to(root):  # a link that leads out of it
            raise UserError(f"{path}: it is outside the folder of programs")
        return place

    def file(self, path: str) -> Path:
        """An existing file; UserError if there is none."""
        place = self.at(path)
        if place.is_dir():
            raise UserError(f"{path}: it is a folder, not a part program")
        if not place.is_file():
            if REPLACEMENT in path:
                raise UserError(f"{path}: this name is not UTF-8: rename the file on the computer")
            raise UserError(f"{path}: no such file")
        return place

    def path_of(self, file: Path) -> str:
        """The path of a file inside; UserError for one outside."""
        try:
            return file.resolve().relative_to(self.root.resolve()).as_posix()
        except ValueError:
            raise UserError(f"{file.name}: it is outside the folder of programs") from None

    def entries(self, path: str) -> list[dict[str, Any]]:
        """What is in a folder; hidden names are left out."""
        place = self.at(path)
        if not place.is_dir():
            raise UserError(f"{path}: no such folder")
        try:
            found = sorted(place.iterdir(), key=lambda each: (each.is_file(), each.name.lower()))
        except OSError as error:
            raise UserError(f"{path}: cannot be read: {(error.strerror or '').lower()}") from None
        return [self._entry(each) for each in found if not each.name.startswith(".")]

    def _entry(self, place: Path) -> dict[str, Any]:
        try:
            stat = place.stat()
            size, changed_s = stat.st_size, stat.st_mtime
        except OSError:  # a link that leads nowhere
            size, changed_s = 0, 0.0
        changed = datetime.fromtimestamp(changed_s).astimezone()
        return {
            "name": _shown(place.name),
            "path": _shown(place.relative_to(self.root).as_posix()),
            "kind": kind_of(place),
            "bytes": size,
            "changed": changed.isoformat(timespec="seconds"),
        }


def _shown(name: str) -> str:
    """A name as browsers can be given it: bytes that are not UTF-8 are replaced."""
    return name.encode("utf-8", "surrogateescape").decode("utf-8", "replace")


def kind_of(place: Path) -> str:
    """What a file is, by its suffix."""
    if place.is_dir():
        return "folder"
    suffix = place.suffix.lower()
    return KINDS.get(suffix) or ("program" if suffix in PROGRAMS else "other")
