"""One process of a bridge from its start to its end, however it ends."""

import asyncio
import logging
import os
import subprocess
import sys
from asyncio.subprocess import PIPE, Process
from collections.abc import Callable
from concurrent.futures import Future
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple

from openacr.bridge.bridge import OPEN_S
from openacr.bridge.feed import Feed
from openacr.bridge.messages import (
    HEAD,
    Begin,
    End,
    Failed,
    FromProcess,
    Logged,
    Opened,
    Reading,
    Taken,
    ToProcess,
    Write,
    Written,
    framed,
    from_process,
    length_of,
)
from openacr.bridge.settings import BridgeFile
from openacr.bridge.writing import checked
from openacr.errors import OpenacrError, UserError

log = logging.getLogger(__name__)
HUNG_S = 20.0  # a process that takes no reading for longer is killed
END_S = 15.0  # longest end by itself
MOST_WRITES = 1000  # under way; then the process is not read
MODULE = "openacr.bridge.child"
WINDOWS = os.name == "nt"
Open = Callable[[tuple[str, ...]], None]


class Stopped(NamedTuple):
    """Why a process is sent no more readings; empty where it has ended by itself."""

    why: str = ""
    is_hung: bool = False  # it is killed, since it would not end


class Life:
    """A process that publishes what a feed reads."""

    def __init__(self, file: BridgeFile, folder: Path, feed: Feed) -> None:
        self._file, self._folder, self._feed = file, folder, feed
        self._why = ""  # it cannot begin
        self._taken = asyncio.Event()
        self._opened = asyncio.Event()
        self._writes: set[asyncio.Task[None]] = set()

    async def run(self, over: asyncio.Event, opened: Open) -> str:
        """Live until the end of the panel or its own; why it has ended."""
        process = await asyncio.create_subprocess_exec(
            sys.executable, "-m", MODULE, stdin=PIPE, stdout=PIPE, **apart()
        )
        log.info("the bridge runs as process %d", process.pid)
        reading = asyncio.create_task(self._listen(process, opened))
        ending = asyncio.create_task(over.wait())
        feeding = asyncio.create_task(self._feed_on(process))
        tasks: set[asyncio.Task[Any]] = {reading, ending, feeding}
        try:
            await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
            return await self._ended(process, feeding)
        finally:
            for task in (*tasks, *self._writes):
                task.cancel()
            await asyncio.gather(*tasks, *self._writes, return_exceptions=True)

    async def _ended(self, process: Process, feeding: "asyncio.Task[Stopped]") -> str:
        """End the process, if it has not; why it has ended."""
        stopped = _outcome(feeding)
        if process.stdin is not None:
            process.stdin.write(framed(End()))
            process.stdin.close()
        try:
            async with asyncio.timeout(0.0 if stopped.is_hung else END_S):
                status = await process.wait()
        except TimeoutError:
            with suppress(ProcessLookupError):
                process.kill()
            status = await process.wait()
        return self._why or stopped.why or f"the process of the bridge has ended (status {status})"

    # --- to the process ---------------------------------------------------------------

    async def _feed_on(self, process: Process) -> Stopped:
        """Send the newest values until it takes none or has other axes; then why."""
        level = logging.getLogger().getEffectiveLevel()
        begin = Begin(self._file, str(self._folder), tuple(self._feed.axes), level)
        loop = asyncio.get_running_loop()
        began_s = due_s = loop.time()
        message: ToProcess = begin
        while True:
            try:
                async with asyncio.timeout(HUNG_S if self._opened.is_set() else OPEN_S):
                    await _send(process, message)
                    if message is not begin:
                        await self._taken.wait()
            except TimeoutError:
                return Stopped("the process of the bridge takes no values", is_hung=True)
            except ConnectionError:
                return Stopped()  # it has ended, or does so now
            if not self._opened.is_set() and loop.time() - began_s > OPEN_S:
                return Stopped(f"the bridge has not started within {OPEN_S:g} s", is_hung=True)
            due_s = max(due_s + 1.0 / self._file.rate_hz, loop.time())
            await asyncio.sleep(due_s - loop.time())
            self._taken.clear()
            message = Reading(self._feed.newest())
            if tuple(self._feed.axes) != begin.axes:  # asked for after the reading: it is of them
                return Stopped("the axes of the machine have changed")

    # --- from the process -------------------------------------------------------------

    async def _listen(self, process: Process, opened: Open) -> None:
        """Take what the process says until its end."""
        if process.stdout is None:
            return
        with suppress(asyncio.IncompleteReadError, OSError, ValueError):
            while not self._why:
                head = await process.stdout.readexactly(HEAD.size)
                data = await process.stdout.readexactly(length_of(head))
                self._take(process, from_process(data), opened)
                while len(self._writes) >= MOST_WRITES:
                    await asyncio.wait(self._writes, return_when=asyncio.FIRST_COMPLETED)

    def _take(self, process: Process, message: FromProcess, opened: Open) -> None:
        match message:
            case Taken():
                self._taken.set()
            case Opened(places):
                self._opened.set()
                opened(places)
            case Failed(why):
                self._why = why
            case Logged(level, logger, text):
                logging.getLogger(logger).log(level, "%s", text)
            case Write():
                task = asyncio.create_task(self._write(process, message))
                self._writes.add(task)
                task.add_done_callback(self._writes.discard)

    async def _write(self, process: Process, asked: Write) -> None:
        """Carry a write out and answer it."""
        refusal = ""
        try:
            await asyncio.wrap_future(self._permitted(asked))
        except OpenacrError as error:
            refusal = str(error)
        with suppress(ConnectionError):
            await _send(process, Written(asked.number, refusal))

    def _permitted(self, asked: Write) -> "Future[None]":
        """Begin a write that the file lists, within its limits; UserError for any other one."""
        for chosen in self._file.value:
            if chosen.write and (chosen.number, chosen.is_flag) == (asked.place, asked.is_flag):
                is_switch = asked.is_flag and asked.value in (0.0, 1.0)
                value = checked(chosen, bool(asked.value) if is_switch else asked.value)
                return self._feed.write(asked.place, value, is_flag=asked.is_flag)
        raise UserError(f"the bridge file does not allow to write {asked.place}")


def _outcome(feeding: "asyncio.Task[Stopped]") -> Stopped:
    """Why a process is fed no more; nothing where that is not the reason of its end."""
    if not feeding.done():
        return Stopped()
    if (error := feeding.exception()) is not None:
        log.error("a reading cannot be sent", exc_info=error)
        why = f"a reading cannot be sent: {type(error).__name__}: {error}"
        return Stopped(why, is_hung=True)
    return feeding.result()


async def _send(process: Process, message: ToProcess) -> None:
    if process.stdin is not None:
        process.stdin.write(framed(message))
        await process.stdin.drain()


def apart() -> dict[str, Any]:
    """How a process is started that Ctrl-C in the terminal of the panel does not reach."""
    if WINDOWS:
        flags = ("CREATE_NEW_PROCESS_GROUP", "CREATE_NO_WINDOW")
        return {"creationflags": sum(int(getattr(subprocess, name)) for name in flags)}
    return {"start_new_session": True}
