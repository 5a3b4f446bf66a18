"""The machines a panel can work on: one in this process, or a card at the end of a link."""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from openacr.client.links import Host
from openacr.mill.session import MillSession
from openacr.panel.control.history import History
from openacr.panel.control.pace import OwnTime, Pace, Paced
from openacr.sysvar import Store

if TYPE_CHECKING:
    from openacr.controller import Controller

Say = Callable[[str], None]


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
        return cls(kind, name, history, store, programs, Paced(history), history, sample, project)

    @property
    def controller(self) -> "Controller | None":
        """The card, if it is in this process."""
        return None if self.history is None else self.history.card

    @property
    def is_virtual(self) -> bool:
        """Whether the card is in this process."""
        return self.history is not None

    def open(self, say: Say) -> MillSession:
        """Open the session of the machine."""
        return MillSession.real(self.target, self.store, say)

    def close(self) -> None:
        """Release the store and a card in this process."""
        with suppress(Exception):
            self.store.close()
        if self.controller is not None:
            self.controller.close()
