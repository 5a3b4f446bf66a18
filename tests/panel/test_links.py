"""Held keys over links that freeze, break and come back late, in real time with real sockets.

No test asserts a time: each waits for what has to come, and then that nothing more comes.
"""

import asyncio
import json
import os
import signal
import struct
from collections.abc import Callable
from contextlib import suppress
from multiprocessing import Pipe, get_context
from multiprocessing.connection import Connection
from typing import Any

import pytest
import websockets
from tests.panel.bench import LIMIT_S, Client, Served
from tests.proxy import Proxy
from tests.waiting import until

from openacr.panel.control.machine.place import read_place
from openacr.panel.control.station import Station

LATE_MS = 400.0  # longer than a key is held without a sign


def is_moving(panel: Served) -> bool:
    return panel.call(lambda station: station.link.machine.machine.is_jogging())


def place(panel: Served) -> tuple[float, ...]:
    return panel.call(_commanded)


def _commanded(station: Station) -> tuple[float, ...]:
    machine = station.link.machine
    return read_place(machine.runner.settings, machine.machine.read_rows).commanded


def tick_ms(panel: Served) -> float:
    return panel.call(lambda station: station.snapshot.tick_ms)


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
    at, end_ms = place(panel), tick_ms(panel) + LATE_MS
    await asyncio.to_thread(until, lambda: tick_ms(panel) > end_ms)
    assert place(panel) == pytest.approx(at, abs=1e-9)  # the last setpoint is rounded when it ends
    assert not is_moving(panel)


@pytest.mark.parametrize("direction", ["freeze_up", "freeze_down", "freeze"])
def test_a_frozen_link_stops_the_axis_and_a_late_thaw_moves_nothing(
    one_panel: Served, direction: str
) -> None:
    async def what(proxy: Proxy, finger: Finger) -> None:
        getattr(proxy, direction)()
        await rests_for_good(one_panel)
        proxy.thaw()  # all the signs that were held back arrive, and the finger is still down
        await rests_for_good(one_panel)

    scene(one_panel, what)


@pytest.mark.parametrize("how", ["cut", "reset"])
def test_a_broken_link_stops_the_axis(one_panel: Served, how: str) -> None:
    async def what(proxy: Proxy, finger: Finger) -> None:
        getattr(proxy, how)()
        await rests_for_good(one_panel)
        until(lambda: one_panel.call(lambda station: station.people.holder) is None)

    scene(one_panel, what)


def test_a_release_that_is_lost_stops_the_axis_as_well(one_panel: Served) -> None:
    async def what(proxy: Proxy, finger: Finger) -> None:
        proxy.freeze_up()
        await finger.lift()  # its release never arrives
        await rests_for_good(one_panel)

    scene(one_panel, what)


def test_another_browser_stops_what_a_frozen_one_moves(one_panel: Served) -> None:
    async def what(proxy: Proxy, finger: Finger) -> None:
        async with websockets.connect(one_panel.ws_url) as socket:
            assert (await Client(socket).do("stop.hold"))["ok"]
        await rests_for_good(one_panel)

    scene(one_panel, what)


def hold(url: str, pressed: Connection) -> None:
    """In a process of its own: hold the key until the end of the process."""

    async def held() -> None:
        async with websockets.connect(url) as socket:
            await Finger(Client(socket)).press()
            pressed.send(True)
            await asyncio.sleep(600)

    asyncio.run(held())


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGSTOP])
def test_a_browser_that_is_killed_or_suspended_stops_the_axis(
    one_panel: Served, number: signal.Signals
) -> None:
    is_pressed, pressed = Pipe(duplex=False)
    browser = get_context("spawn").Process(target=hold, args=(one_panel.ws_url, pressed))
    browser.start()
    try:
        assert is_pressed.poll(LIMIT_S)
        assert browser.pid is not None
        os.kill(browser.pid, number)
        asyncio.run(rests_for_good(one_panel))
        if number is signal.SIGSTOP:
            os.kill(browser.pid, signal.SIGCONT)
            asyncio.run(rests_for_good(one_panel))
    finally:
        browser.kill()
        browser.join(LIMIT_S)
        for end in (is_pressed, pressed):
            end.close()
