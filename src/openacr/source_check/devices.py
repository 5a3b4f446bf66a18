"""Python files with devices of a machine: read, and not executed."""

import ast
from collections.abc import Iterator
from pathlib import Path

from openacr.errors import OpenacrError, reason
from openacr.plant.describe.load import load_world
from openacr.plant.devices.kinds import is_own
from openacr.project import Project
from openacr.source_check.faults import Fault


def device_faults(project: Project) -> Iterator[Fault]:
    """The faults of the files that a machine file names, if it can be read itself."""
    if project.machine is None:
        return
    try:
        kinds = sorted({each.kind for each in load_world(project.machine).device})
    except OpenacrError:
        return  # reported with the machine file
    for kind in filter(is_own, kinds):
        file, _, name = kind.rpartition(":")
        yield from _faults(project.machine.parent / file, name)


def _faults(path: Path, name: str) -> Iterator[Fault]:
    """Why a file has no class of this name that Python could execute."""
    try:
        tree = ast.parse(path.read_bytes(), str(path))
        compile(tree, path, "exec")
    except OSError as failure:
        yield Fault(str(path), 1, 1, 1, f"cannot be read: {reason(failure).lower()}", "", "")
    except SyntaxError as error:
        line, text = error.lineno or 1, (error.text or "").rstrip()
        yield Fault(str(path), line, error.offset or 1, 1, error.msg, "", text)
    except ValueError as error:  # a null byte
        yield Fault(str(path), 1, 1, 1, str(error), "", "")
    else:
        if not any(isinstance(each, ast.ClassDef) and each.name == name for each in ast.walk(tree)):
            yield Fault(str(path), 1, 1, 1, f"there is no class {name}", "", "")
