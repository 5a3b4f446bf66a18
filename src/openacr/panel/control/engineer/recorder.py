"""The recorder of a card in this process, shared by all who sample it: each has its own channels.

The engine has one list of samples and one period. They are those of all shares together: every
value once, in each tick that is due for any of them.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from openacr.engine.samples import SAMPLES, Sample, sample_of_flag, sample_of_parameter
from openacr.errors import UserError
from openacr.map import Flag, Parameter
from openacr.panel.control.engineer.scope import Block

if TYPE_CHECKING:
    from openacr.controller import Controller


@dataclass(eq=False, slots=True)
class Share:
    """What one of them samples, from a tick on and once in `every_tk`."""

    samples: list[Sample]
    every_tk: int
    due_tk: int  # tick of the sample that follows
    blocks: list[Block] = field(default_factory=list)  # recorded and not taken yet


class Recorder:
    """Records for all shares; without one the engine records nothing."""

    def __init__(self, controller: "Controller") -> None:
        self._controller = controller
        self._shares: list[Share] = []
        self._samples: dict[Sample, int] = {}  # with their places in a row
        self._every_tk = 1
        self._row_tk = 0  # tick of the row that follows

    @property
    def period_s(self) -> float:
        """A servo period."""
        return self._controller.period_s

    def join(self, channels: Sequence[Parameter | Flag], every_tk: int) -> Share:
        """Record from the next tick on; UserError for a channel that the card does not have."""
        samples = [self._sample(each) for each in channels]
        known = {*samples, *(each for share in self._shares for each in share.samples)}
        if len(known) > SAMPLES:
            raise UserError(f"{len(known)} values are sampled at once: {SAMPLES} are possible")
        share = Share(samples, every_tk, self._controller.lived_tk + 1)
        self._begin([*self._shares, share])
        return share

    def leave(self, share: Share) -> None:
        """Record no more for one."""
        self._begin([each for each in self._shares if each is not share])

    def take(self, share: Share) -> list[Block]:
        """What has been recorded for one since the last call, in order."""
        self._deal()
        found, share.blocks = share.blocks, []
        return found

    def _begin(self, shares: list[Share]) -> None:
        """Record what these need; nothing of those that go on is lost."""
        self._deal()
        self._shares = shares
        if not shares:
            self._controller.end_record()
            return
        samples = dict.fromkeys(each for share in shares for each in share.samples)
        self._samples = {each: place for place, each in enumerate(samples)}
        self._row_tk = self._controller.lived_tk + 1
        distances = (each.due_tk - self._row_tk for each in shares)
        self._every_tk = math.gcd(*(each.every_tk for each in shares), *distances)
        self._controller.record(self._every_tk, samples=list(samples))

    def _deal(self) -> None:
        """Give each what is due for it."""
        if not self._shares:
            return
        rows = self._controller.take_trace().values
        for share in self._shares:
            first = (share.due_tk - self._row_tk) // self._every_tk
            due = rows[first :: share.every_tk // self._every_tk]
            if len(due):
                places = [self._samples[each] for each in share.samples]
                share.blocks.append(due[:, places].T)
                share.due_tk += len(due) * share.every_tk
        self._row_tk += len(rows) * self._every_tk

    def _sample(self, channel: Parameter | Flag) -> Sample:
        if isinstance(channel, Flag):
            return sample_of_flag(channel.number)
        sample = sample_of_parameter(self._controller.memory, channel.number)
        if sample is None:
            raise UserError(f"P{channel.number}: this card has no such parameter")
        return sample
