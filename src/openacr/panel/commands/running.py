"""Commands of part programs: load, start, hold, retrace, answer; overrides and alarms."""

from typing import Annotated, Literal

from msgspec import Meta

from openacr.errors import UserError
from openacr.mill.card.alarms import (
    DRIVE_FAULT,
    EMERGENCY_STOP,
    EXCESS_ERROR,
    HARDWARE_LIMIT,
    Alarm,
)
from openacr.mill.config.communications import Line
from openacr.mill.config.dialects import dialect_of
from openacr.mill.config.folders import folders_of
from openacr.mill.config.overrides import Override
from openacr.mill.run.dripping import Drip
from openacr.mill.run.lifecycle import State
from openacr.mill.session import MillSession, Start
from openacr.panel.commands.registry import command
from openacr.panel.control.machine.installation import Installation
from openacr.panel.control.machine.link import Link
from openacr.panel.control.operator.hand_motion import HandMotion
from openacr.panel.control.operator.orders import LATER, Later, Order
from openacr.panel.control.operator.part import Part
from openacr.panel.control.operator.presses import End
from openacr.panel.control.operator.typed import Typed
from openacr.panel.control.station import Station
from openacr.panel.control.stopping import Stopping
from openacr.panel.files import Folder
from openacr.panel.helps import Page
from openacr.panel.library import ready
from openacr.panel.roles import Role

PARTS = ".parts"  # folder of library parts that were made, inside that of programs
# What ends the cause of an alarm that stays; {} is its axis.
MENDS = {
    EMERGENCY_STOP: "release the emergency stop",
    EXCESS_ERROR: "its drive has to be on (DRIVE ON {0}); REN {0} takes its position over",
    DRIVE_FAULT: "the drive itself has to be reset",
    HARDWARE_LIMIT: "it has to leave its limit switch",
}
Finite = Annotated[float, Meta(ge=-1e12, le=1e12)]
DialectName = Literal["", "auto", "acromill", "rs274ngc"]


# --- loading --------------------------------------------------------------------------


@command(
    "program.load",
    page=Page(
        "load",
        "LOAD PROG",
        "USER FILE: a program of the folder. LIBRARY PART: a part with sizes to choose. DXF FILE: a"
        " drawing that is converted to a program, cut at the Z that is asked for. BATCH FILE: a"
        " list of programs, run one after the other. RS232 DRIP FEED: a program that runs"
        " while it arrives over a serial line. RS-232 (LINK): a program that arrives over a serial"
        " line is kept as a file, then loaded like any other.",
        de=(
            "LADEN",
            "DATEI: ein Programm des Ordners. TEILEBIBLIOTHEK: ein Teil, dessen Maße"
            " gewählt werden. DXF: eine Zeichnung, die in ein Programm umgewandelt wird,"
            " geschnitten auf dem Z, das verlangt wird. STAPEL: eine Liste von"
            " Programmen, die nacheinander laufen. SERIELL: ein Programm, das läuft,"
            " während es über eine serielle Leitung ankommt. RS-232 (LINK): Ein Programm,"
            " das über eine serielle Leitung ankommt, wird als Datei behalten und dann"
            " wie jedes andere geladen.",
        ),
    ),
)
def load(
    order: Order,
    installation: Installation,
    part: Part,
    *,
    path: str,
    dialect: DialectName = "",
) -> Later:
    """LOAD PROG: make a file of the folder the program that START starts."""
    file = Folder(installation.programs).file(path)
    part.load(file, path, order, kind="file", dialect=dialect)
    return LATER


@command("program.batch")
def batch(
    order: Order,
    installation: Installation,
    part: Part,
    *,
    path: str,
    dialect: DialectName = "",
) -> Later:
    """Load all programs of a batch file, which run one after the other."""
    folder = Folder(installation.programs)
    part.load_batch(folder.file(path), order, folder.path_of)
    return LATER


