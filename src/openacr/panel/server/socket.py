"""The WebSocket: commands and keep-alives in, answers, events and frames out."""

import asyncio
import json
from contextlib import suppress
from typing import Any

from starlette.websockets import WebSocket, WebSocketDisconnect, WebSocketState

from openacr.panel.control.operator.orders import Order, PanelError, failure
from openacr.panel.control.operator.people import Person, next_client
from openacr.panel.server.panel import Panel
from openacr.panel.wire.described import LEAST_HZ, MOST_HZ
from openacr.panel.wire.frames import Topic
from openacr.panel.wire.hub import Browser

LOG_IN, SLOW = 4401, 4408
SLOW_S = 10.0
WATCHED = (Topic.FLAGS, Topic.WATCH, Topic.WORLD)
WORDS = ("programs",)  # topics whose news are events
WATCHING = {"sub": "watch.begin", "unsub": "watch.end"}
TOPICS = {topic.name.lower(): topic for topic in Topic}


class Connection:
    """One browser that is connected."""

    def __init__(self, panel: Panel, socket: WebSocket, person: Person, token: str = "") -> None:
        self.token = token
        self._panel = panel
        self._socket = socket
        self._person = person
        self._loop = asyncio.get_running_loop()
        self._end: tuple[int, str] | None = None
        self._sender: asyncio.Task[None] | None = None
        self.browser = Browser(person.client, self.drop)

    def drop(self, code: int, why: str) -> None:
        """End the connection."""
        self._end = self._end or (code, why)
        if self._sender is not None:
            self._sender.cancel()

    async def run(self) -> None:
        """Serve the browser until it goes."""
        panel, client = self._panel, self._person.client
        self.browser.say(panel.hello(self._person))
        panel.hub.join(self.browser)
        person = self._person
        panel.control.call(lambda station: station.join(person))
        self._sender = asyncio.create_task(self._send())
        reader = asyncio.create_task(self._read())
        try:
            await asyncio.wait((self._sender, reader), return_when=asyncio.FIRST_COMPLETED)
        finally:
            panel.hub.leave(client)
            panel.control.call(lambda station: station.leave(client))
            for task in (self._sender, reader):
                task.cancel()
            for task in (self._sender, reader):
                with suppress(asyncio.CancelledError, Exception):
                    await task
            await self._close()

    async def _close(self) -> None:
        code, why = self._end or (1000, "")
        if self._socket.application_state is WebSocketState.CONNECTED:
            with suppress(Exception):
                await self._socket.close(code, why[:120])

    # --- out --------------------------------------------------------------------------

    async def _send(self) -> None:
        outbox, socket = self.browser.outbox, self._socket
        while True:
            frame = await outbox.take()
            try:
                async with asyncio.timeout(SLOW_S):
                    if isinstance(frame, str):
                        await socket.send_text(frame)
                    else:
                        await socket.send_bytes(frame)
            except TimeoutError:
                self._end = (SLOW, "this browser does not read what it is sent")
                return
            except (WebSocketDisconnect, RuntimeError, OSError):
                return

    def _answer(self, number: object, answer: dict[str, Any]) -> None:
        """Answer a command; called from the control thread."""
        with suppress(RuntimeError):  # the loop has ended
            self._loop.call_soon_threadsafe(self.browser.say, {"id": number, **answer})

    # --- in ---------------------------------------------------------------------------

    async def _read(self) -> None:
        while True:
            try:
                message = await self._socket.receive()
            except (WebSocketDisconnect, RuntimeError):
                return
            if message["type"] != "websocket.receive":
                return
            text = message.get("text")
            if text is None:
                self._refuse(None, "bad", "commands are texts, not binary frames")
                continue
            self._take(text)

    def _take(self, text: str) -> None:
        received_s = self._panel.control.now_s()
        try:
            found = json.loads(text)
        except (ValueError, RecursionError):
            self._refuse(None, "bad", "this is not JSON")
            return
        if not isinstance(found, dict):
            self._refuse(None, "bad", "a command is an object")
            return
        if "keep" in found:
            args = {"press": found["keep"], "tick": found.get("tick")}
            self._panel.control.put(Order(self._person, "jog.keep", args, received_s))
        elif "ack" in found:
            self._acknowledge(found)
        else:
            self._command(found, received_s)

    def _acknowledge(self, found: dict[str, Any]) -> None:
        topic, seq = TOPICS.get(str(found["ack"])), found.get("seq")
        if topic is not None and isinstance(seq, int):
            self.browser.outbox.acknowledge(topic, seq)

    def _command(self, found: dict[str, Any], received_s: float) -> None:
        number, name, args = found.get("id"), found.get("cmd"), found.get("args") or {}
        if not isinstance(name, str) or not isinstance(args, dict):
            self._refuse(number, "bad", "a command has a name `cmd` and an object `args`")
            return
        if name in ("sub", "unsub"):
            self._subscribe(number, name, args, received_s)
            return
        order = Order(
            self._person, name, args, received_s, lambda answer: self._answer(number, answer)
        )
        self._panel.control.put(order)

    def _subscribe(
        self, number: object, name: str, args: dict[str, Any], received_s: float
    ) -> None:
        if args.get("topic") in WORDS:
            self._command({"id": number, "cmd": WATCHING[name], "args": args}, received_s)
            return
        topic = TOPICS.get(str(args.get("topic")))
        if topic is None:
            known = ", ".join((*TOPICS, *WORDS))
            self._refuse(number, "bad", f"topic {args.get('topic')!r}: there are {known}")
            return
        hz = args.get("hz", 25)
        if isinstance(hz, bool) or not isinstance(hz, int | float) or not LEAST_HZ <= hz <= MOST_HZ:
            self._refuse(number, "bad", f"hz {hz!r}: allowed are {LEAST_HZ:g} to {MOST_HZ:g}")
            return
        outbox = self.browser.outbox
        if name == "unsub":
            outbox.unsubscribe(topic)
        else:
            outbox.subscribe(topic, float(hz))
        if topic in WATCHED:
            wish = args if name == "sub" else {"topic": args["topic"]}
            self._command({"id": number, "cmd": WATCHING[name], "args": wish}, received_s)
            return
        result = {"topic": topic.name.lower(), "hz": hz}
        self.browser.say({"id": number, "ok": True, "result": result})

    def _refuse(self, number: object, code: str, text: str) -> None:
        error = failure(PanelError(code, text))
        self.browser.say({"id": number, "ok": False, "error": error})


async def serve_socket(panel: Panel, socket: WebSocket) -> None:
    """Accept a browser and serve it."""
    token = socket.cookies.get(panel.cookie, "")
    role = panel.accounts.role_of(token)
    if role is None:
        await socket.accept()
        await socket.close(LOG_IN, "log in first")
        return
    await socket.accept()
    address = socket.client.host if socket.client else ""
    person = Person(next_client(), role, address)
    connection = Connection(panel, socket, person, token)
    panel.connections.add(connection)
    try:
        await connection.run()
    finally:
        panel.connections.discard(connection)
