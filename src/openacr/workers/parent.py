"""What every worker process does first: leave Ctrl-C to its parent, and end with it."""

import multiprocessing
import os
import signal
import threading


def follow_parent() -> None:
    """Ignore Ctrl-C, and end this process at once when its parent has ended, however it has.

    A process of multiprocessing waits for work on a pipe of which it holds both ends, so
    the death of its parent does not wake it.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, name="parent watch", daemon=True).start()


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()  # waits for a pipe of the parent, on Windows for its process
        os._exit(1)
