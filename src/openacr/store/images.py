"""Images: what a card has stored, by name, whatever they are stored on."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from hashlib import blake2b
from typing import Protocol

from openacr.errors import StoreError

DIGEST_BYTES = 16


@dataclass(frozen=True, slots=True)
class Image:
    """Stored bytes and the version of what they say."""

    version: int
    data: bytes

    @property
    def digest(self) -> bytes:
        """Fingerprint by which damage is found."""
        head = self.version.to_bytes(8, "little", signed=True)
        return blake2b(head + self.data, digest_size=DIGEST_BYTES).digest()


class Images(Protocol):
    """Where images are kept."""

    @property
    def is_durable(self) -> bool:
        """Whether they outlast the process."""

    def names(self) -> list[str]:
        """What there is, damaged ones included."""

    def read(self, name: str) -> Image | None:
        """One image, None if there is none; StoreError if it is damaged."""

    def write(self, changes: Mapping[str, Image | None], *, flush: bool = True) -> None:
        """Store images and delete those given as None: all of them, or none at all.

        Once this returns they outlast the end of the process, with `flush` also a power cut.
        """

    def close(self) -> None:
        """Let go of what they are stored on."""


class Scratch:
    """Images in the memory of the process, for a card without a data folder."""

    is_durable = False

    def __init__(self) -> None:
        self._images: dict[str, Image] = {}

    def names(self) -> list[str]:
        """What there is."""
        return sorted(self._images)

    def read(self, name: str) -> Image | None:
        """One image, None if there is none."""
        return self._images.get(name)

    def write(self, changes: Mapping[str, Image | None], *, flush: bool = True) -> None:
        """Store images and delete those given as None."""
        merged: dict[str, Image | None] = {**self._images, **changes}
        self._images = {name: image for name, image in merged.items() if image is not None}

    def close(self) -> None:
        """Nothing has to be let go."""


def needs_version(name: str, image: Image, version: int) -> bytes:
    """The bytes of an image of the version that can be read; StoreError for any other."""
    if image.version != version:
        raise StoreError(
            f"the stored {name} has format {image.version}, this program reads format {version}"
        )
    return image.data
