"""Termination signals: SIGTERM and SIGHUP act like Ctrl-C, on Windows Ctrl-Break."""

import asyncio
import signal
import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import AbstractContextManager, contextmanager
from types import FrameType


def endings() -> list[int]:
    """SIGTERM, SIGHUP and Ctrl-Break where a system has them, unless `nohup` had one ignored."""
    names = ("SIGTERM", "SIGHUP", "SIGBREAK")
    known = [getattr(signal, name) for name in names if hasattr(signal, name)]
    return [number for number in known if signal.getsignal(number) is not signal.SIG_IGN]


def stop_on_signals(
    stop: Callable[[], object], interrupted: Callable[[], object] | None = None
) -> None:
    """Call `stop` in the running loop on Ctrl-C, on SIGTERM, and when the terminal is closed.

    `interrupted`: what Ctrl-C calls instead.
    """
    loop = asyncio.get_running_loop()
    for number in (signal.SIGINT, *endings()):
        does = interrupted if interrupted and number == signal.SIGINT else stop
        try:
            loop.add_signal_handler(number, does)
        except NotImplementedError:  # Windows delivers signals to Python handlers only
            signal.signal(number, lambda *_, does=does: loop.call_soon_threadsafe(does))


def terminations_as_interrupts() -> AbstractContextManager[None]:
    """Context in which SIGTERM and SIGHUP raise KeyboardInterrupt, so that cleanup runs.

    The first alone does: one that followed could interrupt the cleanup before it is `deaf`.
    """
    return _handling(endings(), _interrupt)


def deaf() -> AbstractContextManager[None]:
    """Context in which Ctrl-C, SIGTERM and SIGHUP are ignored, for work that must complete."""
    return _handling([signal.SIGINT, *endings()], signal.SIG_IGN)


@contextmanager
def _handling(
    numbers: Iterable[int], handler: Callable[[int, FrameType | None], None] | signal.Handlers
) -> Iterator[None]:
    if threading.current_thread() is not threading.main_thread():
        yield  # signals reach the main thread only
        return
    before = {number: signal.signal(number, handler) for number in numbers}
    try:
        yield
    finally:
        for number, old in before.items():
            signal.signal(number, old)


def _interrupt(_number: int, _frame: FrameType | None) -> None:
    for number in endings():
        signal.signal(number, signal.SIG_IGN)
    raise KeyboardInterrupt
