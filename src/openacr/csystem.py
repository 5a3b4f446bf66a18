"""What the compiled sources ask of the operating system, under the names that they use.

Compiled, these are the functions of `csystem.pxd` (Linux; elsewhere they do nothing); as plain
Python they are these relatives, which no loop on the wall clock uses.
"""

import os
import select
import time

__all__ = ["fence", "frame_exchange", "now_ns", "wait_until_ns"]


def now_ns() -> int:
    """Nanoseconds of the clock that never goes back."""
    return time.monotonic_ns()


def wait_until_ns(due_ns: int) -> None:
    """Sleep until this time of `now_ns`; not at all if it has passed."""
    time.sleep(max(0, due_ns - now_ns()) * 1e-9)


def fence() -> None:
    """What was written before is seen before what is written after, by all threads."""


def frame_exchange(
    fd: int,
    out: "memoryview[int]",
    size: int,
    back: "memoryview[int]",
    room: int,
    place: int,
    until_ns: int,
) -> int:
    """Send `size` bytes and wait for a frame with the same byte at `place`; its size, 0 for none.

    What has come before is dropped; `back` has `room`.
    """
    while select.select([fd], [], [], 0.0)[0]:
        os.read(fd, room)
    try:
        os.write(fd, out[:size])
    except OSError:
        return 0
    while (left_ns := until_ns - now_ns()) > 0:
        if not select.select([fd], [], [], left_ns * 1e-9)[0]:
            return 0
        data = os.read(fd, room)
        if len(data) > place and data[place] == out[place]:
            back[: len(data)] = data
            return len(data)
    return 0
