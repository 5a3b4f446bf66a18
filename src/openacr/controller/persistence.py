"""The non-volatile memory of a card: saved parameters, user flash and battery-backed memory.

    image       written                                   read
    battery     while the card runs (`battery.py`)        power-up
    flash       FLASH SAVE, FLASH IMAGE                   power-up, REBOOT, FLASH LOAD
    parameters  ESAVE                                     power-up, REBOOT, ELOAD

At power-up they are read in this order, each overwriting the one before. A damaged image
counts as absent, and `notices` reports it.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any
from zlib import crc32

import msgspec

from openacr.basic.execute.system import System
from openacr.basic.memory import saved, user_memory
from openacr.basic.memory.setup import Setup
from openacr.basic.memory.user_memory import UserMemory
from openacr.controller.battery import BATTERY, Battery
from openacr.controller.image_store import UNREADABLE, ImageStore
from openacr.errors import CardError, StoreError
from openacr.map import numbers as at
from openacr.motion.axis import modules

# Work of the commands, in the units of `streams.py`.
SAVE_WORK = 2000  # ESAVE
LOAD_WORK = 5500  # ELOAD
SAVED_LINE_WORK = 25  # FLASH SAVE and FLASH IMAGE, for each line of a program or PLC
LOADED_LINE_WORK = 60  # FLASH LOAD

CARD, FLASH, PARAMETERS, STREAM_MODES, BACKUP = "card", "flash", "parameters", "streams", "firmware"
NO_BATTERY = "no battery"  # in snapshots: BRESET was given
BOOT_EMPTY, SYSTEM1_EMPTY, SYSTEM2_EMPTY, USER_EMPTY, BACKED_UP = range(5656, 5661)


class Persistence:
    """The non-volatile memory of one card, as the commands of that group use it."""

    def __init__(self, system: System, store: ImageStore) -> None:
        self._system, self.store = system, store
        system.nonvolatile = self
        self.battery = Battery(system, store)
        self._claim()

    @classmethod
    def open(cls, system: System, folder: Path | None) -> Persistence:
        """The non-volatile memory in a data folder; without a folder, kept in this process."""
        store = ImageStore.in_folder(folder)
        try:
            return cls(system, store)
        except (StoreError, CardError) as error:
            store.images.close()
            raise StoreError(f"{folder}: {error}") from None

    @property
    def notices(self) -> list[str]:
        """Messages for the operator who switched the card on, as sentences."""
        return self.store.notices

    def _claim(self) -> None:
        """Refuse data stored by another model."""
        name = self._system.card.model.name.encode()
        known = self.store.read(CARD)
        if known is not None and known != name:
            raise StoreError(
                f"this data was stored by an {known.decode()}, the card is an {name.decode()}"
            )
        if known is None:
            self.store.write({CARD: name})

    # power-up

    def power_up(self) -> None:
        """Restore the stored contents, after the card has been set to its defaults."""
        config = None
        if backed := self.battery.stored():
            memory, config = backed
            self._put_user_memory(memory)
        self._load(config)
        self.battery.follow()
        self.store.is_up = True
        for text in self.store.losses:
            for session in self._system.sessions.values():
                session.announcements.append(f"Warning: {text}")

    def restart(self) -> None:
        """Restore the stored contents at REBOOT; battery-backed memory is still present."""
        self._load(self._system.setup.config if self.battery.is_on else None)

    def _load(self, config: tuple[str, ...] | None) -> None:
        """Load flash, then parameters; CONFIG comes from the battery if present."""
        self.flash_load()
        self._system.setup = Setup()
        self.eload()
        modes = self.store.decoded(STREAM_MODES, list[int])
        if modes is not None:
            saved.put_stream_modes(self._system, modes)
        if config is not None:
            self._system.setup.configure(config)
        modules.fit(self._system.card, self._system.setup.config)

    def _put_user_memory(self, image: UserMemory) -> None:
        try:
            refused = user_memory.put(self._system, image)
        except (CardError, ValueError, TypeError, LookupError) as error:
            self._system.forget()
            refused = [str(error)]
        self._say(refused)

    def _say(self, refused: list[str]) -> None:
        for line in refused:
            self.store.notice(f"not restored: {line}")

    # parameters

    def esave(self) -> None:
        """ESAVE."""
        parameters = msgspec.msgpack.encode(saved.take(self._system))
        modes = msgspec.msgpack.encode(saved.take_stream_modes(self._system))
        self.store.write({PARAMETERS: parameters, STREAM_MODES: modes})
        self._system.card.memory.work += SAVE_WORK

    def eload(self) -> None:
        """Load the saved parameters (ELOAD); without any, nothing changes."""
        parameters = self.store.decoded(PARAMETERS, dict[str, Any])
        if parameters is not None:
            self._say(saved.put(self._system, parameters))
            self._system.card.memory.work += LOAD_WORK

    def erase(self) -> None:
        """Erase the saved parameters (ERASE); start-up modes of streams remain."""
        self.store.write({PARAMETERS: None})

    # flash and battery

    def flash_save(self, *, values: bool) -> None:
        """Store user memory in flash: FLASH SAVE, or FLASH IMAGE with values."""
        image = user_memory.take(self._system, values=values)
        self.store.write({FLASH: msgspec.msgpack.encode(image)})
        self._system.card.memory.work += SAVED_LINE_WORK * image.line_count

    def flash_load(self) -> None:
        """Load user memory from flash (FLASH LOAD); an empty flash loads nothing."""
        flash = self.store.decoded(FLASH, UserMemory)
        if flash is not None:
            self._put_user_memory(flash)
            self._system.card.memory.work += LOADED_LINE_WORK * flash.line_count

    def flash_erase(self) -> None:
        """Erase the user flash (FLASH ERASE)."""
        self.store.write({FLASH: None})

    def breset(self) -> None:
        """BRESET."""
        self.battery.disable()

    # firmware

    def firmware_backup(self) -> None:
        """Copy system flash 1 to system flash 2 (FIRMWARE BACKUP)."""
        self.store.write({BACKUP: self._firmware})
        self._system.card.memory.set_bit(BACKED_UP, True)

    def firmware_checksum(self) -> None:
        """Update versions, checksums and flags of all four flash memories (FIRMWARE CHECKSUM)."""
        memory, own = self._system.card.memory, self._firmware
        backup, user = self.store.read(BACKUP) or b"", self.store.read(FLASH) or b""
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

    @property
    def _firmware(self) -> bytes:
        """The firmware content of the flash memories: the version alone."""
        return self._system.card.model.firmware.encode()

    # snapshots and the end

    def state(self) -> dict[str, bytes]:
        """The stored images other than the battery, for a snapshot."""
        found = {name: self.store.read(name) for name in self._others()}
        state = {name: data for name, data in found.items() if data is not None}
        is_reset = self._system.card.model.has_battery and not self.battery.is_on
        return state | ({NO_BATTERY: b""} if is_reset else {})

    def restore(self, state: Mapping[str, bytes]) -> None:
        """Restore what `state` returned."""
        gone: dict[str, bytes | None] = dict.fromkeys(self._others())
        wanted = {name: data for name, data in state.items() if name != NO_BATTERY}
        self.store.write(gone | wanted)
        self.battery.enable()
        if NO_BATTERY in state:
            self.battery.disable()

    def _others(self) -> list[str]:
        others = (BATTERY, UNREADABLE)
        return [name for name in self.store.names() if not name.startswith(others)]

    def close(self) -> None:
        """Write everything not yet stored and release the data folder."""
        self.battery.close()
        self.store.images.close()
