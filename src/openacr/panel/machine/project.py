"""The machine of a project, with its own settings and part programs where it has some."""

from dataclasses import dataclass
from pathlib import Path

from openacr.controller import Controller
from openacr.panel.control.machine.installation import Installation
from openacr.panel.control.machine.pace import OwnTime
from openacr.panel.machine.served import ServedCard
from openacr.starter.folders import ensure
from openacr.sysvar import Store
from openacr.sysvar.exchange import begun
from openacr.sysvar.location import open_to_write


@dataclass(frozen=True, slots=True)
class OnBus:
    """That the bus of a machine is opened: at which interface, and how."""

    interface: str | None = None  # None: as the file says
    is_real: bool = False
    is_real_time: bool = False  # its frames are exchanged by the compiled loop


def of_project(
    project: Path,
    *,
    store: Path | None,
    programs: Path | None,
    otherwise: Path,
    bus: OnBus | None = None,
) -> Installation:
    """The machine of a project; `otherwise` are the part programs where it has no folder of them.

    Its store is the named one, else its own, which begins with the settings of the project; else
    that of the user. With `bus` its card is served by a process of its own.
    """
    own = project / "programs"
    folder = programs or (own if own.is_dir() else otherwise)
    ensure(folder)
    cells = _store(project) if store is None else open_to_write(store)
    name = project.resolve().name
    try:
        if bus is not None:
            card = ServedCard(
                project, bus.interface, is_real=bus.is_real, is_real_time=bus.is_real_time
            )
            return Installation(
                "project", name, card.address, cells, folder, OwnTime(),
                project=project, bus=card, is_agreed=True,
            )  # fmt: skip
        controller = Controller.from_project(project)
    except BaseException:
        cells.close()
        raise
    controller.is_journalled = False  # it may run for months
    return Installation.inside(
        controller, cells, folder, kind="project", name=name, project=project
    )


def _store(project: Path) -> Store:
    kept, settings = project / "sysvar.db", project / "settings.toml"
    if settings.is_file():
        return begun(kept, settings)
    return open_to_write(kept if kept.is_file() else None)
