"""The virtual mill that `openacr panel` brings along: its world, settings and sample parts."""

import shutil
from pathlib import Path

from openacr.controller import Controller
from openacr.panel.control.installation import Installation
from openacr.sysvar import Store
from openacr.sysvar.exchange import imported

FOLDER = Path(__file__).parent
SAMPLE = "plate.nc"


def embedded(
    data: Path, *, store: Path | None = None, programs: Path | None = None
) -> Installation:
    """The virtual mill; `data` is the folder of its store and programs, filled when it is new."""
    data.mkdir(parents=True, exist_ok=True)
    programs = programs or data / "programs"
    if not programs.exists():
        shutil.copytree(FOLDER / "programs", programs)
    cells = opened(store or data / "sysvar.db")
    controller = Controller.from_project(FOLDER)
    controller.is_journalled = False  # it may run for months
    sample = SAMPLE if (programs / SAMPLE).is_file() else ""
    return Installation.inside(controller, cells, programs, name="virtual mill", sample=sample)


def opened(path: Path) -> Store:
    """The store of the virtual mill; a new one gets its settings."""
    is_new = not path.exists()
    store = Store(path, is_metric=True)
    if is_new:
        text = (FOLDER / "settings.toml").read_text("utf-8")
        try:
            imported(store, text, "settings.toml")
        except BaseException:
            store.close()
            path.unlink(missing_ok=True)
            raise
    return store
