"""The progress bar of a run: simulated time, speed and running programs, on a terminal only."""

import sys
from typing import TYPE_CHECKING, Self, TextIO

from openacr.closing import Closing

if TYPE_CHECKING:
    from rich.progress import Progress


class Bar(Closing):
    """How far a run has come; this one shows nothing, as files and pipes want."""

    def close(self) -> None:
        """Clear the line."""

    def show(self, time_s: float, speed: float, programs: list[int]) -> None:
        """Show the simulated time, the speed and the running programs."""


class TerminalBar(Bar):
    """A progress bar on the terminal of standard error, below what the programs print."""

    def __init__(self, total_s: float | None) -> None:
        self._progress = _progress()
        self._total = f" / {total_s:g}" if total_s else ""
        self._task = self._progress.add_task("", total=total_s, time="0.0", speed="", programs="")

    def __enter__(self) -> Self:
        self._progress.start()
        return self

    def close(self) -> None:
        """Clear the line."""
        self._progress.stop()

    def show(self, time_s: float, speed: float, programs: list[int]) -> None:
        """Show the simulated time, the speed and the running programs."""
        names = " ".join(f"PROG{number}" for number in programs[:4])
        more = f" +{len(programs) - 4}" if len(programs) > 4 else ""
        self._progress.update(
            self._task,
            completed=time_s,
            time=f"{time_s:.1f}{self._total} s",
            speed=f"{speed:.3g}x real time",
            programs=names + more or "no program runs",
        )


def bar_for(stream: TextIO, total_s: float | None, *, is_wanted: bool) -> Bar:
    """Give a bar for a terminal, and nothing for a file or pipe."""
    if is_wanted and stream.isatty():
        return TerminalBar(total_s)
    return Bar()


def _progress() -> "Progress":
    from rich.console import Console
    from rich.progress import BarColumn, Progress, SpinnerColumn, TextColumn

    return Progress(
        SpinnerColumn(),
        TextColumn("{task.fields[time]}"),
        BarColumn(bar_width=30),
        TextColumn("{task.fields[speed]}"),
        TextColumn("{task.fields[programs]}"),
        console=Console(stderr=True),
        transient=True,
        # Program output shares the screen with the bar only where both are terminals.
        redirect_stdout=sys.stdout.isatty(),
        redirect_stderr=True,
        refresh_per_second=8,
    )
