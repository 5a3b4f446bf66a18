"""Waiting on a clock on the wall for what other threads and processes do."""

import time
from collections.abc import Callable

LIMIT_S = 60.0  # for what has to come at all: a computer may be busy


def _pause() -> None:
    time.sleep(0.01)


def until(
    holds: Callable[[], object],
    about: str | Callable[[], object] = "",
    *,
    limit_s: float = LIMIT_S,
    step: Callable[[], object] = _pause,
) -> None:
    """Wait for something that has to come; `step` is done between two looks."""
    end_s = time.monotonic() + limit_s
    while not holds():
        seen = about() if callable(about) else about
        assert time.monotonic() < end_s, f"not within {limit_s:g} s: {seen or holds}"
        step()
