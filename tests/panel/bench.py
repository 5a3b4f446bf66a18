"""A panel for tests: its station driven by hand, or a server on a port of its own."""

import asyncio
import json
import math
import os
import struct
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, TypeVar

from openacr.controller import Controller
from openacr.panel.commands.all import carry_out
from openacr.panel.control.machine.installation import Installation
from openacr.panel.control.operator.orders import Order
from openacr.panel.control.operator.people import Person
from openacr.panel.control.station import Station
from openacr.panel.control.thread import ControlThread
from openacr.panel.machine import embedded
from openacr.panel.roles import Role
from openacr.panel.server.accounts import file_of
from openacr.panel.server.delays import Delays
from openacr.panel.server.panel import Panel
from openacr.panel.server.web import PanelServer

T = TypeVar("T")
LIMIT_S = 60.0
STEP_S = 0.002
JOBS_S = 300.0  # of a clock on the wall: an axis is identified in plain Python, too
HEAD = struct.Struct("<BBHIdd")


def is_alive(process: int) -> bool:
    """Whether there is a process of this number."""
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    return True


class HandStation:
    """A station whose time passes only in `run`; what it sends is kept."""

    def __init__(
        self,
        folder: Path,
        *,
        role: Role = Role.SERVICE,
        installation: Installation | None = None,
    ) -> None:
        self.installation = installation or embedded(folder)
        self.now_s = 100.0
        self.station = Station(self.installation, carry_out)
        self.events_sent: list[dict[str, Any]] = []
        self.station.screens.send = self.events_sent.append
        self.station.open(self.now_s)
        assert self.station.link.lost == ""
        self.me = Person(1, role, "127.0.0.1")
        self.station.join(self.me)
        self.run(0.1)

    def run(self, seconds: float) -> None:
        """Let time pass."""
        for _ in range(round(seconds / STEP_S)):
            self.now_s += STEP_S
            self.station.step(self.now_s)

    def until(self, holds: Callable[[], bool], limit_s: float = 60.0) -> None:
        """Let time pass until something holds; it stands still for work beside the thread."""
        end_s = self.now_s + limit_s
        while not holds():
            self._let_jobs_end()
            assert self.now_s < end_s, f"never came: {self.state} {self.said[-3:]}"
            self.run(0.01)

    def _let_jobs_end(self) -> None:
        end_s = time.monotonic() + JOBS_S
        while self.station.jobs.are_open:
            assert time.monotonic() < end_s, "work beside the control thread never ended"
            time.sleep(STEP_S)
            self.station.jobs.poll()

    def send(
        self, name: str, /, *, who: Person | None = None, old_s: float = 0.0, **args: Any
    ) -> Any:
        """Carry a command out; its answer as the browser gets it."""
        answers: list[dict[str, Any]] = []
        order = Order(who or self.me, name, args, self.now_s - old_s, answers.append)
        self.station.order(order, self.now_s)
        if not answers and name != "jog.keep":
            while not answers:  # a program is loaded beside the control thread
                self._let_jobs_end()
                self.run(STEP_S)
        return answers[0] if answers else None

    def do(self, name: str, /, **args: Any) -> Any:
        """Carry a command out that has to succeed; its result."""
        answer = self.send(name, **args)
        assert answer["ok"], answer
        return answer["result"]

    def refused(self, name: str, /, **args: Any) -> dict[str, Any]:
        """The error of a command that has to be refused."""
        answer = self.send(name, **args)
        assert not answer["ok"], answer
        error: dict[str, Any] = answer["error"]
        return error

    @property
    def tick(self) -> float:
        """The newest tick."""
        return self.station.snapshot.tick_ms

    @property
    def state(self) -> str:
        return self.station.link.required.runner.state.name

    @property
    def is_busy(self) -> bool:
        return self.station.link.machine.runner.is_busy

    @property
    def said(self) -> list[str]:
        return [each["text"] for each in self.station.screens.said]

    def events(self, name: str) -> list[dict[str, Any]]:
        """What was sent under a name."""
        return [event for event in self.events_sent if event["event"] == name]

    def places(self) -> tuple[float, ...]:
        """Where the axes are commanded to be, machine coordinates."""
        return self.station.snapshot.commanded

    def speeds(self, seconds: float = 0.1) -> tuple[float, ...]:
        """How far each axis moves in a time, per second."""
        before = self.places()
        self.run(seconds)
        return tuple(
            round((b - a) / seconds, 6) for a, b in zip(before, self.places(), strict=True)
        )

    def press(self, number: int, axis: str = "X", direction: int = 1, **more: Any) -> Any:
        """Press a jog key."""
        more.setdefault("tick", self.tick)
        return self.send(
            "jog.press", press=number, axis=axis, direction=direction, first=True, **more
        )

    def keep(self, number: int, seconds: float, **more: Any) -> None:
        """Hold a key for a time, as a browser does."""
        for _ in range(round(seconds / 0.05)):
            self.run(0.05)
            self.send("jog.keep", press=number, tick=self.tick, **more)

    def close(self) -> None:
        self.station.close()
        self.station.jobs.close()
        self.installation.close()


def card_of(hand: HandStation) -> Controller:
    """The card in the process of a station."""
    assert hand.installation.controller is not None
    return hand.installation.controller


class HandControl(ControlThread):
    """A control thread that is no thread: its turns are taken by hand."""

    def __init__(self, station: Station) -> None:
        self._now_s = 100.0
        super().__init__(station, lambda: self._now_s)

    def start(self) -> None:
        self.station.open(self._now_s)

    def stop(self) -> None:
        self.rest()

    def step(self, seconds: float) -> None:
        for _ in range(max(1, round(seconds / STEP_S))):
            self._now_s += STEP_S
            self.turn(0.0)


