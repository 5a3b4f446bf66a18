"""What a card keeps without power: saved parameters, user flash and battery-backed memory.

    image       written                                   read
    battery     at once (texts, dimensions), values       power-up
                every second of card time; with a
                data folder, on cards that have one
    flash       FLASH SAVE, FLASH IMAGE                   power-up, REBOOT, FLASH LOAD
    parameters  ESAVE                                     power-up, REBOOT, ELOAD

At power-up they are read in this order, each over what the one before has left. An image
that is damaged counts as not there, and `notices` says so.
"""

from __future__ import annotations

import logging
from array import array
from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeVar
from zlib import crc32

import msgspec
from msgspec import Struct

from openacr.basic import saved, user_memory
from openacr.basic.setup import Setup
from openacr.basic.system import System
from openacr.basic.user_memory import Data, Text, UserMemory
from openacr.errors import CardError, StoreError
from openacr.map import numbers as at
from openacr.messages import SAVE_FAILED
from openacr.models import FIRMWARE
from openacr.store import Database, Image, Images, Scratch
from openacr.store.images import needs_version

log = logging.getLogger(__name__)

CARD, FLASH, PARAMETERS, STREAM_MODES, BACKUP = "card", "flash", "parameters", "streams", "firmware"
BATTERY, BATTERY_TEXT = "battery", "battery text "
FORMAT = 1  # of all images; one of another format counts as damaged
VALUES_EVERY_S = 1.0
BOOT_EMPTY, SYSTEM1_EMPTY, SYSTEM2_EMPTY, USER_EMPTY, BACKED_UP = range(5656, 5661)

_Kind = TypeVar("_Kind")


class Battery(Struct, frozen=True):
    """Battery-backed memory beside the texts."""

    data: Data
    config: list[str]


