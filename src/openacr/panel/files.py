"""The folder of part programs: names from browsers stay inside it."""

from pathlib import Path

from openacr.errors import UserError

RESERVED = frozenset('<>:"|?*\\')


class Folder:
    """A folder whose files are named by paths like `jobs/flange.nc`."""

    def __init__(self, root: Path) -> None:
        self.root = root

    def at(self, path: str) -> Path:
        """The place of a path, whether something is there or not; UserError outside the folder."""
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
            raise UserError(f"{path}: no such file")
        return place

    def path_of(self, file: Path) -> str:
        """The path of a file inside; UserError for one outside."""
        try:
            return file.resolve().relative_to(self.root.resolve()).as_posix()
        except ValueError:
            raise UserError(f"{file.name}: it is outside the folder of programs") from None
