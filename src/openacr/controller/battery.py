"""Battery-backed memory in a data folder, written while the card runs.

Program texts and sizes are written at once, values once per second of card time, each
time as one transaction. Within the process the memory simply persists through REBOOT.
"""

from __future__ import annotations

from array import array

import msgspec
from msgspec import Struct

from openacr.basic.execute.system import System
from openacr.basic.memory import user_memory
from openacr.basic.memory.user_memory import Data, Text, UserMemory
from openacr.controller.image_store import ImageStore
from openacr.errors import CardError
from openacr.map.rows import every, storage, system_storage
from openacr.map.rows import system as system_rows

BATTERY, BATTERY_TEXT = "battery", "battery text "
VALUES_EVERY_S = 1.0


class Backed(Struct, frozen=True):
    """Battery-backed contents other than the program texts."""

    data: Data
    config: list[str]


class Battery:
    """The battery of a card; `is_on` is False for cards without one, and after BRESET."""

    def __init__(self, system: System, store: ImageStore) -> None:
        self._system, self._store = system, store
        self.enable()
        self._retries = False  # the last write failed: tried again once a second
        self._written_tk = 0
        self._shape: object = None
        self._stored = b""
        self._memos: list[user_memory.Memo] = [{} for _ in system.owners()]

    def stored(self) -> tuple[UserMemory, tuple[str, ...]] | None:
        """User memory and CONFIG as they were without power; None where nothing is stored.

        Each text is stored separately: if sizes and values are lost, the texts are still restored
        into the memory of a new card.
        """
        names = self._store.names(BATTERY) if self.is_on else []
        if not names:
            return None
        backed = self._store.decoded(BATTERY, Backed)
        if backed is None:
            self._store.lost("sizes, aliases and variables of battery-backed memory are lost")
            config = list(self._system.setup.config)
            backed = Backed(user_memory.take_data(self._system, values=False), config)
        texts = [self._store.decoded(name, Text) for name in names if name != BATTERY]
        found = [text for text in texts if text is not None]
        return UserMemory(found, backed.data), tuple(backed.config)

    def enable(self) -> None:
        """As at power-up, where the card has a battery."""
        self.is_on = self._system.card.model.has_battery
        self._follows = self.is_on and self._store.images.is_durable

    def disable(self) -> None:
        """Stop storing anything until the next power-up (BRESET)."""
        self.is_on = self._follows = False
        self._store.write(dict.fromkeys(self._store.names(BATTERY)))

    def follow(self) -> None:
        """Write changed texts and sizes at once."""
        if self._follows and (not self._retries or self._is_due):
            shape = self._present_shape()
            self._write(values=self._is_due or shape != self._shape)
            self._shape = shape

    def follow_in_time(self) -> None:
        """Write changed values if the last write is long enough ago."""
        if self._follows and self._is_due:
            self._write(values=True)

    def close(self) -> None:
        """Write everything not yet stored."""
        if self._follows:
            self._write(values=True)
        self._follows = False

    @property
    def _is_due(self) -> bool:
        clock = self._system.card.clock
        lived_s = (clock.tick - self._written_tk) * clock.period_s
        return not 0.0 <= lived_s < VALUES_EVERY_S  # REBOOT restarts the count

    def _write(self, *, values: bool) -> None:
        programs = self._system.programs
        changes = {f"{BATTERY_TEXT}{owner}": self._text(owner) for owner in programs.changed}
        if values:
            self._written_tk = self._system.card.clock.tick
            content = self._data()
            if content != self._stored:
                changes[BATTERY] = self._stored = content
        try:
            if changes:
                self._store.write(changes, flush=False)
        except CardError:
            self._retries, self._stored = True, b""
            self._store.notice("battery-backed memory is not stored until this is corrected")
        else:
            self._retries = False
            programs.changed.clear()

    def _text(self, owner: int) -> bytes | None:
        if self._system.programs.is_empty(owner):
            return None
        text = user_memory.take_text(self._system, owner, self._memos[owner])
        return msgspec.msgpack.encode(text)

    def _data(self) -> bytes:
        data = user_memory.take_data(self._system, values=True)
        return msgspec.msgpack.encode(Backed(data, list(self._system.setup.config)))

    def _present_shape(self) -> object:
        """Everything except values and text; changes with every DIM, #DEFINE, CONFIG, ..."""
        system, rows = self._system, self._system.card.memory.I
        places = every(storage.ints, storage.INTS_SIZE)
        sizes = array("i", rows[places])
        for row in storage.code_bytes:
            sizes[row - places.start] = 0  # derived from the text
        return (
            sizes.tobytes(),
            rows[every(system_storage.ints, system_storage.INTS_SIZE)].tobytes(),
            rows[system_rows.p_count],
            tuple(system.aliases.lines()),
            system.programs.password,
            system.setup.config,
            tuple(each.bytes for each in system.storage.locals.strings),
        )
