"""Serves the requests of all axes, one exchange after the other on each line.

An exchange takes as long as its characters on the line, and a pause in which the drive
thinks. A drive that does not answer costs a second. The axes of a line take turns.
"""

from __future__ import annotations

from collections.abc import Callable

from openacr.map import numbers as at
from openacr.map.memory import Memory
from openacr.map.rows import bus_drives, drive_talk, drive_talk_axes, drive_talk_lines, networks
from openacr.map.words import dtcf, dtsf
from openacr.network.drivetalk.lines import TalkLine, line_of, lines, pending
from openacr.network.drivetalk.real import RealDrives
from openacr.network.drivetalk.requests import ARIES_TYPE, Exchange, address, exchanges
from openacr.network.times import later_tk, tick_of
from openacr.plant.bus import aries, rs485
from openacr.plant.bus.aries_port import split_address

TIMEOUT_MS = 1000.0
THINKING_MS = 2.0
LOOK_MS = 50.0
PASSED_ON = -1  # instead of a request: a line a terminal has typed
WAITING = -1  # instead of a number of answers: a real drive is listened to
POLL_MS = 1.0
NO_ANSWER: list[str] = []

Deliver = Callable[[int, str], None]  # channel, text


def attend(memory: Memory, deliver: Deliver, real: RealDrives | None = None) -> None:
    """Do everything that is due on all lines."""
    for line in lines(memory, real):
        _address_all(line)
        if line.is_open:
            _serve(line, deliver)
        _address_all(line)
    for axis in range(drive_talk.COUNT):
        _give_up(memory, axis)
    _look_for_errors(memory)


def next_tk(memory: Memory) -> float:
    """The tick at which something is due; 0 if nothing is."""
    times = [line.due_tk for line in lines(memory)]
    times += [memory.F[_limit(axis)] for axis in range(drive_talk.COUNT)]
    times.append(memory.F[_LOOK])
    return min((time for time in times if time), default=0.0)


# requests


def _address_all(line: TalkLine) -> None:
    """Auto Address All: ask it of every axis of the line; done when all have been served."""
    flag, word = dtsf.AUTO_ADDRESS_ALL, at.W_DTALK_LPT1 + line.port
    if not line.memory.I[word] & flag:
        return
    axes, request = list(line.axes()), dtcf.AUTO_ADDRESS_REQUEST
    if not line.get(drive_talk_lines.addressing) and axes:
        line.put(drive_talk_lines.addressing, 1)
        for axis in axes:
            line.memory.I[dtcf.word[axis]] |= request
    elif not any(pending(line.memory, axis) & request for axis in axes):
        line.put(drive_talk_lines.addressing, 0)
        line.memory.I[word] &= ~flag


def _serve(line: TalkLine, deliver: Deliver) -> None:
    """Finish the exchange in progress if it is over, then begin the next one."""
    if line.due_tk and line.due_tk <= tick_of(line.memory):
        line.due_tk = 0.0
        if line.get(drive_talk_lines.answers) == WAITING and not _receive(line):
            return
        _finish(line, deliver)
    while not line.due_tk and _begin(line):
        pass


def _begin(line: TalkLine) -> bool:
    """Begin an exchange of the current request, or of the next; False if there is none."""
    if line.get(drive_talk_lines.request):
        return _begin_exchange(line)
    if line.get(drive_talk_lines.channel):
        return _pass_on(line)
    last = line.get(drive_talk_lines.axis)
    axes = list(line.axes())
    for axis in [*(n for n in axes if n > last), *(n for n in axes if n <= last)]:
        if requests := pending(line.memory, axis):
            line.put(drive_talk_lines.axis, axis)
            line.put(drive_talk_lines.request, requests & -requests)  # the lowest first
            line.put(drive_talk_lines.selection, line.memory.I[dtcf.word[axis]])
            line.put(drive_talk_lines.exchange, 0)
            return True
    return False


def _begin_exchange(line: TalkLine) -> bool:
    axis = line.get(drive_talk_lines.axis)
    if line.memory.I[drive_talk.drive_type[axis]] != ARIES_TYPE:
        line.flag(dtsf.STREAM_ADDRESS_ERROR)  # a drive with an unknown protocol
        _end(line)
    elif (exchange := _exchange(line)) is None:
        _end(line)
    else:
        _send(line, exchange.text, axis if exchange.on_connector else None)
    return True


def _exchange(line: TalkLine) -> Exchange | None:
    """The exchange that is next, or in progress."""
    rows = (drive_talk_lines.axis, drive_talk_lines.request, drive_talk_lines.selection)
    todo = exchanges(line.memory, *(line.get(row) for row in rows))
    place = line.get(drive_talk_lines.exchange)
    return todo[place] if place < len(todo) else None


def _pass_on(line: TalkLine) -> bool:
    """Send a line that a terminal has typed; the card puts the address in front."""
    typed = line.text(drive_talk_lines.typed, drive_talk_lines.typed_count)
    text, end, rest = typed.partition("\r")
    if not end:
        return False
    line.put_text(drive_talk_lines.typed, drive_talk_lines.typed_count, rest)
    if not text.strip():
        return True
    line.put(drive_talk_lines.request, PASSED_ON)
    given, _ = split_address(text)
    _send(
        line,
        text if given is not None else f"{address(line.get(drive_talk_lines.talks_to))}_{text}",
    )
    return True


