"""Calls for worker processes."""

import os
import signal
import time
from pathlib import Path

LIMIT_S = 60


def square(number: int) -> int:
    return number * number


def fatal(number: int) -> int:
    """Ends its process at 3, every time."""
    if number == 3:
        os.kill(os.getpid(), signal.SIGKILL)
    return number


def fatal_once(task: tuple[int, str]) -> int:
    """Ends its process at 3 if no file says that it did."""
    number, folder = task
    mark = Path(folder, "died")
    if number == 3 and not mark.exists():
        mark.touch()
        os._exit(1)
    return number


def faulty(number: int) -> float:
    return 1 / (number - 2)


def own_process(folder: str) -> int:
    """Its number, once another process has had a task, too."""
    Path(folder, str(os.getpid())).touch()
    for _ in range(LIMIT_S * 100):
        if len(os.listdir(folder)) > 1:
            break
        time.sleep(0.01)
    return os.getpid()
