"""The service password: stored as a salted scrypt hash, compared in constant time."""

import hashlib
import hmac
import os

from openacr.errors import UserError
from openacr.sysvar.store import Store
from openacr.sysvar.tabs import GENERAL

CELL = GENERAL.password_hash
_SALT_BYTES, _HASH_BYTES = 16, 32
_COST = {"n": 1 << 14, "r": 8, "p": 1}  # 16 MB and about 50 ms per attempt


def is_asked(store: Store) -> bool:
    """Whether a password protects the system parameters."""
    return bool(store.read_text(CELL))


def is_right(store: Store, password: str) -> bool:
    """Whether this is the password; any is accepted while none is set."""
    kept = store.read_text(CELL)
    if not kept:
        return True
    salt, _, digest = kept.partition("$")
    try:
        made = _hash(password, bytes.fromhex(salt))
    except ValueError:
        return False
    return hmac.compare_digest(made, digest)


def change(store: Store, password: str) -> None:
    """Set the password; an empty one removes it."""
    if password != password.strip():
        raise UserError("a password neither begins nor ends with a blank")
    salt = os.urandom(_SALT_BYTES)
    store.write_text(CELL, f"{salt.hex()}${_hash(password, salt)}" if password else "")


def _hash(password: str, salt: bytes) -> str:
    return hashlib.scrypt(password.encode(), salt=salt, dklen=_HASH_BYTES, **_COST).hex()
