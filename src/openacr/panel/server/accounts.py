"""Passwords of roles, and the log-ins they give: a random token in a cookie.

Passwords are kept as salted scrypt hashes in a file beside the store; without the file
every user of this computer may do everything, except what the password of the store guards.
"""

import hashlib
import hmac
import json
import logging
import os
import secrets
import time
from dataclasses import dataclass
from pathlib import Path

from openacr.errors import UserError
from openacr.panel.roles import Role
from openacr.panel.server.delays import Delays
from openacr.sysvar import Store, password

log = logging.getLogger(__name__)
LASTS_S = 12 * 3600.0
MOST_SESSIONS = 1000
SHORTEST = 8
_COST = {"n": 1 << 14, "r": 8, "p": 1}


@dataclass(frozen=True, slots=True)
class Session:
    """A log-in."""

    role: Role
    until_s: float


class Accounts:
    """The roles that have a password, and who is logged in."""

    def __init__(self, file: Path | None, store: Store) -> None:
        self._file = file
        self._store = store
        self._hashes = _read(file)
        self._sessions: dict[str, Session] = {}
        self.delays = Delays()

    @property
    def are_asked(self) -> bool:
        """Whether a log-in is needed at all."""
        return bool(self._hashes)

    @property
    def anonymous(self) -> Role | None:
        """The role without a log-in; None: nothing is shown."""
        if self._hashes:
            return None
        return Role.SETUP if password.is_asked(self._store) else Role.SERVICE

    def set_password(self, role: Role, secret: str) -> None:
        """Set the password of a role, or remove it with an empty one."""
        if self._file is None:
            raise UserError("a store in memory has no passwords")
        if secret and len(secret) < SHORTEST:
            raise UserError(f"a password has {SHORTEST} characters at least")
        if secret:
            self._hashes[role.word] = _hashed(secret, os.urandom(16))
        else:
            self._hashes.pop(role.word, None)
        _write(self._file, self._hashes)

    # --- log-in -----------------------------------------------------------------------

    def is_right(self, role: Role, secret: str) -> bool:
        """Whether this is the password of a role; it takes about 50 ms."""
        kept = self._hashes.get(role.word)
        if kept is not None:
            salt = bytes.fromhex(kept.partition("$")[0])
            return hmac.compare_digest(_hashed(secret, salt), kept)
        if role is Role.SERVICE and password.is_asked(self._store):
            return password.is_right(self._store, secret)
        return not self._hashes and role <= (self.anonymous or Role.VIEW)

    def note_failure(self, role: Role, address: str, now_s: float) -> None:
        """Note a wrong password: the next try of this address has to wait."""
        tries = self.delays.note_failure(address, now_s)
        log.warning("wrong password for role %s from %s (%d)", role.word, address, tries)

    def begin(self, role: Role, address: str, now_s: float) -> str:
        """Begin a session; returns its token."""
        self.delays.forget(address)
        self._sessions = {k: s for k, s in self._sessions.items() if s.until_s > now_s}
        while len(self._sessions) >= MOST_SESSIONS:
            del self._sessions[next(iter(self._sessions))]
        token = secrets.token_urlsafe(32)
        self._sessions[token] = Session(role, now_s + LASTS_S)
        return token

    def end(self, token: str) -> None:
        """End a session."""
        self._sessions.pop(token, None)

    def role_of(self, token: str | None, now_s: float | None = None) -> Role | None:
        """The role of a token; that without a log-in where there is none."""
        now_s = time.monotonic() if now_s is None else now_s
        session = self._sessions.get(token or "")
        if session is not None and session.until_s > now_s:
            return session.role
        return self.anonymous


def file_of(store: Path | None) -> Path | None:
    """The file of the passwords of a store."""
    return None if store is None else store.with_name(store.name + "-panel")


def _hashed(secret: str, salt: bytes) -> str:
    made = hashlib.scrypt(secret.encode(), salt=salt, dklen=32, **_COST)
    return f"{salt.hex()}${made.hex()}"


def _read(file: Path | None) -> dict[str, str]:
    if file is None or not file.exists():
        return {}
    try:
        found = json.loads(file.read_text("utf-8"))
        return {Role.of(word).word: str(kept) for word, kept in found.items()}
    except (OSError, ValueError, AttributeError) as error:
        raise UserError(
            f"{file}: the passwords of the panel cannot be read ({error}); without them the panel"
            " does not start"
        ) from None


def _write(file: Path, hashes: dict[str, str]) -> None:
    partial = file.with_name(file.name + ".part")
    try:
        descriptor = os.open(partial, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600)
        with os.fdopen(descriptor, "w") as opened:
            json.dump(hashes, opened)
        partial.replace(file)
    except OSError as error:
        raise UserError(f"{file}: cannot be written: {error.strerror}") from None
