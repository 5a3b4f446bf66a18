"""What happened to the machine during a run: limits met, kills, drives lost, programs refused.

The flags that report it are watched by the compiled loop, so each event has the time of its
servo period.
"""

from collections.abc import Callable, Iterator

from openacr.cli.results import Event
from openacr.engine.watches import Watch, Watched
from openacr.map import flag
from openacr.map import numbers as at
from openacr.map.memory import Memory
from openacr.map.rows import threads
from openacr.map.words import af4, af5, mf1
from openacr.scenario import card_view
from openacr.scenario.played import Failure

# Flags of an axis whose setting is an event, by word.
AXIS_EVENTS = (
    (af4.word, af4.KILL_ALL_MOTION_REQUEST | af4.DRIVE_FAULT),
    (
        af5.word,
        af5.POSITIVE_HARDWARE_LIMIT_ENCOUNTERED
        | af5.NEGATIVE_HARDWARE_LIMIT_ENCOUNTERED
        | af5.POSITIVE_SOFTWARE_LIMIT_ENCOUNTERED
        | af5.NEGATIVE_SOFTWARE_LIMIT_ENCOUNTERED
        | af5.HOME_FAILED,
    ),
)
MASTERS = 8  # of the first flag words; the front end and programs use these
MASTER_EVENTS = mf1.KILL_ALL_MOVES_REQUEST


class EventLog:
    """Compares the flags of a card with what they were at the last call."""

    def __init__(
        self,
        memory: Memory,
        axes: int,
        names: dict[int, str],
        failure: Callable[[int], Failure],
    ) -> None:
        """`names`: of axes, as their user calls them; `failure`: what has ended a program."""
        self._memory = memory
        self._failure = failure
        self._names = names
        self._flags = [(word[n], mask, n) for n in range(axes) for word, mask in AXIS_EVENTS]
        self._masters = [(mf1.word[m], MASTER_EVENTS, m) for m in range(MASTERS)]
        self._errors = [threads.error[p] for p in card_view.PROGRAMS]
        self._before = {row: memory.I[row] for row in self._rows()}

    def _rows(self) -> Iterator[int]:
        yield from (row for row, _, _ in (*self._flags, *self._masters))
        yield from self._errors

    def watches(self) -> list[Watch]:
        """What ends an advance of the card at the tick of an event, for all that is in use now.

        Axes without a master and programs without lines are left out, as every watch costs a
        little in every tick; what happens to them is found at the next poll.
        """
        memory, masters = self._memory, card_view.masters_of_axes(self._memory)
        words = [(row, mask) for row, mask, axis in self._flags if axis in masters]
        words += [(row, mask) for row, mask, m in self._masters if m in masters.values()]
        stored = (p for p in card_view.PROGRAMS if card_view.has_program(memory, p))
        words += [(self._errors[program], -1) for program in stored]
        return [Watch(Watched.WORD, row, mask) for row, mask in words]

    def poll(self, time_s: float) -> list[Event]:
        """What has happened since the last call."""
        return list(self._new(time_s))

    def _new(self, time_s: float) -> Iterator[Event]:
        for row, mask, axis in self._flags:
            for number in self._risen(row, mask):
                yield Event(
                    time_s, f"{self._names.get(axis, f'axis {axis}')}: {_name(number)}", number
                )
        for row, mask, master in self._masters:
            for number in self._risen(row, mask):
                yield Event(time_s, f"master {master}: {_name(number)}", number)
        for program, row in enumerate(self._errors):
            before, self._before[row] = self._before[row], self._memory.I[row]
            if self._before[row] and not before:
                yield Event(time_s, self._stopped(program), None, program)

    def _stopped(self, program: int) -> str:
        failure, line = self._failure(program), card_view.program_line(self._memory, program)
        place = f" ({failure.place})" if failure.place else ""
        return f"PROG{program}: stopped in line {line}{place}: {failure.error}"

    def _risen(self, row: int, mask: int) -> Iterator[int]:
        """Flags of a word that are set and were not."""
        now, before = self._memory.I[row], self._before[row]
        self._before[row] = now
        risen = now & ~before & mask
        first = (row - at.FLAG_WORD_BASE) * 32
        return (first + bit for bit in range(32) if risen >> bit & 1)


def _name(number: int) -> str:
    return f"{flag(number).name} (BIT{number})"
