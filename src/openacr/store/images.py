"""Images: the stored data of a card by name, independent of the storage."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from hashlib import blake2b
from typing import Protocol

from openacr.errors import StoreError

DIGEST_BYTES = 16


@dataclass(frozen=True, slots=True)
class Image:
    """Stored bytes and the version of their format."""

    version: int
    data: bytes

    @property
    def digest(self) -> bytes:
        """Fingerprint that reveals damage."""
        head = self.version.to_bytes(8, "little", signed=True)
        return blake2b(head + self.data, digest_size=DIGEST_BYTES).digest()


class Images(Protocol):
    """A storage of images."""

    @property
    def is_durable(self) -> bool:
        """Whether they outlast the process."""

    def names(self) -> list[str]:
        """The names of all images, including damaged ones."""

    def read(self, name: str) -> Image | None:
        """Read one image, None if absent; StoreError if it is damaged."""

    def write(self, changes: Mapping[str, Image | None], *, flush: bool = True) -> None:
        """Store images and delete those given as None: either all of them or none.

        Once this returns they survive the end of the process, with `flush` also a power cut.
        """

    def close(self) -> None:
        """Release the storage."""


class Scratch:
    """Images in the memory of the process, for a card without a data folder."""

    is_durable = False

    def __init__(self) -> None:
        self._images: dict[str, Image] = {}

    def names(self) -> list[str]:
        """The names of all images."""
        return sorted(self._images)

    def read(self, name: str) -> Image | None:
        """Read one image, None if absent."""
        return self._images.get(name)

    def write(self, changes: Mapping[str, Image | None], *, flush: bool = True) -> None:
        """Store images and delete those given as None."""
        merged: dict[str, Image | None] = {**self._images, **changes}
        self._images = {name: image for name, image in merged.items() if image is not None}

    def close(self) -> None:
        """Do nothing: there is nothing to release."""


def needs_version(name: str, image: Image, version: int) -> bytes:
    """The bytes of an image; StoreError unless it has the supported version."""
    if image.version != version:
        raise StoreError(
            f"the stored {name} has format {image.version}, this program reads format {version}"
        )
    return image.data
