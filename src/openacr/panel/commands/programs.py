"""Commands for the programs and PLCs of the card: run, halt, step, listen, send, clear."""

import re
from concurrent.futures import Future
from typing import Annotated, Any

from msgspec import Meta

from openacr.client import Level
from openacr.client.effects import Op
from openacr.client.program_states import HALTED, PLCS, PROGRAMS
from openacr.client.program_variables import answer, assign
from openacr.client.stored import clear, replace, require_program
from openacr.client.talk import Talk
from openacr.client.transfer import download
from openacr.errors import UserError
from openacr.mill.session import MillSession
from openacr.panel.commands.registry import command
from openacr.panel.control.engineer.card_programs import read_states
from openacr.panel.control.engineer.on_card import OnCard
from openacr.panel.control.operator.orders import LATER, Later, Order, answer_with
from openacr.panel.control.station import Station
from openacr.panel.helps import Page
from openacr.panel.roles import Role

Program = Annotated[int, Meta(ge=0, lt=len(PROGRAMS))]
Plc = Annotated[int, Meta(ge=0, lt=len(PLCS))]
Parked = Annotated[str, Meta(max_length=40)]
ATTACHES = re.compile(r"^\s*(\d+\s+)?(ATTACH|DETACH|CONFIG|CLEAR)\b", re.I | re.M)
MOST_TEXT = 60_000  # characters; a message of the socket has at most 64 KiB


def level_of(program: int | None, plc: int | None) -> Level:
    """A program or a PLC by its number; UserError unless exactly one is named."""
    if (program is None) == (plc is None):
        raise UserError("name a program or a PLC")
    return Level.program(program) if program is not None else Level.plc(plc or 0)


def owner_of(station: Station, level: Level) -> str:
    """Why a program is not for the screens now; empty if it is."""
    if station.link.is_away:
        return station.link.lost
    session = station.link.required
    settings = session.runner.settings
    if not session.is_set_up:
        return ""
    if level == Level.program(settings.watchdog_program):
        return f"{level} of the card belongs to this machine"
    if level == Level.program(settings.master) and session.runner.is_busy:
        return (
            f"{level} of the card is used by this machine now (state"
            f" {session.runner.state.name}): ABORT, or wait until it has ended"
        )
    return ""


def _take(station: Station, level: Level) -> None:
    """Take a program from AcroMill, which needs it and its axes: `card.setup` gives it back."""
    session = station.link.required
    if session.is_set_up and level == Level.program(session.runner.settings.master):
        station.hand_over(f"{level} is an ordinary program of the card now")


def required(station: Station, program: int | None, plc: int | None) -> Level:
    """The program or PLC that is meant; UserError for one that this machine needs."""
    level = level_of(program, plc)
    if owner := owner_of(station, level):
        raise UserError(owner)
    return level


def _require_rest(station: Station, level: Level, what: str) -> None:
    """Refuse while this machine moves; a program also while an alarm bars every start."""
    runner = station.link.required.runner
    if station.interlocks.is_moved:
        raise UserError(f"the machine moves: {what}")
    if level.word == "PROG":
        runner.alarms.require_none()


def begin(station: Station, word: str, level: Level) -> None:
    """Give a program a command that may begin motion; UserError where none may begin."""
    _require_rest(station, level, "no program of the card is started")
    _take(station, level)
    station.on_card.programs.command(station.link.required, word, level)


def _require_halted(station: Station, level: Level) -> None:
    _require_rest(station, Level.plc(0), "no program of the card is changed")
    read = station.link.required.machine.read_rows
    states = {state["name"]: state["state"] for state in read_states(read)}
    if states[str(level)] != HALTED:
        raise UserError(f"{level} runs: halt it first")
    _take(station, level)


# --- running --------------------------------------------------------------------------


