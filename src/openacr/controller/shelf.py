"""Stored images as a card uses them: what is damaged is not there, what fails is said."""

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

UNREADABLE = "unreadable "  # begins the names of images that say nothing to this version
FORMAT = 1  # of all images; one of another format counts as damaged
_Kind = TypeVar("_Kind")


class Shelf:
    """The images of one card, with notices for whoever has switched it on."""

    def __init__(self, images: Images) -> None:
        self.images = images
        self.notices: list[str] = []
        self.losses: list[str] = []  # what hosts have to know
        self.is_up = False  # until then whoever switches the card on says what is found

    @classmethod
    def in_folder(cls, folder: Path | None) -> Shelf:
        """The images in a data folder, without one those of this process alone."""
        if folder is None:
            return cls(Scratch())
        images, damage = Database.open(folder)
        shelf = cls(images)
        if damage is not None:
            shelf.lost(damage)
        return shelf

    def notice(self, text: str) -> None:
        """Keep what whoever switched the card on should know."""
        if text not in self.notices:
            self.notices.append(text)
            if self.is_up:
                log.warning("%s", text)

    def lost(self, text: str) -> None:
        """Say that something stored is gone, also to hosts that connect from now on."""
        self.notice(text)
        self.losses.append(text)

    def names(self, prefix: str = "") -> list[str]:
        """The images whose names begin so."""
        return [name for name in self.images.names() if name.startswith(prefix)]

    def read(self, name: str) -> bytes | None:
        """The bytes of an image; one that is damaged is not there, with a notice."""
        try:
            image = self.images.read(name)
            return None if image is None else needs_version(name, image, FORMAT)
        except StoreError as damage:
            self.lost(f"{damage}; defaults are used instead")
            return None

    def decoded(self, name: str, kind: type[_Kind]) -> _Kind | None:
        """What an image says; one that says something else is not there, with a notice."""
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
        """Store or delete images, all or none; `Save failed` if that is impossible."""
        images = {
            name: None if data is None else Image(FORMAT, data) for name, data in changes.items()
        }
        try:
            self.images.write(images, flush=flush)
        except StoreError as failure:
            self.notice(str(failure))
            raise CardError(SAVE_FAILED) from None
