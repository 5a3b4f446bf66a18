"""The stored images of a card: damaged images count as absent, failures are reported."""

from __future__ import annotations

import logging
from collections.abc import Mapping
from pathlib import Path
from typing import TypeVar

import msgspec

from openacr.errors import CardError, StoreError
from openacr.messages import SAVE_FAILED
from openacr.store import Database, Image, Images, Scratch
from openacr.store.images import needs_version

log = logging.getLogger(__name__)

UNREADABLE = "unreadable "  # prefix of the names of images this version cannot read
FORMAT = 1  # of all images; one of another format counts as damaged
_Kind = TypeVar("_Kind")


class ImageStore:
    """The images of one card, with notices for the operator who switched it on."""

    def __init__(self, images: Images) -> None:
        self.images = images
        self.notices: list[str] = []
        self.losses: list[str] = []  # losses that hosts have to know about
        self.is_up = False  # before power-up is complete, the caller reports the notices

    @classmethod
    def in_folder(cls, folder: Path | None) -> ImageStore:
        """The images in a data folder; without a folder, kept in this process."""
        if folder is None:
            return cls(Scratch())
        images, damage = Database.open(folder)
        store = cls(images)
        if damage is not None:
            store.lost(damage)
        return store

    def notice(self, text: str) -> None:
        """Add a message for the operator; logged as well once the card is up."""
        if text not in self.notices:
            self.notices.append(text)
            if self.is_up:
                log.warning("%s", text)

    def lost(self, text: str) -> None:
        """Report that stored data is lost, also to hosts that connect from now on."""
        self.notice(text)
        self.losses.append(text)

    def names(self, prefix: str = "") -> list[str]:
        """The names of the images that begin with `prefix`."""
        return [name for name in self.images.names() if name.startswith(prefix)]

    def read(self, name: str) -> bytes | None:
        """The bytes of an image; a damaged one counts as absent and is reported."""
        try:
            image = self.images.read(name)
            return None if image is None else needs_version(name, image, FORMAT)
        except StoreError as damage:
            self.lost(f"{damage}; defaults are used instead")
            return None

    def decoded(self, name: str, kind: type[_Kind]) -> _Kind | None:
        """The decoded content of an image; one of another type counts as absent and is reported."""
        data = self.read(name)
        if data is None:
            return None
        try:
            return msgspec.msgpack.decode(data, type=kind)
        except msgspec.MsgspecError as error:
            aside = f"{UNREADABLE}{name}"
            self.write({aside: data})
            self.lost(f"the stored {name} cannot be read ({error}); it was kept as {aside!r}")
            return None

    def write(self, changes: Mapping[str, bytes | None], *, flush: bool = True) -> None:
        """Store or delete images, all or none; CardError `Save failed` if impossible."""
        images = {
            name: None if data is None else Image(FORMAT, data) for name, data in changes.items()
        }
        try:
            self.images.write(images, flush=flush)
        except StoreError as failure:
            self.notice(str(failure))
            raise CardError(SAVE_FAILED) from None
