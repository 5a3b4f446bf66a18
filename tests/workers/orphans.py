"""Parents that are killed, and whether their processes have ended."""

import subprocess
import sys
import textwrap
from pathlib import Path

from tests.waiting import until


def left_by(code: str) -> list[int]:
    """The processes that a parent printed before it was killed, once all have ended.

    The parent runs `code`, which prints one line of process ids and then has to wait.
    """
    root = Path(__file__).parents[2]
    with subprocess.Popen(
        [sys.executable, "-c", textwrap.dedent(code)], cwd=root, stdout=subprocess.PIPE, text=True
    ) as parent:
        assert parent.stdout is not None
        children = [int(word) for word in parent.stdout.readline().split()]
        assert all(map(is_there, children))
        parent.kill()
    until(lambda: not any(map(is_there, children)), str(children))
    return children


def is_there(process: int) -> bool:
    """Whether a process is there and is not a zombie."""
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False
