"""Non-volatile storage: named images of bytes, each verified, each save atomic."""

from openacr.store.database import Database
from openacr.store.images import Image, Images, Scratch
from openacr.store.lock import FolderLock, InUseError

__all__ = ["Database", "FolderLock", "Image", "Images", "InUseError", "Scratch"]
