"""What the compiled sources ask of the operating system, under the names that they use.

Compiled, these are the functions of `csystem.pxd` (Linux; elsewhere they do nothing); as plain
Python they are these relatives, which no loop on the wall clock uses.
"""

import time

__all__ = ["fence", "now_ns", "wait_until_ns"]


def now_ns() -> int:
    """Nanoseconds of the clock that never goes back."""
    return time.monotonic_ns()


def wait_until_ns(due_ns: int) -> None:
    """Sleep until this time of `now_ns`; not at all if it has passed."""
    time.sleep(max(0, due_ns - now_ns()) * 1e-9)


def fence() -> None:
    """What was written before is seen before what is written after, by all threads."""
