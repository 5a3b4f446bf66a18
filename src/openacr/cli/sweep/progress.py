"""The progress bar of a sweep: runs done and the time left, on a terminal only."""

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from openacr.sweep.campaign import Progress

WRITE_S = 1.0  # between two parts of the results: what a killed sweep loses at most


@dataclass(slots=True)
class Timed(Progress):
    """Writes results every few seconds, and moves a bar if there is one."""

    bar: Any = None
    task: Any = None
    written_s: float = -WRITE_S  # the first result is written at once

    def show(self) -> None:
        """Move the bar."""
        if self.bar is not None:
            self.bar.update(self.task, total=self.total, completed=self.done)

    def is_due(self) -> bool:
        """Whether results were last written some seconds ago."""
        now_s = time.monotonic()
        if now_s - self.written_s < WRITE_S:
            return False
        self.written_s = now_s
        return True


@contextmanager
def progress_for(*, is_shown: bool) -> Iterator[Progress]:
    """Progress with a bar on a terminal, without one elsewhere."""
    if not is_shown or not sys.stderr.isatty():
        yield Timed()
        return
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )
    from rich.progress import Progress as Bar

    columns = (
        MofNCompleteColumn(), TextColumn("runs"), BarColumn(bar_width=30), TimeElapsedColumn(),
        TextColumn("left:"), TimeRemainingColumn(),
    )  # fmt: skip
    with Bar(*columns, console=Console(stderr=True), transient=True) as bar:
        yield Timed(bar=bar, task=bar.add_task(""))