class Persistence:
    """The non-volatile memory of one card; what it stores on is `images`.

    The language calls it for the commands of the group Non-Volatile.
    """

    def __init__(self, system: System, images: Images) -> None:
        self._system = system
        system.nonvolatile = self
        self.images = images
        self.notices: list[str] = []
        self._is_up = False  # what comes to light at power-up is said by whoever switches on
        self._has_battery = system.card.model.has_battery
        self._follows = self._has_battery and images.is_durable
        self._written_tk = 0
        self._shape: object = None
        self._stored = b""
        self._memos: list[user_memory.Memo] = [{} for _ in system.owners()]
        self._claim()

    @classmethod
    def open(cls, system: System, folder: Path | None) -> Persistence:
        """The non-volatile memory in a data folder, without one in this process alone."""
        if folder is None:
            return cls(system, Scratch())
        images, damage = Database.open(folder)
        try:
            opened = cls(system, images)
        except StoreError as error:
            images.close()
            raise StoreError(f"{folder}: {error}") from None
        if damage is not None:
            opened.notice(damage)
        return opened

    def _claim(self) -> None:
        """Refuse what another model has stored."""
        name = self._system.card.model.name.encode()
        known = self._read(CARD)
        if known is not None and known != name:
            raise StoreError(
                f"this data belongs to an {known.decode()}, the card is an {name.decode()}"
            )
        if known is None:
            self._write({CARD: Image(FORMAT, name)})

    # power-up

    def power_up(self) -> None:
        """Bring back what is stored, after the card has got its defaults."""
        config = self._power_up_battery() if self._has_battery else None
        self._load(config)
        self.follow()
        self._is_up = True

    def restart(self) -> None:
        """Bring back what is stored, at REBOOT; battery-backed memory is there already."""
        self._load(self._system.setup.config if self.keeps_memory else None)

    @property
    def keeps_memory(self) -> bool:
        """Whether programs and variables survive REBOOT."""
        return self._has_battery

    def _load(self, config: tuple[str, ...] | None) -> None:
        """Flash, then parameters; CONFIG is that of the battery where there is one."""
        flash = self._decoded(FLASH, UserMemory)
        if flash is not None:
            self._put_user_memory(flash)
        self._system.setup = Setup()
        self.eload()
        modes = self._decoded(STREAM_MODES, list[int])
        if modes is not None:
            saved.put_stream_modes(self._system, modes)
        if config is not None:
            self._system.setup.configure(config)

    def _put_user_memory(self, image: UserMemory) -> None:
        try:
            refused = user_memory.put(self._system, image)
        except (CardError, ValueError, TypeError, LookupError) as error:
            self._system.forget()
            refused = [str(error)]
        self.notices += [f"not restored: {line}" for line in refused]

    # parameters

    def esave(self) -> None:
        """ESAVE."""
        parameters = Image(FORMAT, msgspec.msgpack.encode(saved.take(self._system)))
        modes = Image(FORMAT, msgspec.msgpack.encode(saved.take_stream_modes(self._system)))
        self._write({PARAMETERS: parameters, STREAM_MODES: modes})

    def eload(self) -> None:
        """ELOAD; without saved parameters nothing changes."""
        parameters = self._decoded(PARAMETERS, dict[str, Any])
        if parameters is not None:
            refused = saved.put(self._system, parameters)
            self.notices += [f"not restored: {line}" for line in refused]

    def erase(self) -> None:
        """ERASE: forget the saved parameters; start-up modes of streams stay."""
        self._write({PARAMETERS: None})

    # flash

    def flash_save(self, *, values: bool) -> None:
        """FLASH SAVE, and with values FLASH IMAGE."""
        image = user_memory.take(self._system, values=values)
        self._write({FLASH: Image(FORMAT, msgspec.msgpack.encode(image))})

    def flash_load(self) -> None:
        """FLASH LOAD; from an empty flash nothing is loaded."""
        flash = self._decoded(FLASH, UserMemory)
        if flash is not None:
            self._put_user_memory(flash)

    def flash_erase(self) -> None:
        """FLASH ERASE."""
        self._write({FLASH: None})

    # firmware

    def firmware_backup(self) -> None:
        """FIRMWARE BACKUP: system flash 2 becomes a copy of system flash 1."""
        self._write({BACKUP: Image(FORMAT, FIRMWARE.encode())})
        self._system.card.memory.set_bit(BACKED_UP, True)

    def firmware_checksum(self) -> None:
        """FIRMWARE CHECKSUM: versions, checksums and flags of all four flash memories."""
        memory, own = self._system.card.memory, FIRMWARE.encode()
        backup, user = self._read(BACKUP) or b"", self._read(FLASH) or b""
        for number, content in (
            (at.P_BOOTFLASH_VERSION, own),
            (at.P_SYSFLASH1_VERSION, own),
            (at.P_SYSFLASH2_VERSION, backup),
        ):
            memory.write(number, int(content.replace(b".", b"") or b"0"))
            memory.write(number + 1, crc32(content))
        memory.write(at.P_USERFLASH_CHECKSUM, crc32(user))
        memory.set_bit(BOOT_EMPTY, False)
        memory.set_bit(SYSTEM1_EMPTY, False)
        memory.set_bit(SYSTEM2_EMPTY, not backup)
        memory.set_bit(USER_EMPTY, not user)
        memory.set_bit(BACKED_UP, backup == own)

    # battery

    def breset(self) -> None:
        """BRESET: nothing is backed by the battery any more, until the next power-up."""
        self._has_battery = self._follows = False
        self._write(dict.fromkeys(self._battery_names()))

    def follow_in_time(self) -> None:
        """Write battery-backed memory if the last time is long enough ago."""
        if self._follows and self._is_due:
            self._follow(values=True)

    def follow(self) -> None:
        """Write what has changed of battery-backed memory: texts and sizes at once."""
        if self._follows:
            shape = self._present_shape()
            self._follow(values=self._is_due or shape != self._shape)
            self._shape = shape

    @property
    def _is_due(self) -> bool:
        lived_s = (self._system.card.tick - self._written_tk) * self._system.card.period_s
        return not 0.0 <= lived_s < VALUES_EVERY_S  # REBOOT begins to count anew

    def _follow(self, *, values: bool) -> None:
        system = self._system
        changes: dict[str, Image | None] = {}
        for owner in sorted(system.programs.changed):
            changes[f"{BATTERY_TEXT}{owner}"] = self._text_image(owner)
        if values:
            data = user_memory.take_data(system, values=True)
            content = msgspec.msgpack.encode(Battery(data, list(system.setup.config)))
            self._written_tk = system.card.tick
            if content != self._stored:
                changes[BATTERY] = Image(FORMAT, content)
                self._stored = content
        if changes:
            self._write_battery(changes)
        system.programs.changed.clear()

    def _write_battery(self, changes: Mapping[str, Image | None]) -> None:
        try:
            self.images.write(changes, flush=False)
        except StoreError as failure:
            self._follows = False
            self.notice(f"battery-backed memory is not stored any more: {failure}")

    def _text_image(self, owner: int) -> Image | None:
        if self._system.programs.is_empty(owner):
            return None
        text = user_memory.take_text(self._system, owner, self._memos[owner])
        return Image(FORMAT, msgspec.msgpack.encode(text))

    def _present_shape(self) -> object:
        """Everything but values and text: it changes with every DIM, #DEFINE, CONFIG, ..."""
        system, rows = self._system, self._system.card.memory.I
        strings = system.storage.locals.strings
        sizes = array("i", rows[at.STI_BASE : at.STI_BASE + at.ST_COUNT * at.STI_STRIDE])
        for place in range(at.STI_CODE_BYTES, len(sizes), at.STI_STRIDE):
            sizes[place] = 0  # follows from the text
        return (
            sizes.tobytes(),
            rows[at.SMI_BASE : at.SMI_BASE + at.SM_COUNT * at.SMI_STRIDE].tobytes(),
            rows[at.SYSI_BASE + at.SYSI_P_COUNT],
            tuple(system.aliases.lines()),
            system.programs.password,
            system.setup.config,
            tuple(each.bytes for each in strings),
        )

    def _battery_names(self) -> list[str]:
        return [name for name in self.images.names() if name.startswith(BATTERY)]

    def _power_up_battery(self) -> tuple[str, ...] | None:
        """Bring back battery-backed memory; CONFIG as it was kept there."""
        names = self._battery_names()
        if not names:
            return None
        memory = self._decoded(BATTERY, Battery)
        texts = [self._decoded(name, Text) for name in names if name != BATTERY]
        found = [text for text in texts if text is not None]
        if memory is None or len(found) != len(names) - 1:
            self.notice("battery-backed memory is lost: the card starts with defaults")
            self._write(dict.fromkeys(names))
            return None
        self._put_user_memory(UserMemory(found, memory.data))
        return tuple(memory.config)

    # images

    def state(self) -> dict[str, tuple[int, bytes]]:
        """What is stored beside the battery, for a snapshot."""
        found = {}
        for name in self.images.names():
            if not name.startswith(BATTERY) and (data := self._read(name)) is not None:
                found[name] = (FORMAT, data)
        return found

    def restore(self, state: Mapping[str, tuple[int, bytes]]) -> None:
        """Take over what `state` returned."""
        gone = [n for n in self.images.names() if n not in state and not n.startswith(BATTERY)]
        changes: dict[str, Image | None] = dict.fromkeys(gone)
        self._write(changes | {name: Image(*held) for name, held in state.items()})

    def close(self) -> None:
        """Write what is left and let go of the data folder."""
        if self._follows:
            self._follow(values=True)
        self._follows = False
        self.images.close()

    def _read(self, name: str) -> bytes | None:
        """The bytes of an image; one that is damaged is not there, with a notice."""
        try:
            image = self.images.read(name)
            return None if image is None else needs_version(name, image, FORMAT)
        except StoreError as damage:
            self.notice(f"{damage}; defaults are used instead")
            return None

    def _decoded(self, name: str, kind: type[_Kind]) -> _Kind | None:
        data = self._read(name)
        if data is None:
            return None
        try:
            return msgspec.msgpack.decode(data, type=kind)
        except msgspec.MsgspecError as error:
            self.notice(f"the stored {name} cannot be read: {error}")
            return None

    def notice(self, text: str) -> None:
        """Keep what whoever switched the card on should know."""
        if text not in self.notices:
            self.notices.append(text)
            if self._is_up:
                log.warning("%s", text)

    def _write(self, changes: Mapping[str, Image | None]) -> None:
        try:
            self.images.write(changes)
        except StoreError as failure:
            self.notice(str(failure))
            raise CardError(SAVE_FAILED) from None
