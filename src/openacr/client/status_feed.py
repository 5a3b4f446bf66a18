"""Receive the fast status of a card over UDP: the words that FSTAT copies."""

import socket
import time
from collections.abc import Generator

from openacr.client.causes import cannot_connect
from openacr.client.errors import ConnectionLostError, NoReplyError
from openacr.closing import Closing
from openacr.errors import UserError, reason
from openacr.protocol.status import (
    LIFE_S,
    LONGEST_MS,
    SHORTEST_MS,
    STATUS_BYTES,
    STATUS_PORT,
    FastStatus,
    StatusRequest,
)

RENEW_S = LIFE_S / 4


class StatusFeed(Closing):
    """A subscription: `for status in StatusFeed(host): print(status.longs(0))`.

    FSTAT on the card defines the words. Datagrams may be lost; those that arrive are in
    order within one network. `interval_s` is 0.01 to 60; `timeout_s` without any: NoReplyError.
    """

    def __init__(
        self,
        host: str,
        port: int = STATUS_PORT,
        *,
        interval_s: float = 0.01,
        timeout_s: float = 5.0,
    ) -> None:
        self._interval_ms = round(interval_s * 1000)
        if not SHORTEST_MS <= self._interval_ms <= LONGEST_MS:
            longest_s = LONGEST_MS // 1000
            raise UserError(
                f"interval {interval_s:g} s is not in {SHORTEST_MS / 1000}..{longest_s}"
            )
        self.name = f"{host}:{port}/udp"
        self._timeout_s = timeout_s
        try:
            found = socket.getaddrinfo(host, port, type=socket.SOCK_DGRAM)
            family, kind, *_, address = found[0]
            self._socket = socket.socket(family, kind)
        except (OSError, OverflowError) as failure:
            raise cannot_connect(self.name, failure) from None
        try:
            self._socket.connect(address)  # accept datagrams of the card alone
            self._ask(is_on=True)
        except (OSError, ConnectionLostError) as failure:
            self._socket.close()
            raise ConnectionLostError(f"{self.name}: {failure}") from None

    def _ask(self, *, is_on: bool) -> None:
        request = StatusRequest(is_on, self._interval_ms if is_on else 0)
        try:
            self._socket.send(request.encode())
        except OSError as failure:
            raise ConnectionLostError(f"{self.name}: {reason(failure)}") from None
        self._asked_s = time.monotonic()

    def __iter__(self) -> Generator[FastStatus, None, None]:
        """Yield every status that arrives, until the feed is closed."""
        while True:
            yield self.read()

    def read(self) -> FastStatus:
        """Return the next status; NoReplyError if none arrives in time, ConnectionLostError."""
        deadline_s = time.monotonic() + max(self._timeout_s, 2 * self._interval_ms / 1000)
        while (left_s := deadline_s - time.monotonic()) > 0:
            if time.monotonic() - self._asked_s > RENEW_S:
                self._ask(is_on=True)
            self._socket.settimeout(min(left_s, RENEW_S))
            try:
                status = FastStatus.decode(self._socket.recv(STATUS_BYTES + 1))
            except TimeoutError:
                continue
            except OSError as failure:
                raise ConnectionLostError(f"{self.name}: {reason(failure)}") from None
            if status is not None:
                return status
        raise NoReplyError(self.name, "the subscription of the status", self._timeout_s)

    def close(self) -> None:
        """End the subscription."""
        if self._socket.fileno() >= 0:
            try:
                self._ask(is_on=False)
            except ConnectionLostError:
                pass  # it ends by itself
            self._socket.close()
