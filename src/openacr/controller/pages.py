"""What notebooks show of a card: the moment, its axes and its programs."""

from __future__ import annotations

from collections.abc import Iterable
from html import escape
from typing import TYPE_CHECKING

from openacr.map.rows import programs as program_rows
from openacr.map.words import pf, plf
from openacr.wording import counted

if TYPE_CHECKING:
    from openacr.controller.controller import Controller

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


def card_page(card: Controller) -> str:
    """Model and time of a card, its motors, and each program and PLC that is stored."""
    return (
        f"<p>{escape(card.model.name)}: {card.time_s:g} s since power-up,"
        f" {counted(card.tick, 'servo period')}</p>"
        + table(AXES, _axes(card))
        + table(PROGRAMS, _programs(card))
    )


def _axes(card: Controller) -> Iterable[Row]:
    for motor in card.world.axis:
        axis = card.axis(motor.number)
        reals = (f"{axis.commanded_u:.6g}", f"{axis.actual_u:.6g}")
        yield (motor.number, motor.name, motor.units, *reals, axis.following_error)


def _programs(card: Controller) -> Iterable[Row]:
    read, is_empty = card.memory.read, card.system.programs.is_empty
    for number, word in enumerate(pf.word):
        if not is_empty(number):
            runs = int(read(word)) & pf.PROGRAM_RUNNING
            line = int(read(program_rows.line_number[number]))
            yield (f"PROG{number}", "running" if runs else "halted", line if runs else "")
    for number, word in enumerate(plf.word):
        if not is_empty(len(pf.word) + number):
            runs = int(read(word)) & plf.PLC_RUNNING
            yield (f"PLC{number}", "running" if runs else "halted", "")
