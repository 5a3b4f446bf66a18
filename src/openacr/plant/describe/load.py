"""Read a `machine.toml`; errors give the line, the value and the permitted values."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from openacr.plant.describe import locate, toml_file
from openacr.plant.describe.check import contradictions
from openacr.plant.describe.check_bodies import file_faults
from openacr.plant.describe.complaint import Complaint
from openacr.plant.describe.explaining import explain, not_finite
from openacr.plant.describe.schema import World


def load_world(path: Path | str) -> World:
    """Read the machine described by the file at `path`."""
    place = Path(path)
    text = toml_file.read_text(place)
    world = parse_world(text, str(place))
    _refuse(text, str(place), file_faults(world, place.parent))
    return world


def parse_world(text: str, path: str = "machine.toml") -> World:
    """Read the machine described by `text`; SourceError with all errors found.

    Contradictions between values are checked only once every single value is valid.
    """
    world, complaints = build_world(toml_file.parse(text, path))
    _refuse(text, path, complaints)
    if world is None:
        raise toml_file.wrong(text, path, (), "it describes no machine")
    return world


def build_world(raw: dict[str, Any]) -> tuple[World | None, list[Complaint]]:
    """The machine of the tables of a file, with everything that is wrong with them."""
    world, messages = toml_file.convert_all(raw, World)
    complaints = list(not_finite(raw))
    seen = {each.path for each in complaints}
    found = (explain(message, raw, World) for message in messages)
    complaints += [each for each in found if not any(_holds(each.path, path) for path in seen)]
    if world is not None and not complaints:
        complaints = list(contradictions(world))
    return world, complaints


def _refuse(text: str, path: str, found: Iterable[Complaint]) -> None:
    toml_file.refuse(toml_file.wrong(text, path, each.path, each.text, each.hint) for each in found)


def _holds(path: locate.Path, inner: locate.Path) -> bool:
    return inner[: len(path)] == path