@command(
    "card.run",
    Role.SERVICE,
    is_motion=True,
    page=Page(
        "programs",
        "PROGRAM/PLC",
        "The programs and PLCs of the card: what each does, and its text with the line that is"
        " executed. RUN starts one, HALT ends it and its motion, PAUSE holds it until RESUME."
        " With BLOCK a program waits before every line for STEP. LISTEN shows what it prints.\n\n"
        "EDIT changes the text: numbered lines, or the text between PROGRAM and ENDP; SEND stores"
        " it on the card and compares the listing. What the card refuses leaves the former text."
        " ESAVE keeps programs without power. CLEAR erases the lines. Programs that this machine"
        " needs, one that runs, and all of them while the machine moves cannot be changed.\n\n"
        "STOP pauses programs of the card, also those that no screen has started. They know no"
        " limits and overrides of this machine: only service personnel should start one. PROG0 and"
        " its axes are taken from AcroMill where it is started or changed here: SET UP at the top"
        " gives them back.\n\nThe tab PLC draws"
        " a PLC as a ladder. Closed contacts and outputs that are set are filled; wires that carry"
        " power are thick. The flags are read ten times a second: a pulse of one scan is not seen.",
        de=(
            "PROGRAMM/SPS",
            "Die Programme und SPS-Programme der Karte: was jedes tut, und sein Text mit"
            " der Zeile, die ausgeführt wird. START startet eines, HALT beendet es und"
            " seine Bewegung, PAUSE hält es an, WEITER geht weiter. Mit EINZEL wartet ein"
            " Programm vor jeder Zeile auf SCHRITT. MITHÖREN zeigt, was es"
            " ausgibt.\n\nÄNDERN ändert den Text: nummerierte Zeilen oder den Text zwischen"
            " PROGRAM und ENDP; SENDEN speichert ihn auf der Karte und vergleicht die"
            " Auflistung. Was die Karte ablehnt, lässt den früheren Text bestehen. ESAVE"
            " behält Programme ohne Strom. LÖSCHEN löscht die Zeilen. Programme, die"
            " diese Maschine braucht, eines, das läuft, und alle, solange sich die"
            " Maschine bewegt, können nicht geändert werden.\n\nSTOP hält Programme der"
            " Karte an, auch solche, die kein Bildschirm gestartet hat. Sie kennen keine"
            " Grenzen und Overrides dieser Maschine: Nur Servicepersonal sollte eines"
            " starten. PROG0 und seine Achsen werden AcroMill genommen, wenn es hier"
            " gestartet oder geändert wird: EINRICHTEN oben gibt sie zurück.\n\nDer Reiter"
            " SPS zeichnet ein SPS-Programm als Kontaktplan. Geschlossene Kontakte und"
            " gesetzte Ausgänge sind gefüllt; Leitungen mit Strom sind dick. Die Merker"
            " werden zehnmal je Sekunde gelesen: Einen Impuls von einem Umlauf sieht man"
            " nicht.",
        ),
    ),
)
def run(station: Station, *, program: Program | None = None, plc: Plc | None = None) -> None:
    """Start a program or a PLC of the card."""
    begin(station, "RUN", required(station, program, plc))


@command("card.resume", Role.SERVICE, is_motion=True)
def resume(station: Station, *, program: Program | None = None, plc: Plc | None = None) -> None:
    """Go on where PAUSE has held a program."""
    begin(station, "RESUME", required(station, program, plc))


@command("card.step", Role.SERVICE, is_motion=True)
def step(station: Station, *, program: Program | None = None, plc: Plc | None = None) -> None:
    """Carry out one line of a program in block mode."""
    begin(station, "STEP", required(station, program, plc))


@command("card.block", Role.SERVICE, is_motion=True)
def block(
    station: Station, *, program: Program | None = None, plc: Plc | None = None, on: bool = True
) -> None:
    """Let a program wait for STEP before every line (BLK), or go on by itself (AUT)."""
    level = required(station, program, plc)
    if on:
        station.on_card.programs.command(station.link.required, "BLK", level)
    else:
        begin(station, "AUT", level)


@command("card.pause", Role.SERVICE)
def pause(station: Station, *, program: Program | None = None, plc: Plc | None = None) -> None:
    """Hold a program and its motion."""
    station.on_card.programs.command(
        station.link.required, "PAUSE", required(station, program, plc)
    )


@command("card.halt", Role.SERVICE)
def halt(station: Station, *, program: Program | None = None, plc: Plc | None = None) -> None:
    """End a program or a PLC of the card, and the motion of its master."""
    level = required(station, program, plc)
    station.on_card.programs.command(station.link.required, "HALT", level)


