"""Lines of libraries in the log: some are left out, some are limited, so that they cannot fill it.

Left out is what is no fault, or is reported already.
"""

import logging
import time

from openacr.io.bounded_log import Bounded


class LeftOut(logging.Filter):
    """Leaves out lines about one kind of failure, also where it is the cause of another one."""

    def __init__(self, failure: type[Exception]) -> None:
        super().__init__()
        self._failure = failure

    def filter(self, record: logging.LogRecord) -> bool:
        """Whether a line is logged."""
        raised = record.exc_info[1] if record.exc_info else None
        cause = None if raised is None else raised.__cause__
        return not isinstance(raised, self._failure) and not isinstance(cause, self._failure)


def leave_out(logger: str, failure: type[Exception]) -> None:
    """Leave lines about a failure out of the log of a library, from now on."""
    found = logging.getLogger(logger)
    if not any(isinstance(each, LeftOut) for each in found.filters):
        found.addFilter(LeftOut(failure))


def limit(logger: str) -> None:
    """Limit the lines of each kind in the log of a library, from now on."""
    found = logging.getLogger(logger)
    if not any(isinstance(each, Bounded) for each in found.filters):
        found.addFilter(Bounded(time.monotonic))


class OneLine(logging.Filter):
    """Makes one line of what a library logs with a traceback: the sentence of the failure."""

    def __init__(self, failures: tuple[type[Exception], ...]) -> None:
        super().__init__()
        self._failures = failures

    def filter(self, record: logging.LogRecord) -> bool:
        """Keep the line; of such a failure, only what it says."""
        raised = record.exc_info[1] if record.exc_info else None
        if isinstance(raised, self._failures):
            record.msg, record.args = "refused: %s", (raised,)
            record.exc_info = record.exc_text = None
            record.levelno, record.levelname = logging.WARNING, "WARNING"
        return True


def in_one_line(logger: str, *failures: type[Exception]) -> None:
    """Log failures within a library as their sentences, from now on."""
    found = logging.getLogger(logger)
    if not any(isinstance(each, OneLine) for each in found.filters):
        found.addFilter(OneLine(failures))
