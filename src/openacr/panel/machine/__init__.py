"""The virtual mill that `openacr panel` brings along: its world, settings and sample parts."""

import shutil
from pathlib import Path

from openacr.controller import Controller
from openacr.panel.control.machine.installation import Installation
from openacr.starter.folders import ensure, make_whole
from openacr.sysvar import Store
from openacr.sysvar.exchange import begun

FOLDER = Path(__file__).parent
SAMPLE = "plate.nc"


def embedded(
    data: Path, *, store: Path | None = None, programs: Path | None = None
) -> Installation:
    """The virtual mill; `data` is the folder of its store and programs, filled when it is new."""
    ensure(data)
    programs = programs or data / "programs"
    store = store or data / "sysvar.db"
    if not programs.exists():
        ensure(programs.parent)
        make_whole(programs, _fill)
    elif not store.exists() and not any(programs.iterdir()):
        _fill(programs)  # a project or a card was opened before, and has made the folder
    cells = opened(store)
    controller = Controller.from_project(FOLDER)
    controller.is_journalled = False  # it may run for months
    sample = SAMPLE if (programs / SAMPLE).is_file() else ""
    return Installation.inside(controller, cells, programs, name="virtual mill", sample=sample)


def _fill(programs: Path) -> None:
    """Copy the sample parts."""
    for sample in (FOLDER / "programs").iterdir():
        shutil.copyfile(sample, programs / sample.name)


def opened(path: Path) -> Store:
    """The store of the virtual mill; a new one gets its settings."""
    return begun(path, FOLDER / "settings.toml")
