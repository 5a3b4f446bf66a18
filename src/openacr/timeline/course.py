"""A part of a history that is lived through again on a card of its own, in any process."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from openacr.controller.controller import Controller
from openacr.controller.player import Player
from openacr.controller.recorder import Recorder
from openacr.controller.snapshot import Snapshot
from openacr.errors import CardError, UserError
from openacr.journal.entries import JournalEntry
from openacr.models import Model
from openacr.plant.describe import schema
from openacr.timeline.branch import Branch
from openacr.timeline.moment import Moment, moments


@dataclass(frozen=True)
class Course:
    """What happens to a card from a snapshot on: plain data that can be sent to a process."""

    model: Model
    world: schema.World
    device_folder: Path | None
    snapshot: Snapshot
    first_tk: int  # of the snapshot
    entries: tuple[JournalEntry, ...]
    last: Moment

    @classmethod
    def of(cls, card: Controller, branch: Branch, first: Moment, last: Moment) -> Course:
        """What happens to a card on a branch, from the keyframe before one moment to another."""
        keyframe = branch.keyframe(first)
        begin = keyframe.entered - branch.forgotten
        due = [at for at, _ in moments(branch.entries, begin) if at.order <= last.order]
        return cls(
            card.model,
            card.world,
            card.device_folder,
            keyframe.snapshot,
            keyframe.tick,
            tuple(branch.entries[begin : begin + len(due)]),
            last,
        )

    def card(self) -> Controller:
        """Another card at the first moment."""
        card = Controller(self.model, world=self.world, device_folder=self.device_folder)
        card.is_journalled = False
        card.take_over(self.snapshot)
        return card

    def at_last(self) -> Controller:
        """Another card at the last moment."""
        card = self.card()
        player = Player(card)
        for entry in self.entries:
            player.play(entry)
        player.advance_within(self.last.tick, self.last.within)
        return card

    def moments(self, ticks: Sequence[int]) -> Iterator[Controller]:
        """The card at the ends of these ticks, which ascend; UserError for one outside."""
        card = self.card()
        player = Player(card)
        waiting = deque(moments(self.entries))
        for tick in ticks:
            if not self.first_tk <= tick <= self.last.tick:
                raise UserError(
                    f"tick {tick} is not known: from {self.first_tk} to {self.last.tick} are"
                )
            while waiting and waiting[0][0].order <= Moment(tick).order:
                player.play(self.entries[waiting.popleft()[1]])
            player.advance_within(tick, 0)
            yield card

    def samples(
        self, parameters: Sequence[int], first_tk: int, every_tk: int, count: int
    ) -> list[list[float]]:
        """Samples of parameters, a list for each; CardError for a parameter that does not exist."""
        channels: list[list[float]] = [[] for _ in parameters]
        for card in self.moments(range(first_tk, first_tk + every_tk * count, every_tk)):
            for channel, parameter in zip(channels, parameters, strict=True):
                channel.append(float(card.p[parameter]))
        return channels

    def values(self, parameters: Sequence[int], tick: int) -> list[float | None]:
        """Parameters at the end of a tick; None for those that the card does not have then."""
        (card,) = self.moments([tick])
        return [_value(card, each) for each in parameters]

    def save(self, path: Path, *, seen: Callable[[float], None] = lambda part: None) -> None:
        """Write it as a journal; `seen` gets the part that is done, 0 to 1."""
        card = self.card()
        card.recorder = Recorder(card, path)
        player = Player(card)
        length_tk = max(1, self.last.tick - self.first_tk)
        for entry in self.entries:
            player.play(entry)
            seen((card.lived_tk - self.first_tk) / length_tk)
        player.advance_within(self.last.tick, 0)
        card.close()
        seen(1.0)


def _value(card: Controller, parameter: int) -> float | None:
    try:
        return float(card.p[parameter])
    except CardError:
        return None
