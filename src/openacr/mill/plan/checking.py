"""What `openacr mill check` finds: a program read once, its moves checked against the machine."""

from pathlib import Path

from openacr.cnc.interpreter.interpreter import Options
from openacr.cnc.interpreter.survey import Survey, survey
from openacr.cnc.loading.load import load
from openacr.cnc.program.program import Program
from openacr.cnc.reading.findings import Finding
from openacr.cnc.state.hosts import VirtualMachine
from openacr.mill.config.curves import can_plan
from openacr.mill.config.dialects import choose_for
from openacr.mill.config.folders import folders_of
from openacr.mill.config.settings import NONE, Settings
from openacr.mill.plan.forecast import Desk, Forecast
from openacr.mill.plan.predicting import Prediction, Predictor, Reader
from openacr.mill.plan.preflight import Preflight
from openacr.sysvar import Store


def check_text(text: str, path: Path, cells: Store, dialect: str | None = None) -> list[Finding]:
    """Everything `openacr mill check` would find in a text that is to be the file `path`.

    Included files are looked for in the folder of `path`. The dialect is chosen as for a file.
    """
    name = choose_for(text.encode("utf-8", "surrogateescape"), cells, dialect).name
    folder = cells.path.parent if cells.path else None
    places = folders_of(cells, folder)
    program = load(text, cells, name, places, name=path.name, folder=path.parent)
    return checked(program, cells, name)[0].findings


def checked(program: Program, cells: Store, dialect: str) -> tuple[Survey, Prediction]:
    """Read a program once, and check its moves against the machine of the store."""
    preflight = Preflight(Settings(cells))
    found, prediction = surveyed(program, cells, dialect, is_dry=False, desk=preflight)
    found.add(preflight.findings(program.text_of))
    return found, prediction


def surveyed(
    program: Program,
    cells: Store,
    dialect: str,
    *,
    is_dry: bool,
    rounds: bool = True,
    reader: Reader | None = None,
    desk: Desk | None = None,
) -> tuple[Survey, Prediction]:
    """Read a program once, for the survey and for its time."""
    settings = Settings(cells)
    begin = (0.0,) * 8
    predictor: Predictor | Forecast = Forecast(
        settings, begin, is_dry=is_dry, rounds=rounds, desk=desk
    )
    if reader is not None or can_plan(settings):  # every move is read, or curves are planned
        either = reader or (desk if isinstance(desk, Preflight) else None)
        predictor = Predictor(settings, begin, is_dry=is_dry, rounds=rounds, reader=either)
    machine = VirtualMachine(is_probed=settings.wiring.probe != NONE)
    found = survey(program, cells, dialect, Options(is_dry=is_dry), machine, predictor.add)
    predictor.close()
    return found, predictor.found
