"""What is typed at a console or terminal of tests."""

import time

from openacr.cli.mill.terminal import Lines

LIMIT_S = 60


def arrived(lines: Lines | None) -> None:
    """Wait until a typed line has been read, where lines are read already."""
    for _ in range(100 * LIMIT_S):
        if lines is None or not lines._lines.empty():
            return
        time.sleep(0.01)
    raise AssertionError("what was typed does not arrive")
