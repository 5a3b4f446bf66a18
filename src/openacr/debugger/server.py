"""Serve one client of the debugger: messages come in, meanwhile the card runs."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from queue import Empty, Queue
from typing import IO, Any

from openacr.debugger import answers as _answers  # noqa: F401 - fills the table
from openacr.debugger.adapter import Adapter
from openacr.debugger.wire import BrokenStreamError, read_message, write_message
from openacr.io.pacing import Pacer

log = logging.getLogger(__name__)

SLICE_S = 0.02  # card time between two polls of the messages, at full speed
IDLE_S = 0.005

Message = dict[str, Any] | BrokenStreamError | None  # None: the connection has ended


def serve(
    incoming: IO[bytes],
    outgoing: IO[bytes],
    ending: Callable[[], AbstractContextManager[None]] = nullcontext,
    *,
    secret: str = "",
) -> None:
    """Answer requests until the client ends the session or its connection is lost.

    With a `secret` only a launch that brings it is carried out.
    What is debugged is ended within the context of `ending`, which may keep interrupts from it.
    BrokenStreamError if what comes in cannot be separated into messages any more.
    """
    messages: Queue[Message] = Queue(1000)
    threading.Thread(target=_read, args=(incoming, messages), daemon=True).start()
    adapter = Adapter(lambda message: write_message(outgoing, message), secret)
    try:
        _answer(adapter, messages)
    except (BrokenPipeError, ConnectionError) as failure:
        log.info("the client is gone: %s", failure)
    finally:
        try:
            with ending():
                adapter.close()
        except KeyboardInterrupt:  # it came before it was kept out
            with ending():
                adapter.close()
            raise


def _read(incoming: IO[bytes], messages: Queue[Message]) -> None:
    try:
        while (message := read_message(incoming)) is not None:
            messages.put(message)
    except BrokenStreamError as failure:
        messages.put(failure)
    except (OSError, ValueError) as failure:  # it is closed
        log.info("the client is gone: %s", failure)
    messages.put(None)


def _answer(adapter: Adapter, messages: Queue[Message]) -> None:
    pacer: Pacer | None = None
    while not adapter.is_ended:
        try:
            message = messages.get(block=not adapter.is_watching)
            if message is None:
                return
            if isinstance(message, BrokenStreamError):
                raise message
            adapter.take(message)
            pacer = None
        except Empty:
            pacer = _advance(adapter, pacer)


def _advance(adapter: Adapter, pacer: Pacer | None) -> Pacer | None:
    """Let the card run for a moment, in its pace."""
    period_s = adapter.target.course.period_s
    if adapter.speed == 0.0:
        adapter.advance(max(1, round(SLICE_S / period_s)))
        return None
    if pacer is None:
        pacer = Pacer(period_s, adapter.speed)
        pacer.start(time.monotonic())
    ticks = pacer.due_tk(time.monotonic())
    if ticks:
        adapter.advance(ticks)
        pacer.advanced(ticks)
    else:
        time.sleep(pacer.pause_s(time.monotonic(), IDLE_S))
    return pacer
