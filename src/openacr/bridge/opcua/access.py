"""Who may connect and what may be written: a user with a password, values the file lists."""

import hmac
from collections.abc import Mapping
from typing import Any

from asyncua import ua
from asyncua.crypto.permission_rules import User, UserRole
from asyncua.server.address_space import AddressSpace, AttributeService

from openacr.bridge.items import Item
from openacr.bridge.opcua.trust import Trusted
from openacr.bridge.writing import KindError, RangeError, Writer
from openacr.errors import UserError

WRITER = "OPC UA"


class Users:
    """One user; without a password every host that reaches the port. None is an administrator."""

    def __init__(self, name: str, secret: str | None, trusted: Trusted | None = None) -> None:
        self._name, self._secret, self._trusted = name, secret, trusted

    def get_user(
        self,
        iserver: Any,
        username: str | None = None,
        password: str | bytes | None = None,
        certificate: object = None,
    ) -> User | None:
        """The user of a session; None refuses it. The certificate is that of its channel."""
        if self._trusted is not None and not self._trusted.admits(certificate):
            return None
        if self._secret is None:
            return User(UserRole.User, username)
        given = password.encode() if isinstance(password, str) else password or b""
        is_right = hmac.compare_digest(given, self._secret.encode())
        return User(UserRole.User, username) if is_right and username == self._name else None


class Attributes(AttributeService):  # type: ignore[misc]
    """Reads as the library does; writes only values that the bridge file lists."""

    def __init__(
        self, space: AddressSpace, items: Mapping[ua.NodeId, Item], writer: Writer
    ) -> None:
        super().__init__(space)
        self._items, self._writer = items, writer

    async def write(
        self, params: ua.WriteParameters, user: User | None = None
    ) -> list[ua.StatusCode]:
        """Write; a status code for each value. The server itself is the only administrator."""
        if user is not None and user.role is UserRole.Admin:
            return list(await super().write(params, user))
        return [ua.StatusCode(await self._code_of(each)) for each in params.NodesToWrite]

    async def _code_of(self, asked: ua.WriteValue) -> Any:
        """Carry a write out; what became of it."""
        item, codes = self._items.get(asked.NodeId), ua.StatusCodes
        if item is None or asked.AttributeId != ua.AttributeIds.Value or asked.IndexRange:
            return codes.BadUserAccessDenied
        given = asked.Value.Value
        if item.chosen is None or not item.chosen.write:
            return codes.BadNotWritable
        if given is None or given.is_array:
            return codes.BadTypeMismatch
        try:
            await self._writer.write(item, given.Value, WRITER)
        except KindError:
            return codes.BadTypeMismatch
        except RangeError:
            return codes.BadOutOfRange
        except UserError:
            return codes.BadDeviceFailure
        return codes.Good
