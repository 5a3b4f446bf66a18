"""What `openacr mill check` finds: a program read once, its moves checked against the machine."""

from collections.abc import Callable
from pathlib import Path

from openacr.cnc.canonical import Entry
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
from openacr.mill.plan.predicting import Prediction, Predictor, Reader, Timing
from openacr.mill.plan.preflight import Preflight
from openacr.sysvar import Store

BEGIN = (0.0,) * 8


def check_text(text: str, path: Path, cells: Store, dialect: str | None = None) -> list[Finding]:
    """Everything `openacr mill check` would find in a text that is to be the file `path`.

    Included files are looked for in the folder of `path`. The dialect is chosen as for a file.
    """
    name = choose_for(text.encode("utf-8", "surrogateescape"), cells, dialect).name
    folder = cells.path.parent if cells.path else None
    places = folders_of(cells, folder)
    program = load(text, cells, name, places, name=path.name, folder=path.parent)
    return checked(program, cells, name)[0].findings


def surveyed(
    program: Program,
    cells: Store,
    dialect: str,
    *,
    options: Options | None = None,
    rounds: bool = True,
    reader: Reader | None = None,
    desk: Desk | None = None,
    look: Callable[[Entry], None] | None = None,
) -> tuple[Survey, Prediction]:
    """Read a program; `reader` gets every move as it is planned, `desk` those that may be refused.

    `look` gets every canonical entry; `rounds`: as on the virtual machine, which supports path
    tolerances.
    """
    options = options or Options()
    settings = Settings(cells)
    timing: Forecast | Predictor
    if reader is not None or can_plan(settings):  # every move is read, or curves are planned
        either = reader or (desk if isinstance(desk, Preflight) else None)
        timing = Predictor(settings, BEGIN, is_dry=options.is_dry, rounds=rounds, reader=either)
    else:
        timing = Forecast(settings, BEGIN, is_dry=options.is_dry, rounds=rounds, desk=desk)
    machine = VirtualMachine(is_probed=settings.wiring.probe != NONE)
    found = survey(program, cells, dialect, options, machine, _both(timing, look))
    timing.close()
    return found, timing.found


def checked(
    program: Program,
    cells: Store,
    dialect: str,
    *,
    options: Options | None = None,
    rounds: bool = True,
    look: Callable[[Entry], None] | None = None,
) -> tuple[Survey, Prediction]:
    """Read a program, with findings about moves that the machine refuses or makes slower."""
    preflight = Preflight(Settings(cells))
    found, prediction = surveyed(
        program, cells, dialect, options=options, rounds=rounds, desk=preflight, look=look
    )
    found.add(preflight.findings(program.text_of))
    return found, prediction


def _both(timing: Timing, look: Callable[[Entry], None] | None) -> Callable[[Entry], None]:
    if look is None:
        return timing.add

    def add(entry: Entry) -> None:
        timing.add(entry)
        look(entry)

    return add
