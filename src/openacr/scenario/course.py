"""The course of a run: play what is due, let the card live until the next moment, and the end."""

from enum import Enum

from msgspec import Struct

from openacr.errors import MapError, UserError
from openacr.map import flag
from openacr.map.numbers import FLAG_LAST
from openacr.scenario import card_view
from openacr.scenario.play import Play
from openacr.scenario.played import CardWorld, PlayedCard
from openacr.scenario.schema import Condition, Scenario

SCAN_S = 0.05  # the slow scan of the card: time between two looks whether it is idle
LOOK_S = 0.5  # between two looks of the caller
IDLE_S = 0.1  # a card is idle when nothing ran or moved for two slow scans
LONGEST_S = 600.0  # a run that is to end by itself ends here if it does not


class Stop(Enum):
    """Why a run ended."""

    TIME = "time"
    BIT = "bit"
    IDLE = "idle"
    INTERRUPT = "interrupt"


class Until(Struct, frozen=True):
    """When a run ends before its time: a flag has a state, or nothing happens any more."""

    bit: int | None = None
    is_on: bool = True

    def __str__(self) -> str:
        if self.bit is None:
            return "idle"
        return f"BIT{self.bit} {'set' if self.is_on else 'clear'}"


def read_until(text: str) -> Until:
    """Read `idle`, a flag that is to be set (516), or one that is to be clear (-516).

    UserError for anything else, and for a flag that does not exist.
    """
    if text.strip().lower() == "idle":
        return Until()
    number = text.strip().upper().removeprefix("-").removeprefix("BIT").strip()
    if not (number.isascii() and number.isdigit()):
        hint = "give `idle`, a flag that is to be set (516) or one that is to be clear (-516)"
        raise UserError(hint)
    try:
        flag(int(number))
    except MapError as error:
        raise UserError(f"{error} (flags are 0..{FLAG_LAST})") from None
    return Until(int(number), not text.strip().startswith("-"))


def stored_but_idle(card: PlayedCard) -> list[int]:
    """The stored programs, if none of them runs: a run without a scenario starts them."""
    stored = [p for p in card_view.PROGRAMS if card_view.has_program(card.memory, p)]
    return [] if card_view.running_programs(card.memory) else stored


class Course:
    """One run of a card from its present tick on, at most `limit_s` simulated seconds long."""

    def __init__(
        self,
        card: PlayedCard,
        scenario: Scenario | None,
        limit_s: float,
        until: Until | None = None,
        *,
        is_paced: bool = False,
    ) -> None:
        """`is_paced`: by the wall clock, so that every step is short."""
        self._card, self._clock = card, card.clock
        self._until = until
        self._is_scanned = until == Until() or is_paced
        self.play = Play(scenario or Scenario(), card.clock.period_s)
        self.world = CardWorld(card)
        # The run counts from here, whatever the loading took.
        self.begin_tk = card.clock.lived_tk
        self.end_tk = self.begin_tk + self._clock.ticks(limit_s)
        self._scan_tk = self._clock.ticks(SCAN_S)
        self._busy_tk = self.begin_tk
        self._was_other = False
        self._watched: tuple[Condition, ...] | None = None
        self._sees_every_tick = False

    @property
    def lived_s(self) -> float:
        """Simulated seconds since the start of the run."""
        return self.world.tick * self._clock.period_s

    def step(self) -> Stop | None:
        """Play what is due and run the card to its next moment; why the run is over, or None."""
        self.play.step(self.world)
        if stop := self._reached():
            return stop
        self._watch()
        if not self._advance(self._next_tick() - self._clock.lived_tk):
            return None
        self.play.step(self.world)
        return Stop.BIT

    def _watch(self) -> None:
        """Have the card watch what the scenario waits for, or look at every tick instead."""
        conditions = self.play.conditions
        if conditions != self._watched or self._card.has_new_events():
            self._watched = conditions
            self._sees_every_tick = not self._card.watch(conditions)

    def _next_tick(self) -> int:
        """How far the card may run before the next look."""
        now = self._clock.lived_tk
        if self._sees_every_tick:
            return now + 1
        look_tk = self._scan_tk if self._is_scanned else self._clock.ticks(LOOK_S)
        known = self.play.next_tick(self.world.tick)
        planned_tk = self.end_tk if known is None else self.begin_tk + known
        return min(self.end_tk, now - now % look_tk + look_tk, planned_tk)

    def _advance(self, ticks: int) -> bool:
        """Let the card live; True when the flag to wait for has come."""
        until, card = self._until, self._card
        if until is None or until.bit is None:
            card.advance(ticks)
            return False
        # A flag that is to be clear has to be set first: at power-up nearly all are clear.
        if not until.is_on and not self._was_other:
            self._was_other = card.advance_until(until.bit, True, ticks)
            return False
        return card.advance_until(until.bit, until.is_on, ticks)

    def _reached(self) -> Stop | None:
        now = self._clock.lived_tk
        if now >= self.end_tk:
            return Stop.TIME
        # Only the ticks of the slow scan count, whatever else the run was stopped for.
        if self._until != Until() or now % self._scan_tk:
            return None
        play = self.play
        awaits_more = play.conditions or play.next_tick(self.world.tick) is not None
        if awaits_more or not card_view.is_idle(self._card.memory):
            self._busy_tk = now
        quiet_s = (now - self._busy_tk) * self._clock.period_s
        return Stop.IDLE if quiet_s >= IDLE_S else None