# --- listening ------------------------------------------------------------------------


@command("card.listen", Role.VIEW, needs_control=False)
def listen(client: int, on_card: OnCard, *, program: Program) -> None:
    """Show what a program prints from now on, as events `listen`; a serial card cannot."""
    on_card.listening.begin(client, program)


@command("card.unlisten", Role.VIEW, needs_control=False)
def unlisten(client: int, on_card: OnCard, *, program: Program) -> None:
    """Listen no more; the program goes on."""
    on_card.listening.forget(client)


@command("card.assign", Role.SERVICE, is_motion=True)
def assign_variable(
    station: Station,
    order: Order,
    *,
    program: Program,
    name: Annotated[str, Meta(pattern=r"^((LV|SV|DV|\$V)\d+|(LA|SA|DA|\$A)\d+\(\d+\))$")],
    value: Annotated[str, Meta(min_length=1, max_length=80, pattern=r"^[ -~]*$")],
) -> Later:
    """Change a variable of a program, as its prompt would."""
    level = Level.program(program)
    if owner := owner_of(station, level):
        raise UserError(owner)

    def talks(talk: Talk) -> Op[str]:
        yield from assign(talk, program, name, value)
        return (yield from answer(talk, program, name))

    answer_with(order, station.on_card.aside.begin(talks), lambda text: {"value": text})
    return LATER


# --- texts ----------------------------------------------------------------------------


@command("card.send", Role.SERVICE)
def send(
    station: Station,
    order: Order,
    *,
    program: Program | None = None,
    plc: Plc | None = None,
    text: Annotated[str, Meta(max_length=MOST_TEXT)] = "",
    parked: Parked = "",
    version: Annotated[str, Meta(max_length=40)] = "",
) -> Later:
    """Store a text as a program or PLC of the card, verified; refused, the old one stays.

    Between PROGRAM and ENDP, or in numbered lines; `parked`: the mark of a text that was handed
    over before. `version` is that of the listing it was made of; empty: whatever is there is
    replaced. Nothing is run, and nothing saved by ESAVE.
    """
    level = required(station, program, plc)
    wanted = station.on_card.parked.text(parked) if parked else text
    require_program(wanted)
    _require_halted(station, level)
    future = station.on_card.aside.begin(lambda talk: replace(talk, level, wanted, version))
    _then_tell(station, future, str(level))
    answer_with(order, future, lambda report: {"name": str(level), "sent": report.sent})
    return LATER


@command("card.download", Role.SERVICE, is_motion=True)
def download_file(station: Station, order: Order, session: MillSession, *, parked: Parked) -> Later:
    """Send a controller file to the card line by line, and compare what it stores.

    Lines outside of programs are carried out. The error of a line that is refused names it.
    """
    text = station.on_card.parked.text(parked)
    _require_rest(station, Level.program(0), "no file is sent to the card")
    running = [
        each["name"]
        for each in read_states(station.link.read)
        if each["state"] != HALTED and not owner_of(station, Level.of_line(each["name"]) or Level())
    ]
    if running:
        raise UserError(f"{', '.join(running)} run: halt them first")
    if session.is_set_up and ATTACHES.search(text):
        station.hand_over("a file that attaches axes was sent to the card")
    future = station.on_card.aside.begin(lambda talk: download(talk, text))
    _then_tell(station, future, "")
    answer_with(
        order,
        future,
        lambda report: {"sent": report.sent, "remarks": [[r.line, r.text] for r in report.remarks]},
    )
    return LATER


@command("card.clear", Role.SERVICE)
def erase(
    station: Station, order: Order, *, program: Program | None = None, plc: Plc | None = None
) -> Later:
    """Erase the lines of a program or PLC of the card; its memory stays."""
    level = required(station, program, plc)
    _require_halted(station, level)
    future = station.on_card.aside.begin(lambda talk: clear(talk, level))
    _then_tell(station, future, str(level))
    answer_with(order, future, lambda _none: None)
    return LATER


def _then_tell(station: Station, future: "Future[Any]", name: str) -> None:
    """Tell all screens of a text that was stored, or stored again where it was refused."""
    future.add_done_callback(lambda _done: station.on_card.programs.texts_changed(name))
