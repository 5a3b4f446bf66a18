"""A served fake card in a thread, for tests of blocking clients."""

import asyncio
import threading
from collections.abc import Iterator
from contextlib import contextmanager

from tests.io.fake_card import FakeCard
from tests.io.served import LOOPBACK

from openacr.channels import StreamKind
from openacr.io.server import Address, CardServer

WAIT_S = 60.0


@contextmanager
def served(card: FakeCard) -> Iterator[Address]:
    """The address of the card's terminal port while the block runs."""
    ready, found = threading.Event(), list[Address]()
    stop, loop = asyncio.Event(), asyncio.new_event_loop()

    async def body() -> None:
        server = CardServer(card)
        found.append(await server.listen(StreamKind.TERMINAL, LOOPBACK, 0))
        ready.set()
        await server.run(stop)

    thread = threading.Thread(target=lambda: loop.run_until_complete(body()))
    thread.start()
    try:
        assert ready.wait(WAIT_S)
        yield found[0]
    finally:
        loop.call_soon_threadsafe(stop.set)
        thread.join(WAIT_S)
        loop.close()
