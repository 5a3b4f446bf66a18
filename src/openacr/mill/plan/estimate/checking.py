"""What `openacr mill check` finds: a program read once, its moves checked against the machine."""

import math
from collections.abc import Callable
from pathlib import Path

from msgspec import Struct

from openacr.cnc.canonical import Entry
from openacr.cnc.interpreter.interpreter import Options
from openacr.cnc.interpreter.survey import Survey, survey
from openacr.cnc.loading.load import load
from openacr.cnc.program.program import Program
from openacr.cnc.reading.findings import Finding
from openacr.cnc.state.hosts import VirtualMachine
from openacr.errors import OpenacrError, UserError, unreadable
from openacr.mill.config.curves import can_plan
from openacr.mill.config.dialects import Choice, choose, choose_for
from openacr.mill.config.folders import folders_of
from openacr.mill.config.settings import NONE, Settings
from openacr.mill.plan.estimate.forecast import Desk, Forecast
from openacr.mill.plan.estimate.predicting import Prediction, Predictor, Reader
from openacr.mill.plan.estimate.preflight import Preflight
from openacr.project import require_text
from openacr.sysvar import Store

BEGIN = (0.0,) * 8
BEGINNING_BYTES = 65536  # examined to tell text from other files
TAPE_CONTROLS = b"\x00\x0b\x11\x12\x13\x14\x7f"  # leader, reader and punch, rubout


class TooLongError(OpenacrError):
    """A program that takes more machine time than it may."""


def opened(file: Path, cells: Store, dialect: str | None = None) -> tuple[Program, Choice]:
    """Load the program in a file with its macros; UserError for a file that cannot be read."""
    require_file(file)
    choice = choose(file, cells, dialect)
    folder = cells.path.parent if cells.path else None
    return load(file, cells, choice.name, folders_of(cells, folder)), choice


def require_file(file: Path) -> None:
    """Refuse a part program that cannot be read."""
    if file.is_dir():
        raise UserError(f"{file}: this is a folder, not a part program")
    if not file.exists():
        raise UserError(f"{file}: no such file")
    try:
        with file.open("rb") as opened:
            beginning = opened.read(BEGINNING_BYTES)
    except OSError as error:
        raise unreadable(file, error) from None
    require_text(file, beginning, controls=TAPE_CONTROLS, what="part programs")


def check_text(text: str, path: Path, cells: Store, dialect: str | None = None) -> list[Finding]:
    """Everything `openacr mill check` would find in a text that is to be the file `path`.

    Included files are looked for in the folder of `path`. The dialect is chosen as for a file.
    """
    name = choose_for(text.encode("utf-8", "surrogateescape"), cells, dialect).name
    folder = cells.path.parent if cells.path else None
    places = folders_of(cells, folder)
    program = load(text, cells, name, places, name=path.name, folder=path.parent)
    return checked(program, cells, name)[0].findings


class Watchers(Struct, frozen=True):
    """Who gets what while a program is read."""

    reader: Reader | None = None  # every move as it is planned
    desk: Desk | None = None  # the moves that may be refused
    look: Callable[[Entry], None] | None = None  # every canonical entry
    progress: Callable[[int], None] | None = None  # the line of every move that is planned


def surveyed(
    program: Program,
    cells: Store,
    dialect: str,
    watchers: Watchers | None = None,
    *,
    options: Options | None = None,
    rounds: bool = True,
    limit_s: float = math.inf,
) -> tuple[Survey, Prediction]:
    """Read a program; TooLongError as soon as it takes more than `limit_s` of machine time.

    `rounds`: as on the virtual machine, which supports path tolerances.
    """
    options, who = options or Options(), watchers or Watchers()
    settings = Settings(cells)
    timing: Forecast | Predictor
    if who.reader is not None or can_plan(settings):  # every move is read, or curves are planned
        reader = who.reader or (who.desk if isinstance(who.desk, Preflight) else None)
        timing = Predictor(
            settings, BEGIN, is_dry=options.is_dry, rounds=rounds, reader=reader,
            progress=who.progress,
        )  # fmt: skip
    else:
        timing = Forecast(settings, BEGIN, is_dry=options.is_dry, rounds=rounds, desk=who.desk)
    machine = VirtualMachine(is_probed=settings.wiring.probe != NONE)
    found = survey(program, cells, dialect, options, machine, _both(timing, who.look, limit_s))
    timing.close()
    return found, timing.found


def estimated(
    program: Program, cells: Store, dialect: str, *, options: Options | None = None
) -> float | None:
    """The time of a program without the jerk and the tolerance of its path [s], known at once.

    None where it takes no planning of paths, or has errors.
    """
    settings = Settings(cells)
    if program.errors or not can_plan(settings):
        return None
    options = options or Options()
    timing = Forecast(settings, BEGIN, is_dry=options.is_dry)
    machine = VirtualMachine(is_probed=settings.wiring.probe != NONE)
    found = survey(program, cells, dialect, options, machine, timing.add)
    timing.close()
    return None if found.errors else timing.found.time_s


def checked(
    program: Program,
    cells: Store,
    dialect: str,
    *,
    options: Options | None = None,
    rounds: bool = True,
    look: Callable[[Entry], None] | None = None,
    progress: Callable[[int], None] | None = None,
    limit_s: float = math.inf,
) -> tuple[Survey, Prediction]:
    """Read a program, with findings about moves that the machine refuses or makes slower."""
    preflight = Preflight(Settings(cells))
    watchers = Watchers(desk=preflight, look=look, progress=progress)
    found, prediction = surveyed(
        program, cells, dialect, watchers, options=options, rounds=rounds, limit_s=limit_s
    )
    found.add(preflight.findings(program.text_of))
    return found, prediction


def _both(
    timing: Forecast | Predictor, look: Callable[[Entry], None] | None, limit_s: float
) -> Callable[[Entry], None]:
    if look is None and limit_s == math.inf:
        return timing.add

    def add(entry: Entry) -> None:
        timing.add(entry)
        if look is not None:
            look(entry)
        if timing.found.time_s > limit_s:
            raise TooLongError(f"it takes more than {limit_s:g} s of machine time")

    return add