class Served:
    """A panel that serves a port of its own, in a thread of this process."""

    def __init__(
        self,
        folder: Path,
        *,
        by_hand: bool = False,
        prepare: Callable[[Panel], None] | None = None,
        installation: Installation | None = None,
    ) -> None:
        installation = installation or embedded(folder)
        self.panel = Panel(installation, control=HandControl if by_hand else ControlThread)
        if prepare is not None:
            prepare(self.panel)
        self._server = PanelServer(self.panel)
        self._loop: asyncio.AbstractEventLoop | None = None
        self._is_up = threading.Event()
        self._thread = threading.Thread(target=self._run, name="panel server", daemon=True)
        self._thread.start()
        assert self._is_up.wait(LIMIT_S)

    def _run(self) -> None:
        async def started() -> None:
            self._loop = asyncio.get_running_loop()
            self._is_up.set()

        asyncio.run(self._server.serve(started))

    @property
    def port(self) -> int:
        return int(self._server.port)

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self.port}"

    @property
    def ws_url(self) -> str:
        return f"ws://127.0.0.1:{self.port}/ws"

    @property
    def machine(self) -> "Served":
        return self

    @property
    def station(self) -> Station:
        return self.panel.station

    @property
    def programs(self) -> Path:
        return self.panel.installation.programs

    @property
    def store(self) -> Path:
        assert self.panel.installation.store.path is not None
        return self.panel.installation.store.path

    @contextmanager
    def as_it_was(self) -> Iterator["Served"]:
        """Cells, part programs and passwords that are changed meanwhile are put back."""
        store, accounts = self.panel.installation.store, self.panel.accounts
        first = {n: store.value(n) for n in store.changes_since(0).numbers if store.is_set(n)}
        token, files = store.token, self._files()
        hashes = dict(accounts._hashes)
        yield self
        with store.transaction():
            for cell in store.changes_since(token).numbers:
                if store.parameter(cell).row.is_fixed:
                    continue
                if cell in first:
                    store._set(cell, first[cell])
                else:
                    store.reset(cell)
        accounts._hashes, accounts._sessions, accounts.delays = hashes, {}, Delays()
        file_of(store.path).unlink(missing_ok=True)  # type: ignore[union-attr]
        for path in sorted(self.programs.rglob("*"), reverse=True):
            if path.is_dir() and not path.is_symlink():
                with suppress(OSError):
                    path.rmdir()
            elif path not in files:
                path.unlink()
        for path, content in files.items():
            if not path.exists() or path.read_bytes() != content:
                path.write_bytes(content)

    def _files(self) -> dict[Path, bytes]:
        """The part programs."""
        return {path: path.read_bytes() for path in self.programs.rglob("*") if path.is_file()}

    def call(self, work: Callable[[Station], T]) -> T:
        """Run a function in the control thread; its result."""
        future: Future[T] = self.panel.control.call(work)
        if isinstance(self.panel.control, HandControl):
            self.panel.control.step(STEP_S)
        return future.result(LIMIT_S)

    @contextmanager
    def swift(self) -> Iterator[None]:
        """Time of the card passes as fast as it goes meanwhile, where the time proves nothing."""
        self.call(lambda station: station.times.run(math.inf, station.now_s))
        yield
        self.call(lambda station: station.times.run(1.0, station.now_s))

    def step(self, seconds: float) -> None:
        """Let time pass, where it is driven by hand."""
        assert isinstance(self.panel.control, HandControl)
        self.panel.control.step(seconds)

    def wait_until_ended(self) -> None:
        """Wait for the end of the server, which something else has asked for."""
        self._thread.join(LIMIT_S)
        assert not self._thread.is_alive()

    def close(self) -> None:
        if self._loop is not None and self._thread.is_alive():
            self._loop.call_soon_threadsafe(self._server.stop)
        self.wait_until_ended()


class Client:
    """A browser without a picture: the protocol as a screen speaks it."""

    def __init__(self, socket: Any) -> None:
        self._socket = socket
        self._number = 0
        self.events: list[dict[str, Any]] = []
        self.frames: list[bytes] = []
        self.acks = True

    async def send(self, name: str, /, **args: Any) -> int:
        self._number += 1
        await self._socket.send(json.dumps({"id": self._number, "cmd": name, "args": args}))
        return self._number

    async def do(self, name: str, /, **args: Any) -> dict[str, Any]:
        """The answer of a command."""
        number = await self.send(name, **args)
        return await self.wait(lambda: self._answer(number))

    def _answer(self, number: int) -> dict[str, Any] | None:
        return next((e for e in self.events if e.get("id") == number), None)

    def last(self, name: str) -> dict[str, Any]:
        """The last event of a name."""
        return next(e for e in reversed(self.events) if e.get("event") == name)

    def named(self, name: str) -> list[dict[str, Any]]:
        return [e for e in self.events if e.get("event") == name]

    @property
    def tick(self) -> float:
        return float(HEAD.unpack_from(self.frames[-1])[4])

    async def take(self) -> None:
        """Receive one message."""
        async with asyncio.timeout(LIMIT_S):  # `wait_for` of Python 3.11 may lose a cancellation
            message = await self._socket.recv()
        if isinstance(message, str):
            self.events.append(json.loads(message))
            return
        self.frames.append(message)
        topic, _, _, seq, _, _ = HEAD.unpack_from(message)
        if self.acks:
            names = {1: "status", 2: "flags", 3: "watch", 4: "scope", 5: "world"}
            await self._socket.send(json.dumps({"ack": names[topic], "seq": seq}))

    async def wait(self, found: Callable[[], T | None]) -> T:
        """Receive until something is there."""
        while (result := found()) is None or result is False:
            await self.take()
        return result
