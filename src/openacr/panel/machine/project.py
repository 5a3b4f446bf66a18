"""The machine of a project, with its own settings and part programs where it has some."""

from pathlib import Path

from openacr.controller import Controller
from openacr.panel.control.machine.installation import Installation
from openacr.starter.folders import ensure
from openacr.sysvar import Store
from openacr.sysvar.exchange import begun
from openacr.sysvar.location import open_to_write


def of_project(
    project: Path, *, store: Path | None, programs: Path | None, otherwise: Path
) -> Installation:
    """The machine of a project; `otherwise` are the part programs where it has no folder of them.

    Its store is the named one, else its own, which begins with the settings of the project; else
    that of the user.
    """
    own = project / "programs"
    folder = programs or (own if own.is_dir() else otherwise)
    ensure(folder)
    cells = _store(project) if store is None else open_to_write(store)
    try:
        controller = Controller.from_project(project)
    except BaseException:
        cells.close()
        raise
    controller.is_journalled = False  # it may run for months
    name = project.resolve().name
    return Installation.inside(
        controller, cells, folder, kind="project", name=name, project=project
    )


def _store(project: Path) -> Store:
    kept, settings = project / "sysvar.db", project / "settings.toml"
    if settings.is_file():
        return begun(kept, settings)
    return open_to_write(kept if kept.is_file() else None)
