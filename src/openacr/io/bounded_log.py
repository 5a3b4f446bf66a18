"""Rate limit of log records, so that no host can fill the log: excess ones are counted."""

import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

LINES = 5
WINDOW_S = 60.0


@dataclass(slots=True)
class _Kind:
    ends_s: float
    count: int = 0


class Bounded(logging.Filter):
    """Lets the first LINES records of a kind pass in a minute; the next minute has their number.

    A kind is the text of a record without its values. A minute begins with the first record
    after the last one has ended.
    """

    def __init__(self, now_s: Callable[[], float]) -> None:
        super().__init__()
        self._now_s = now_s
        self._kinds: dict[str, _Kind] = {}

    def filter(self, record: logging.LogRecord) -> bool:
        """Whether a record is written; the first one of a minute says how many were not."""
        now_s = self._now_s()
        kind = self._kinds.get(str(record.msg))
        if kind is None or now_s >= kind.ends_s:
            unlisted = 0 if kind is None else kind.count - LINES
            kind = self._kinds[str(record.msg)] = _Kind(now_s + WINDOW_S)
            if unlisted > 0:
                record.msg = f"{record.getMessage()} (and {unlisted} times more before)"
                record.args = ()
        kind.count += 1
        return kind.count <= LINES


@contextmanager
def bounded(now_s: Callable[[], float], *loggers: logging.Logger) -> Iterator[None]:
    """Limit the rate of these loggers inside a `with` block."""
    limit = Bounded(now_s)
    for logger in loggers:
        logger.addFilter(limit)
    try:
        yield
    finally:
        for logger in loggers:
            logger.removeFilter(limit)
