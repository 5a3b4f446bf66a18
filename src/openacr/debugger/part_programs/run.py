"""The run of a part program at its latest moment: the runner, and where the machine is."""

from __future__ import annotations

from collections.abc import Callable

from openacr.controller.controller import Controller
from openacr.debugger.part_programs.blocks import BlockLog
from openacr.engine.watches import Watch, Watched, parameter_place
from openacr.errors import UserError
from openacr.mill.session import MillSession


class LiveRun:
    """Lets the runner poll as it does in `openacr mill run`, and notes when blocks are reached.

    A block is reached at the tick at which its motion begins, or with the motion after it; where
    the program waits at rest, with the wait.
    """

    def __init__(self, shop: MillSession, card: Controller, log: BlockLog) -> None:
        self.shop, self.card = shop, card
        self._log = log
        self._reached: list[int] = []  # ticks, by block
        self._reached_first = 0  # the block of the first one
        place = parameter_place(card.memory, shop.machine.counter)
        if place is None:
            raise UserError("the card does not count moves")
        self._watches = [shop.motion, Watch(Watched.WORD, place[1])]
        self._counter = place[1]
        self._plan_poll()

    @property
    def is_busy(self) -> bool:
        """Whether the program runs, waits, or is being ended."""
        return self.shop.runner.is_busy

    @property
    def alarms(self) -> int:
        """How many alarms were raised so far."""
        return self.shop.runner.alarms.raised

    @property
    def last_alarm(self) -> str:
        """Code and text of the last alarm."""
        last = self.shop.runner.alarms.history[-1]
        return f"alarm {last.kind.code}: {last.text}"

    @property
    def reached_cnt(self) -> int:
        """The count of blocks that the machine has come to."""
        return self._reached_first + len(self._reached)

    def reached_tk(self, block: int) -> int:
        """The tick at which the machine came to a block."""
        return self._reached[block - self._reached_first]

    def advance(self, ticks: int, *, until: Callable[[], bool]) -> None:
        """Advance by a number of ticks, or until something is so."""
        end_tk = self.card.lived_tk + ticks
        while self.card.lived_tk < end_tk and not until():
            if self._is_due or self.card.lived_tk >= self._poll_tk:
                self.poll()
            else:
                self._pass_time(min(end_tk, self._poll_tk) - self.card.lived_tk)
            self._note()

    def _pass_time(self, ticks: int) -> None:
        """Pass time as the session does, with a stop at each move that begins."""
        self.card.watch(self._watches)
        try:
            self.shop.machine.pause(ticks * self.card.period_s)
        finally:
            self._is_due = 0 in self.card.take_fired()
            self.card.watch()

    def poll(self) -> None:
        """Let the runner do what is due, as the operator that a virtual machine has."""
        self.shop.poll()
        self.shop.carry_on()
        self._plan_poll()

    def _plan_poll(self) -> None:
        self._is_due = False
        wait_tk = max(1, round(self.shop.poll_in_s / self.card.period_s))
        self._poll_tk = self.card.lived_tk + wait_tk

    def _note(self) -> None:
        """Note the blocks that the machine has come to by now."""
        ended_cnt = self.shop.runner.stream.block_at(int(self.card.memory.I[self._counter]))
        log = self._log
        for block in log.between(self.reached_cnt, log.end):
            if log[block].ended_cnt > ended_cnt:
                break
            self._reached.append(self.card.lived_tk)

    def forget(self, before: int) -> None:
        """Forget when the blocks before one were reached."""
        del self._reached[: before - self._reached_first]
        self._reached_first = before
