"""Termination signals: SIGTERM and SIGHUP act like Ctrl-C."""

import signal
import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import AbstractContextManager, contextmanager
from types import FrameType


def endings() -> list[int]:
    """SIGTERM, and SIGHUP where a system has it, unless `nohup` had it ignored."""
    known = [getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name)]
    return [number for number in known if signal.getsignal(number) is not signal.SIG_IGN]


def terminations_as_interrupts() -> AbstractContextManager[None]:
    """Context in which SIGTERM and SIGHUP raise KeyboardInterrupt, so that cleanup runs."""
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
    raise KeyboardInterrupt
