"""The machines a panel can work on: one in this process, or a card at the end of a link."""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from openacr.client import Card, Options
from openacr.client.card_axes import attached
from openacr.client.links import Host
from openacr.errors import OpenacrError, UserError
from openacr.lang.attachments import Attached
from openacr.mill.card.attached import lacking
from openacr.mill.card.checks import MovingError, check_rest
from openacr.mill.card.driver import LINK_ERRORS
from openacr.mill.config.settings import Settings
from openacr.mill.session import MillSession
from openacr.panel.control.machine.history import History
from openacr.panel.control.machine.opening import StopWaitsError, connected
from openacr.panel.control.machine.pace import OwnTime, Pace, Paced
from openacr.sysvar import Store

if TYPE_CHECKING:
    from openacr.controller import Controller


class Bus(Protocol):
    """The bus of the machine, as its card reports it."""

    @property
    def report(self) -> dict[str, Any] | None:
        """Its newest state (`fieldbus/machine/report.py`); None while it is not known."""

    def reset_counters(self) -> None:
        """Let the counters of frames begin at 0."""

    def close(self) -> None:
        """End the card."""


Say = Callable[[str], None]
Make = Callable[[Card, Store, Say], MillSession]


@dataclass(slots=True)
class Installation:
    """A machine, its store, the folder of its part programs."""

    kind: str  # embedded, project, tcp or serial
    name: str
    target: str | Host
    store: Store
    programs: Path
    pace: Pace
    history: History | None = None  # of a card in this process
    sample: str = ""  # program that is loaded at the start
    project: Path | None = None  # the folder whose programs the card began with
    bus: Bus | None = None  # of a card that the panel has started
    is_agreed: bool = False  # that AcroMill sets the card up
    lacks: str = field(default="", init=False)  # why the session of the card is not set up
    attached: list[Attached] = field(default_factory=list, init=False)  # axes of the card
    waits_for_rest: bool = field(default=False, init=False)  # it is set up once the card rests

    @classmethod
    def at(cls, target: str, store: Store, programs: Path) -> "Installation":
        """A card at `HOST[:PORT]` or at a serial port."""
        kind = "serial" if "/" in target or target.upper().startswith("COM") else "tcp"
        return cls(kind, target, target, store, programs, OwnTime())

    @classmethod
    def inside(
        cls,
        controller: "Controller",
        store: Store,
        programs: Path,
        *,
        kind: str = "embedded",
        name: str = "virtual machine",
        sample: str = "",
        project: Path | None = None,
    ) -> "Installation":
        """A card in this process, which the control thread advances."""
        history = History(controller)
        return cls(
            kind, name, history, store, programs, Paced(history), history, sample, project,
            is_agreed=True,
        )  # fmt: skip

    @property
    def controller(self) -> "Controller | None":
        """The card, if it is in this process."""
        return None if self.history is None else self.history.card

    @property
    def is_virtual(self) -> bool:
        """Whether the card is in this process."""
        return self.history is not None

    def open(self, say: Say, is_awaited: Callable[[], bool]) -> MillSession:
        """Open the session of the machine; StopWaitsError, or a link error.

        The card is set up where that was agreed on. Else, and where it is refused, its session
        is bare and `lacks` says why: the card stays as it is.
        """
        self.lacks, self.waits_for_rest = "", False
        if self.is_agreed:
            try:
                return self._noted(self._opened(MillSession.on, say, is_awaited))
            except (StopWaitsError, *LINK_ERRORS):
                raise
            except OpenacrError as error:
                self.lacks, self.waits_for_rest = str(error), isinstance(error, MovingError)
                self.is_agreed = self.is_virtual or self.waits_for_rest
        session = self._noted(self._opened(MillSession.bare, say, is_awaited))
        self.lacks = self.lacks or lacking(self.attached, session.runner.settings)
        return session

    def _noted(self, session: MillSession) -> MillSession:
        self.attached = session.card.perform(attached)
        return session

    def axis_name(self, index: int) -> str:
        """The name of an axis of the card: that of the machine, or AXISn."""
        named = (each.name for each in Settings(self.store).axes if each.index == index)
        return next(named, f"AXIS{index}")

    def axis(self, name: str, *, is_stored: bool = False) -> int:
        """An axis of the card by the name that AcroMill or one of its masters gives it, or AXISn.

        UserError for another name, and where values are to be stored for an axis that has no
        parameters of the machine.
        """
        own = {each.name: each.index for each in Settings(self.store).axes}
        known = {f"AXIS{each.axis}": each.axis for each in self.attached}
        known |= {each.name: each.axis for each in reversed(self.attached)}
        known |= own
        index = known.get(name.upper())
        if index is None:
            raise UserError(f"no axis {name}: there are {', '.join(sorted(known))}")
        if is_stored and index not in own.values():
            raise UserError(f"the machine has no {name}: its values are set without keeping them")
        return index

    def rests(self, session: MillSession) -> bool:
        """Whether a set-up that waits for the card to rest may be tried again."""
        try:
            check_rest(session.card, session.runner.settings)
        except MovingError:
            return False
        return True

    def _opened(self, make: Make, say: Say, is_awaited: Callable[[], bool]) -> MillSession:
        timeout_s = Settings(self.store).link_timeout_s
        reconnect_s = timeout_s if make == MillSession.on else 0.0
        options = Options(timeout_s=timeout_s, reconnect_s=reconnect_s)
        card, settle = connected(self.target, options, is_awaited)
        try:
            session = make(card, self.store, say)
        except BaseException:
            with suppress(*LINK_ERRORS):
                card.close()
            raise
        settle()
        return session

    def close(self) -> None:
        """Release the store and a card in this process."""
        with suppress(Exception):
            self.store.close()
        if self.controller is not None:
            self.controller.close()
        if self.bus is not None:
            self.bus.close()
