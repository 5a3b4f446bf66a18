"""Settings of the store while a machine runs: what is stored at rest, what needs a new session."""

from functools import partial

from openacr.panel.control.interlocks import Interlocks
from openacr.panel.control.machine.link import Link
from openacr.panel.control.screens import Screens
from openacr.sysvar.lookup import known
from openacr.sysvar.schema import FIRST_SYSTEM
from openacr.sysvar.tabs import CELLS, COMMUNICATIONS, DISPLAY, GENERAL

OF_A_RUN = range(CELLS.tool_selected, CELLS.cycle_direction + 1)  # written as a program runs
MOST_CELLS = 2000  # numbers of changed cells in one event
# Tabs of which a session reads nothing when it is opened, and the cells that it does read there.
OF_ANY_TIME = frozenset(tab.tab.name for tab in (COMMUNICATIONS, DISPLAY, GENERAL))
OF_CARD = frozenset({GENERAL.card_model, GENERAL.axis_count, GENERAL.master_program})


class StoredSettings:
    """The settings of one machine; `must_renew` once one counts from the next session only."""

    def __init__(self, link: Link, interlocks: Interlocks, screens: Screens) -> None:
        self._link, self._interlocks, self._screens = link, interlocks, screens
        self._kept: dict[int, float] = {}  # settings of motion that are stored at rest
        self.must_renew = False

    def note_stored(self, cells: frozenset[int]) -> None:
        """Cells were stored: the session of the machine is opened again where they count."""
        if any(map(is_of_session, cells)):
            self.must_renew = True
        shown = sorted(n for n in cells if n not in OF_A_RUN)
        if shown:
            event = {"event": "changed", "what": "forms", "cells": shown[:MOST_CELLS]}
            self._screens.tell(event)

    def store_at_rest(self, cell: int, value: float) -> None:
        """Store a setting of motion: now, or once the machine rests."""
        self._kept[cell] = value
        if self._interlocks.rests:
            self.store_kept()

    def store_kept(self) -> None:
        """Store what was kept until the machine rests."""
        kept, self._kept = self._kept, {}
        store = self._link.installation.store
        for cell, value in kept.items():
            self._screens.guarded(partial(store.write, cell, value))


def is_of_session(cell: int) -> bool:
    """Whether the machine has to be set up again after this cell was stored."""
    if cell < FIRST_SYSTEM:
        return False
    return cell in OF_CARD or known(cell).tab not in OF_ANY_TIME