@command("program.part")
def library_part(
    station: Station,
    order: Order,
    installation: Installation,
    *,
    part: str,
    values: dict[str, Finite] | None = None,
    tool: Annotated[int, Meta(ge=0, le=400)] = 0,
) -> Later:
    """LIBRARY PART: make a part with these sizes the program that START starts.

    `values` are the sizes by cell; those that are not given have their defaults.
    """
    station.part.require_free()
    made = ready(part, values or {}, installation.store, tool)
    folder = installation.programs / PARTS
    file = folder / f"{made.part.name}.nc"
    try:
        folder.mkdir(exist_ok=True)
        file.write_text(made.program, encoding="utf-8", newline="\n")
    except OSError as error:
        raise UserError(f"{file.name} cannot be stored: {error.strerror}") from None
    station.part.load(file, made.part.name, order, kind="part", dialect="acromill")
    return LATER


@command("program.drip", is_motion=True)
def drip(
    link: Link,
    installation: Installation,
    part: Part,
    *,
    port: str = "",
    dialect: DialectName = "",
    dry: bool = False,
) -> None:
    """RS232 DRIP FEED: run a program while it arrives over a serial line.

    Without a port over that of the COMMUNICATIONS page.
    """
    part.require_free()
    session = link.machine
    session.runner.alarms.require_none()
    name = dialect_of(None, session.cells, dialect or None)
    folder = installation.store.path.parent if installation.store.path else None
    line = Line.of(session.cells, port)
    made = Drip(line, session.cells, name, is_dry=dry, folders=folders_of(session.cells, folder))
    session.keep_drip(made)
    session.start_drip(made, Start(dialect=name, is_dry=dry))


@command("program.close")
def close(part: Part) -> None:
    """Unload the program."""
    part.close()


# --- running --------------------------------------------------------------------------


@command(
    "run.begin",
    is_motion=True,
    en="START",
    de="START",
    page=Page(
        "run",
        "RUN PROG",
        "RUN starts the loaded program at a line. At a later line than 1 the lines before it are"
        " read without motion: what differs is shown and confirmed; then Z goes up, the axes go"
        " over the place and down at feed.\n\nSTOP holds the feed. START continues after a stop of"
        " the program, and where a tool is asked for once it is in the spindle. DRY RUN moves"
        " at Trial Speed, M codes have no effect. BLOCK stops after"
        " every block.",
        de=(
            "PROGRAMM",
            "AB ZEILE startet das geladene Programm bei einer Zeile. Bei einer späteren"
            " Zeile als 1 werden die Zeilen davor ohne Bewegung gelesen: Was sich"
            " unterscheidet, wird gezeigt und bestätigt; dann fährt Z hoch, die Achsen"
            " über die Stelle und mit Vorschub hinunter.\n\nSTOP hält den Vorschub an."
            " START geht nach einem Halt des Programms weiter, und wo ein Werkzeug"
            " verlangt wird, sobald es in der Spindel ist. PROBELAUF fährt mit Trial"
            " Speed, M-Funktionen wirken nicht. EINZELSATZ hält nach jedem Satz.",
        ),
    ),
)
def begin(
    order: Order,
    hand_motion: HandMotion,
    typed: Typed,
    part: Part,
    *,
    line: Annotated[int, Meta(ge=1, le=10**9)] = 1,
    dry: bool = False,
    skip: bool | None = None,
    optional: bool | None = None,
    any_tool: bool = False,
    safe_z: Finite | None = None,
    confirm: str = "",
) -> dict[str, object] | Later:
    """RUN: start the loaded program; a later line is rehearsed first and confirmed then.

    `confirm` is the token of the rehearsal.
    """
    if skip is not None:
        part.is_skipping = skip
    if optional is not None:
        part.stops_optionally = optional
    start = Start(
        dialect=part.required.dialect,
        line=line,
        is_dry=dry,
        is_single=part.is_single,
        is_skipping=part.is_skipping,
        stops_optionally=part.stops_optionally,
        accepts_tool=any_tool,
        safe_z=safe_z,
    )
    hand_motion.presses.end_all(End.MODE, "a program was started")
    if line > 1 and not confirm:
        part.rehearse(start, order)
        return LATER
    typed.drop()
    part.begin(start, confirm)
    return {}


