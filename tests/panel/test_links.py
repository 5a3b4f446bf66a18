"""Held keys over links that freeze, break and come back late, in real time with real sockets.

No test asserts a time: each waits for what has to come, and then that nothing more comes.
"""

import asyncio
import json
import os
import signal
import struct
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from typing import Any

import pytest
import websockets
from tests.panel.bench import LIMIT_S, Client, Served
from tests.proxy import Proxy

from openacr.panel.control.place import read_place
from openacr.panel.control.station import Station


def until(holds: Callable[[], bool]) -> None:
    end_s = time.monotonic() + LIMIT_S
    while not holds():
        assert time.monotonic() < end_s
        time.sleep(0.02)


def is_moving(panel: Served) -> bool:
    return panel.call(lambda station: station.machine.machine.is_jogging())


def place(panel: Served) -> tuple[float, ...]:
    return panel.call(_commanded)


def _commanded(station: Station) -> tuple[float, ...]:
    machine = station.machine
    return read_place(machine.runner.settings, machine.machine.read_rows).commanded


def held(panel: Served) -> bool:
    return panel.call(lambda station: station.hand_motion.presses.are_held)


class Finger:
    """A browser that holds a key down: it presses once and keeps the press alive."""

    def __init__(self, client: Client) -> None:
        self.client = client
        self._tasks: list[asyncio.Task[None]] = []

    async def press(self) -> None:
        """Hold the key until its axis has moved; on a busy computer it is pressed again."""
        client = self.client
        await client.do("sub", topic="status", hz=50)
        await client.wait(lambda: any(frame[2] for frame in client.frames))
        number, begin = 0, self._place()
        while self._place() < begin + 0.2:
            await self.lift()
            number += 1
            args = {"axis": "X", "direction": 1, "first": True, "tick": client.tick}
            answer = await client.do("jog.press", press=number, **args)
            if not answer["ok"]:
                continue  # the picture was too old
            self._tasks = [
                asyncio.create_task(self._keep(number)),
                asyncio.create_task(self._draw()),
            ]
            while self._place() < begin + 0.2 and not self._has_ended(number):
                await asyncio.sleep(0.02)

    def _place(self) -> float:
        return float(struct.unpack_from("<d", self.client.frames[-1], 112 + 24)[0])

    def _has_ended(self, number: int) -> bool:
        return any(event["press"] == number for event in self.client.named("jog"))

    async def _keep(self, number: int) -> None:
        with suppress(websockets.exceptions.ConnectionClosed, OSError):
            while True:
                sign = {"keep": number, "tick": self.client.tick}
                await self.client._socket.send(json.dumps(sign))
                await asyncio.sleep(0.03)

    async def _draw(self) -> None:
        with suppress(websockets.exceptions.ConnectionClosed, OSError, TimeoutError):
            while True:
                await self.client.take()

    async def lift(self) -> None:
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)


def scene(panel: Served, what: Callable[[Proxy, Finger], Any]) -> None:
    """A finger on X through a proxy; what happens then."""

    async def run() -> None:
        with Proxy(f"127.0.0.1:{panel.port}") as proxy:
            socket = await websockets.connect(proxy.ws_url, ping_interval=None, close_timeout=0.1)
            finger = Finger(Client(socket))
            await finger.press()
            await what(proxy, finger)
            await finger.lift()
            socket.transport.abort()

    asyncio.run(run())


async def rests_for_good(panel: Served) -> None:
    """No key is held any more, the axis comes to rest and does not begin again."""
    await asyncio.to_thread(until, lambda: not held(panel))
    await asyncio.to_thread(until, lambda: not is_moving(panel))
    at = place(panel)
    await asyncio.sleep(0.6)
    assert place(panel) == at
    assert not is_moving(panel)


@pytest.mark.parametrize("direction", ["freeze_up", "freeze_down", "freeze"])
def test_a_frozen_link_stops_the_axis_and_a_late_thaw_moves_nothing(
    panel: Served, direction: str
) -> None:
    async def what(proxy: Proxy, finger: Finger) -> None:
        getattr(proxy, direction)()
        await rests_for_good(panel)
        proxy.thaw()  # all the signs that were held back arrive, and the finger is still down
        await rests_for_good(panel)

    scene(panel, what)


@pytest.mark.parametrize("how", ["cut", "reset"])
def test_a_broken_link_stops_the_axis(panel: Served, how: str) -> None:
    async def what(proxy: Proxy, finger: Finger) -> None:
        getattr(proxy, how)()
        await rests_for_good(panel)
        assert panel.call(lambda station: station.people.holder) is None

    scene(panel, what)


def test_a_release_that_is_lost_stops_the_axis_as_well(panel: Served) -> None:
    async def what(proxy: Proxy, finger: Finger) -> None:
        proxy.freeze_up()
        await finger.lift()  # its release never arrives
        await rests_for_good(panel)

    scene(panel, what)


def test_another_browser_stops_what_a_frozen_one_moves(panel: Served) -> None:
    async def what(proxy: Proxy, finger: Finger) -> None:
        async with websockets.connect(panel.ws_url) as socket:
            assert (await Client(socket).do("stop.hold"))["ok"]
        await rests_for_good(panel)

    scene(panel, what)


HOLDER = """
import asyncio, sys
sys.path.insert(0, sys.argv[2])
import websockets
from tests.panel.bench import Client
from tests.panel.test_links import Finger

async def main():
    async with websockets.connect(sys.argv[1]) as socket:
        finger = Finger(Client(socket))
        await finger.press()
        print("held", flush=True)
        await asyncio.sleep(600)

asyncio.run(main())
"""


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGSTOP])
def test_a_browser_that_is_killed_or_suspended_stops_the_axis(
    panel: Served, number: signal.Signals, request: pytest.FixtureRequest
) -> None:
    root = str(request.config.rootpath)
    browser = subprocess.Popen(
        [sys.executable, "-c", HOLDER, panel.ws_url, root],
        stdout=subprocess.PIPE,
        env={**os.environ, "PYTHONPATH": f"{root}:{root}/src"},
    )
    try:
        assert browser.stdout is not None
        assert browser.stdout.readline() == b"held\n"
        browser.send_signal(number)
        asyncio.run(rests_for_good(panel))
        if number is signal.SIGSTOP:
            browser.send_signal(signal.SIGCONT)
            asyncio.run(rests_for_good(panel))
    finally:
        browser.kill()
        browser.wait(LIMIT_S)
        browser.stdout.close()  # type: ignore[union-attr]
