"""What cases run on: a virtual card as new, for each case from a snapshot."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import lru_cache
from typing import Protocol

from msgspec.structs import replace

from openacr.channels import CHANNELS, StreamKind
from openacr.conform.form import DifferenceError, Machine
from openacr.controller import Controller
from openacr.controller.snapshot import Snapshot
from openacr.errors import UserError
from openacr.models import DEFAULT_MODEL, MODELS
from openacr.plant.describe.load import parse_world
from openacr.plant.describe.schema import ModelName, World, default_world
from openacr.project import find_project
from openacr.testing import machine as under_test

CONSOLE = "STREAM1"
POLL_TK = 40  # between two looks of a host at its card: 20 ms, as a session polls
KINDS = {name: kind for kind, names in CHANNELS.items() for name in names}
KINDS |= {CONSOLE: StreamKind.TERMINAL, "PACKETS": StreamKind.PACKETS}
_SET = re.compile(r"(BIT\s*\d+\s*(?:=|<>)\s*)-1", re.IGNORECASE)
_PLACE = re.compile(r"(P|BIT)\s*(\d+)", re.IGNORECASE)


class Target(Protocol):
    """A card that cases run on; times are its servo periods."""

    @property
    def period_s(self) -> float:
        """The servo period [s]."""

    @property
    def tick(self) -> int:
        """Servo periods since some moment."""

    def send(self, channel: str, data: bytes) -> None:
        """Send bytes on a channel, which is opened by its first use."""

    def heard(self, channel: str) -> bytes:
        """The bytes a channel has sent since the last call."""

    def is_answered(self, channel: str) -> bool:
        """Whether all lines of a channel are answered."""

    def advance(self, ticks: int) -> None:
        """Let time pass."""

    def until(self, condition: str, limit_s: float) -> None:
        """Let time pass until a condition holds; DifferenceError if it does not in time."""

    def number(self, what: str) -> float | None:
        """The value of `P` or `BIT` with a number, exactly; None for any other expression."""

    def printed(self) -> str:
        """What programs have printed since the last call."""

    def state(self) -> str:
        """Axes and programs in words, for the report of a case that failed."""

    @property
    def world(self) -> Controller:
        """The card whose inputs and machine can be changed; UserError where there is none."""


class VirtualCard:
    """A virtual card as it is after loading a machine."""

    def __init__(self, card: Controller) -> None:
        self.world = card
        self._machine = under_test.Machine(card)
        self._printed = ""
        self._streams: dict[str, int] = {CONSOLE: card.console}
        self.attend: Callable[[], object] | None = None  # a host that looks at the card meanwhile
        card.listen(self._hear)

    def _hear(self, program: int, text: str) -> None:
        self._printed += text

    @property
    def period_s(self) -> float:
        """The servo period [s]."""
        return self.world.period_s

    @property
    def tick(self) -> int:
        """Servo periods the card has run; a restart does not reset the count."""
        return self.world.lived_tk

    def _stream(self, channel: str) -> int:
        if channel not in self._streams:
            if channel not in KINDS:
                raise UserError(f"{channel}: the channels are {', '.join(sorted(KINDS))}")
            name = None if channel == "PACKETS" else channel
            self._streams[channel] = self.world.open_stream(KINDS[channel], name)
        return self._streams[channel]

    def send(self, channel: str, data: bytes) -> None:
        """Send bytes on a channel."""
        self.world.receive(self._stream(channel), data)

    def heard(self, channel: str) -> bytes:
        """The bytes a channel has sent since the last call."""
        stream = self._stream(channel)
        return b"".join(iter(lambda: self.world.take_output(stream), b""))

    def is_answered(self, channel: str) -> bool:
        """Whether all lines of a channel are answered."""
        return self.world.streams.is_answered(self._stream(channel))

    def advance(self, ticks: int) -> None:
        """Let time pass."""
        while self.attend and ticks > 0:
            part = min(ticks, POLL_TK)
            self.world.advance(part)
            self.attend()
            ticks -= part
        self.world.advance(ticks)

    def until(self, condition: str, limit_s: float) -> None:
        """Let time pass until a condition holds."""
        last_tk = self.tick + round(limit_s / self.period_s)
        while True:
            left_tk = last_tk - self.tick
            part_tk = min(left_tk, POLL_TK) if self.attend else left_tk
            try:
                self._machine.until(_plain(condition), part_tk * self.period_s)
            except under_test.NotReachedError as error:
                if part_tk == left_tk:
                    text = f"{condition} within {limit_s:g} s"
                    raise DifferenceError(text, str(error)) from None
            else:
                return
            if self.attend:
                self.attend()

    def number(self, what: str) -> float | None:
        """The value of `P` or `BIT` with a number."""
        place = _PLACE.fullmatch(what)
        if place is None:
            return None
        number = int(place[2])
        return self.world.p[number] if place[1].upper() == "P" else -self.world.bit[number]

    def printed(self) -> str:
        """What programs have printed since the last call."""
        text, self._printed = self._printed, ""
        return text

    def state(self) -> str:
        """Axes and programs in words."""
        return self._machine.state()


def _plain(condition: str) -> str:
    """A condition whose set flag is 1, not -1 as the card prints it."""
    return _SET.sub(r"\g<1>1", condition)


@lru_cache(maxsize=64)
def world_of(machine: Machine, model: str) -> World:
    """The world of a machine, with a card of a model where it names none itself."""
    text = machine.text
    if machine.folder and (file := find_project(machine.folder).machine):
        text = file.read_text(encoding="utf-8")
    if not text:
        return default_world(MODELS[model])
    world = parse_world(text)
    if "model" in tomllib.loads(text).get("card", {}):
        return world
    return replace(world, card=replace(world.card, model=ModelName(model)))


@lru_cache(maxsize=16)
def _loaded(machine: Machine, model: str) -> tuple[Controller, Snapshot]:
    """The card of a machine, and what it is after loading."""
    world = world_of(machine, model)
    if machine.folder:
        card = Controller.from_project(machine.folder, world=world)
    else:
        card = Controller(world.card.board, world=world)
    card.is_journalled = False
    return card, card.snapshot()


@contextmanager
def virtual(machine: Machine, model: str = DEFAULT_MODEL.name) -> Iterator[VirtualCard]:
    """A virtual card with its machine, as new; UserError or SourceError of a faulty machine.

    The model is that of the machine where it names one.
    """
    card, snapshot = _loaded(machine, model)
    card.take_over(snapshot)
    card.owns_console = False
    try:
        yield VirtualCard(card)
    finally:
        card.watch()
        card.end_record()
        card.system.listeners.taps.clear()
