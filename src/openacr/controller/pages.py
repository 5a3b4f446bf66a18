"""What notebooks show of a card: the moment, its axes and its programs."""

from __future__ import annotations

from collections.abc import Iterable
from html import escape

from openacr.basic.execute.system import System
from openacr.controller.views import AxisView
from openacr.map.rows import programs as program_rows
from openacr.map.words import pf, plf
from openacr.motion.card import Card
from openacr.plant.describe.schema import World
from openacr.wording import counted

AXES = ("axis", "name", "units", "commanded", "actual", "following error [pulses]")
PROGRAMS = ("program", "state", "line")
Row = Iterable[object]


def table(titles: Row, rows: Iterable[Row]) -> str:
    """A table of HTML: its titles, then its rows."""
    head = "".join(f"<th>{escape(str(title))}</th>" for title in titles)
    body = "".join(
        "<tr>" + "".join(f"<td>{escape(str(cell))}</td>" for cell in row) + "</tr>" for row in rows
    )
    return f"<table><tr>{head}</tr>{body}</table>"


def card_page(system: System, world: World) -> str:
    """Model and time of a card, its motors, and each program and PLC that is stored."""
    card = system.card
    return (
        f"<p>{escape(card.model.name)}: {card.clock.time_s:g} s since power-up,"
        f" {counted(card.clock.tick, 'servo period')}</p>"
        + table(AXES, _axes(card, world))
        + table(PROGRAMS, _programs(system))
    )


def _axes(card: Card, world: World) -> Iterable[Row]:
    for motor in world.axis:
        axis = AxisView(card, motor.number)
        reals = (f"{axis.commanded_u:.6g}", f"{axis.actual_u:.6g}")
        yield (motor.number, motor.name, motor.units, *reals, axis.following_error)


def _programs(system: System) -> Iterable[Row]:
    read, is_empty = system.card.memory.read, system.programs.is_empty
    for number, word in enumerate(pf.word):
        if not is_empty(number):
            runs = int(read(word)) & pf.PROGRAM_RUNNING
            line = int(read(program_rows.line_number[number]))
            yield (f"PROG{number}", "running" if runs else "halted", line if runs else "")
    for number, word in enumerate(plf.word):
        if not is_empty(len(pf.word) + number):
            runs = int(read(word)) & plf.PLC_RUNNING
            yield (f"PLC{number}", "running" if runs else "halted", "")