@command("run.start", is_motion=True)
def start(machine: MillSession) -> None:
    """START: go on from a stop or a feed hold."""
    machine.runner.start()


@command("run.resume", is_motion=True)
def resume(link: Link, stopping: Stopping) -> None:
    """RESUME: go on with the path where it was held, and with what STOP has held on the card."""
    session = link.session
    is_held = stopping.holds
    if not is_held or (session and session.runner.state in (State.PAUSED, State.HOLD)):
        link.machine.runner.resume()
    if is_held:
        stopping.resume()


@command("run.abort")
def abort(link: Link, typed: Typed) -> None:
    """ABORT: end the program; START begins it again."""
    typed.drop()
    link.machine.runner.abort()


@command("run.block")
def block(link: Link, part: Part, *, on: bool) -> None:
    """BLOCK: stop after every block, or not."""
    part.is_single = on
    link.machine.runner.block(on)


@command("run.skip", en="Block skip", de="Sätze ausblenden")
def skip(link: Link, part: Part, *, on: bool) -> None:
    """Leave blocks with a slash out, or not."""
    part.is_skipping = on
    link.machine.runner.stream.host.skips_always = on


@command("run.optional", en="Optional stop", de="Wahlweiser Halt")
def optional(link: Link, part: Part, *, on: bool) -> None:
    """Stop at M1, or not."""
    part.stops_optionally = on
    link.machine.runner.stop_optionally(on)


@command("run.trace", is_motion=True)
def trace(machine: MillSession, *, direction: Literal[-1, 0, 1]) -> None:
    """Trace the path in a feed hold: back (-1), forward (1), or rest (0)."""
    machine.runner.trace(direction)


@command("run.answer", is_motion=True)
def answer(machine: MillSession, *, value: Finite) -> None:
    """Answer the question of a program."""
    machine.runner.answer(value)


@command("run.confirm", is_motion=True)
def confirm(machine: MillSession) -> None:
    """Say that the tool is changed."""
    changer = machine.runner.entry_actions.changer
    if not changer.wants_confirmation:
        raise UserError("no tool change waits")
    changer.confirm()


# --- overrides and alarms -------------------------------------------------------------

OVERRIDES = {"feed": Override.FEED, "rapid": Override.RAPID, "spindle": Override.SPINDLE}


@command(
    "override.choose",
    page=Page(
        "overrides",
        "OVERRIDES",
        "Feed, rapid and spindle speed in 16 clicks of their table (SYS PARAM). Where a switch of"
        " the panel is wired, the switch counts and the screen only shows it.",
        de=(
            "OVERRIDES",
            "Vorschub, Eilgang und Spindeldrehzahl in 16 Rasten ihrer Tabelle"
            " (SYSTEMPARAM). Wo ein Schalter des Bedienpults verdrahtet ist, gilt der"
            " Schalter, und der Bildschirm zeigt ihn nur.",
        ),
    ),
)
def override(
    machine: MillSession,
    *,
    which: Literal["feed", "rapid", "spindle"],
    click: Annotated[int, Meta(ge=0, le=15)],
) -> None:
    """Choose a click of an override."""
    machine.runner.overrides.choose(OVERRIDES[which], click)


@command(
    "alarm.acknowledge",
    Role.OPERATE,
    en="ACKNOWLEDGE",
    de="QUITTIEREN",
    page=Page(
        "alarms",
        "ALARMS",
        "An alarm stays until its cause is gone and it was acknowledged; nothing starts before.",
        de=(
            "ALARME",
            "Ein Alarm bleibt, bis seine Ursache weg ist und er quittiert wurde; vorher"
            " startet nichts.",
        ),
    ),
)
def acknowledge(machine: MillSession) -> dict[str, list[str]]:
    """Clear the alarms whose cause is gone; those that stay, with what ends their cause."""
    left = machine.runner.acknowledge()
    return {"left": [_with_mend(alarm) for alarm in left]}


def _with_mend(alarm: Alarm) -> str:
    """An alarm that stays, and what ends its cause."""
    mend = MENDS.get(alarm.kind, "")
    return f"{alarm.text}: {mend.format(alarm.detail)}" if mend else alarm.text
