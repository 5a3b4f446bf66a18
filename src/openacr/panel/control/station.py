"""Everything the control thread owns: the machine, its operators, what they hold."""

import logging
from collections.abc import Callable

from openacr.client import ConnectionLostError
from openacr.errors import OpenacrError
from openacr.panel.control.installation import Installation
from openacr.panel.control.live import Live
from openacr.panel.control.orders import LATER, Order, failure
from openacr.panel.control.people import Person
from openacr.panel.control.presses import End
from openacr.panel.control.shared import Tell
from openacr.panel.roles import Role
from openacr.sysvar.lookup import known
from openacr.sysvar.schema import FIRST_SYSTEM
from openacr.sysvar.tabs import CELLS, COMMUNICATIONS, DISPLAY, GENERAL

log = logging.getLogger(__name__)
KEEP = "jog.keep"  # comes many times a second
OF_A_RUN = range(CELLS.tool_selected, CELLS.cycle_direction + 1)  # written as a program runs
MOST_CELLS = 2000  # numbers of changed cells in one event
SERVER = Person(0, Role.SERVICE, "", "server")
# Tabs of which a session reads nothing when it is opened, and the cells that it does read there.
OF_ANY_TIME = frozenset(tab.tab.name for tab in (COMMUNICATIONS, DISPLAY, GENERAL))
OF_CARD = frozenset({GENERAL.card_model, GENERAL.axis_count, GENERAL.master_program})
Carry = Callable[["Station", Order, float], object]


class Station(Live):
    """One machine and the people at its screens."""

    def __init__(
        self, installation: Installation, carry_out: Carry, tell: Tell = lambda _event: None
    ) -> None:
        super().__init__(installation, tell)
        self._carry_out = carry_out

    # --- settings ---------------------------------------------------------------------

    def note_stored(self, cells: frozenset[int]) -> None:
        """Cells were stored: the session of the machine is opened again where they count."""
        if any(map(is_of_session, cells)):
            self.must_renew = True
        shown = sorted(n for n in cells if n not in OF_A_RUN)
        if shown:
            self.tell({"event": "changed", "what": "forms", "cells": shown[:MOST_CELLS]})

    def store_at_rest(self, cell: int, value: float) -> None:
        """Store a setting of motion: now, or once the machine rests."""
        self._kept[cell] = value
        if self._rests:
            self._store_kept()

    def load_sample(self) -> None:
        """Load the sample part, where the machine has one."""
        name = self.installation.sample
        if name:
            file = self.installation.programs / name
            order = Order(SERVER, "program.load")
            self.part.load(file, name, order, kind="file", dialect="")

    # --- orders -----------------------------------------------------------------------

    def order(self, order: Order, now_s: float) -> None:
        """Carry an order out and answer it."""
        self.now_s = now_s
        try:
            result = self._carry_out(self, order, now_s)
        except Exception as error:
            if not isinstance(error, (OpenacrError, ConnectionLostError)):
                log.exception("%s has failed", order.name)
            order.answer({"ok": False, "error": failure(error)})
            return
        if result is not LATER:
            order.answer({"ok": True, "result": result})
        if order.name != KEEP:
            self._facts.tell()

    # --- people ----------------------------------------------------------------------------

    def join(self, person: Person) -> None:
        """A browser has connected: it gets all facts."""
        self.people.join(person)
        to = person.client
        for event in self._facts.all():
            control = {"you": self.people.holder == to} if event["event"] == "control" else {}
            self.tell({**event, **control, "to": to})
        self.tell({"event": "says", "lines": list(self.said), "to": to})

    def leave(self, client: int) -> None:
        """A browser has gone: what it held stops."""
        self._guarded(lambda: self.hand_motion.presses.end_all(End.LINK, client=client))
        self.hand_motion.presses.forget(client)
        self.watches.forget(client)
        self.on_card.forget(client)
        self.world.forget(client)
        self._guarded(lambda: self.tuning.leave(client, self.session))
        self.terminals.leave(client)
        self._guarded(lambda: self.buttons.drop(self.session, client))
        self.people.leave(client)
        self._facts.tell()


def is_of_session(cell: int) -> bool:
    """Whether the machine has to be set up again after this cell was stored."""
    if cell < FIRST_SYSTEM:
        return False
    return cell in OF_CARD or known(cell).tab not in OF_ANY_TIME
