"""The WebSocket of a running panel: first words, frames, answers."""

import asyncio
import struct
from collections.abc import Awaitable, Callable
from typing import Any

import pytest
import websockets
from tests.panel.bench import HEAD, Client, Served


@pytest.fixture
def panel(kept_panel: Served) -> Served:
    return kept_panel


def talk(panel: Served, scene: Callable[[Client], Awaitable[None]], **more: object) -> None:
    async def run() -> None:
        # A queue that is full would keep the end of the connection from being read.
        options: dict[str, Any] = {"max_queue": None} | more
        async with websockets.connect(panel.ws_url, **options) as socket:
            await scene(Client(socket))

    asyncio.run(run())


def test_a_browser_gets_all_facts_when_it_connects(panel: Served) -> None:
    async def scene(client: Client) -> None:
        await client.wait(lambda: any(e.get("event") == "says" for e in client.events))
        assert client.events[0]["event"] == "hello"
        hello = client.events[0]
        assert hello["role"] == "service"
        assert [axis["name"] for axis in hello["machine"]["axes"]] == ["X", "Y", "Z"]
        assert hello["machine"]["unit"] == "mm"
        names = {event["event"] for event in client.events}
        assert names >= {"state", "program", "modals", "alarms", "messages", "control", "overrides"}
        assert client.last("state")["state"] == "IDLE"

    talk(panel, scene)


def test_the_status_comes_as_frames_with_their_tick(panel: Served) -> None:
    async def scene(client: Client) -> None:
        answer = await client.do("sub", topic="status", hz=25)
        assert answer["result"] == {"topic": "status", "hz": 25}
        await client.wait(lambda: len([f for f in client.frames if f[2]]) >= 5)
        client.frames = [frame for frame in client.frames if frame[2]]  # the machine is open
        heads = [HEAD.unpack_from(frame) for frame in client.frames]
        assert {(topic, version, axes) for topic, version, axes, *_ in heads} == {(1, 1, 3)}
        assert all(len(frame) == 112 + 48 * 3 for frame in client.frames)
        numbers = [head[3] for head in heads]
        ticks = [head[4] for head in heads]
        assert numbers == sorted(set(numbers))
        assert ticks == sorted(ticks)
        assert struct.unpack_from("<3d", client.frames[-1], 112 + 24) == (0.0, 0.0, 0.0)

    talk(panel, scene)


def test_a_browser_that_acknowledges_nothing_gets_three_frames(panel: Served) -> None:
    async def scene(client: Client) -> None:
        client.acks = False
        await client.do("sub", topic="status", hz=50)
        await client.wait(lambda: len(client.frames) >= 3)
        for _ in range(10):
            await client.do("name", name="slow")
        await asyncio.sleep(0.3)
        await client.do("name", name="slow")
        assert len(client.frames) == 3

    talk(panel, scene)


@pytest.mark.parametrize(
    ("text", "part"),
    [
        ("{", "not JSON"),
        ("[1]", "an object"),
        ('{"id": 1}', "a command has a name"),
        ('{"id": 1, "cmd": "no.such"}', "there is no command 'no.such'"),
        ('{"id": 1, "cmd": "run.block", "args": {"on": 1}}', "Expected `bool`, got `int`"),
        ('{"id": 1, "cmd": "run.block", "args": {"on": true, "x": 1}}', "unknown field `x`"),
        ('{"id": 1, "cmd": "sub", "args": {"topic": "x"}}', "there are status"),
        ('{"id": 1, "cmd": "sub", "args": {"topic": "status", "hz": 1000}}', "0.1 to 60"),
    ],
)
def test_a_wrong_command_is_answered_with_the_reason(panel: Served, text: str, part: str) -> None:
    async def scene(client: Client) -> None:
        await client._socket.send(text)
        answer = await client.wait(lambda: next((e for e in client.events if "ok" in e), None))
        assert not answer["ok"]
        assert answer["error"]["code"] == "bad"
        assert part in answer["error"]["text"]

    talk(panel, scene)


def test_a_page_of_another_site_gets_no_connection(panel: Served) -> None:
    for origin in ("http://evil.example", f"http://localhost:{panel.port + 1}", "null"):
        with pytest.raises(websockets.exceptions.InvalidStatus) as refused:
            talk(panel, lambda client: client.take(), origin=origin)
        assert refused.value.response.status_code == 403


def test_a_line_of_five_megabytes_ends_its_connection_and_nothing_else(panel: Served) -> None:
    async def scene(client: Client) -> None:
        with pytest.raises(websockets.exceptions.ConnectionClosed):
            await client._socket.send("x" * 5_000_000)
            while True:
                await client.take()

    talk(panel, scene)
    assert panel.call(lambda station: station.link.machine.runner.state.name) == "IDLE"


def test_the_machine_is_moved_by_hand_from_the_test(quiet_panel: Served) -> None:
    async def scene(client: Client) -> None:
        quiet_panel.step(0.1)
        await client.do("sub", topic="status", hz=25)
        quiet_panel.step(0.1)
        await client.wait(lambda: len(client.frames) >= 1)
        first = client.tick
        quiet_panel.step(1.0)
        await client.send("name", name="x")
        await client.wait(lambda: client.tick > first + 500.0)

    talk(quiet_panel, scene)