# exchanges


def _send(line: TalkLine, text: str, alone: int | None = None) -> None:
    """Send a line; of a modelled drive what comes back is known, and when all of it has come.

    `alone`: on the connector of that axis.
    """
    baud, bits = max(line.get(drive_talk_lines.baud), 1), line.get(drive_talk_lines.character_bits)
    if line.real is not None and line.real.begin(
        line.port, _axis(line), text, baud=baud, bits=bits, alone=alone is not None
    ):
        line.put(drive_talk_lines.answers, WAITING)
        line.due_tk = later_tk(line.memory, POLL_MS)
        return
    answers = rs485.exchange(line.memory, line.port, baud, bits, text, alone)
    length = _take(line, answers)
    on_the_line_ms = 1000.0 * bits * (len(text) + 1 + length) / baud
    line.due_tk = later_tk(line.memory, on_the_line_ms + THINKING_MS if answers else TIMEOUT_MS)


def _receive(line: TalkLine) -> bool:
    """Look for the answer of a real drive; False while it is waited for."""
    answers = NO_ANSWER if line.real is None else line.real.answers(_axis(line))
    if answers is None:
        line.due_tk = later_tk(line.memory, POLL_MS)
        return False
    _take(line, answers)
    return True


def _take(line: TalkLine, answers: list[str]) -> int:
    """Keep what has been answered; how long the text of the one drive is that has."""
    answer = answers[0] if len(answers) == 1 else ""
    line.put(drive_talk_lines.answers, len(answers))
    line.put_text(drive_talk_lines.answer, drive_talk_lines.length, answer)
    return len(answer)


def _axis(line: TalkLine) -> int:
    """The axis whose drive is being talked to."""
    is_passed_on = line.get(drive_talk_lines.request) == PASSED_ON
    return line.get(drive_talk_lines.talks_to if is_passed_on else drive_talk_lines.axis)


def _finish(line: TalkLine, deliver: Deliver) -> None:
    """Use the answer, or report why there is none."""
    is_passed_on, axis = line.get(drive_talk_lines.request) == PASSED_ON, _axis(line)
    text = line.text(drive_talk_lines.answer, drive_talk_lines.length)
    is_answered = _judge(line, axis)
    if is_passed_on:
        line.put(drive_talk_lines.request, 0)
        if line.get(drive_talk_lines.channel):
            deliver(line.get(drive_talk_lines.channel) - 1, text)
    elif not is_answered or not pending(line.memory, axis) & line.get(drive_talk_lines.request):
        _end(line)
    else:
        exchange = _exchange(line)
        if exchange is not None and not exchange.take(text) and exchange.text.endswith("ADDR"):
            line.flag(dtsf.STREAM_ADDRESS_ERROR)
        line.put(drive_talk_lines.exchange, line.get(drive_talk_lines.exchange) + 1)


def _judge(line: TalkLine, axis: int) -> bool:
    """Whether exactly one drive has answered; otherwise the stream flags show the reason."""
    answers, known = line.get(drive_talk_lines.answers), drive_talk_axes.ints[axis]
    if answers > 1:
        line.flag(dtsf.STREAM_ADDRESS_ERROR)
    elif not answers:
        line.flag(dtsf.STREAM_DRIVE_TIMEOUT)
        if line.memory.I[known]:
            line.flag(dtsf.STREAM_DRIVE_LOST)
    line.memory.I[known] = int(answers == 1)
    return answers == 1


def _end(line: TalkLine) -> None:
    """The request is done with; its flag clears itself."""
    axis = line.get(drive_talk_lines.axis)
    line.memory.I[dtcf.word[axis]] &= ~line.get(drive_talk_lines.request)
    line.put(drive_talk_lines.request, 0)


# axes without a line, and the drives' own look at themselves


def _give_up(memory: Memory, axis: int) -> None:
    """Requests of an axis that no open line serves end after a second."""
    limit = _limit(axis)
    if not pending(memory, axis) or line_of(memory, axis) is not None:
        memory.F[limit] = 0.0
    elif not memory.F[limit]:
        memory.F[limit] = later_tk(memory, TIMEOUT_MS)
    elif memory.F[limit] <= tick_of(memory):
        memory.F[limit] = 0.0
        memory.I[dtcf.word[axis]] &= ~pending(memory, axis)


def _limit(axis: int) -> int:
    return drive_talk_axes.limit_tk[axis]


_LOOK = networks.look_tk


def _look_for_errors(memory: Memory) -> None:
    """Let drives that log errors check for them periodically."""
    logging = [drive for drive in aries.drives(memory) if drive.whole(bus_drives.selection)]
    if memory.F[_LOOK] <= tick_of(memory):
        for drive in logging:
            aries.notice_errors(drive)
        memory.F[_LOOK] = later_tk(memory, LOOK_MS) if logging else 0.0
