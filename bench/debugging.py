"""What debugging costs: armed data breakpoints, and steps back after an hour."""

import statistics
import time
from collections.abc import Callable, Iterator, Sequence

from bench.cards import gantry
from bench.figures import RUNS, at_most, best_s, value_only
from openacr.debugger.breakpoints import DataBreakpoint
from openacr.debugger.card_course import CardCourse
from openacr.debugger.stops import Reason
from openacr.timeline import Timeline
from openacr.wording import counted

RUN_S = 60.0
HOUR_S = 3600.0
STEPS = 50
UNUSED_AXES = range(8, 16)  # of the gantry: their positions never change
COUNTS = (0, 1, 8)  # of data breakpoints
ARMED = tuple(DataBreakpoint(f"P{12288 + 256 * axis}") for axis in UNUSED_AXES)


def main() -> None:
    _armed()
    _steps_back()


def _armed() -> None:
    """The gantry with its history alone, in a session, and with breakpoints that never stop it.

    They run in turn, so that all meet the same state of the machine that measures.
    """
    history = Timeline(gantry())
    ticks = round(RUN_S / history.card.period_s)
    runs = [lambda: history.advance(ticks), *(_session(count, ticks) for count in COUNTS)]
    alone_s, unarmed_s, *armed_s = (min(times) for times in zip(*_in_turn(runs), strict=True))
    value_only("debugging: the gantry without breakpoints", RUN_S / unarmed_s, "x real")
    at_most("  to the card with its history", unarmed_s / alone_s, 1.1, "")
    for count, spent_s in zip(COUNTS[1:], armed_s, strict=True):
        armed = counted(count, "data breakpoint")
        at_most(f"  with {armed} armed, to none", spent_s / unarmed_s, 1.2, "")


def _session(count: int, ticks: int) -> Callable[[], object]:
    """Runs the gantry on, with that many data breakpoints armed."""
    session = CardCourse(gantry())
    session.set_data(list(ARMED[:count]))

    def run() -> None:
        if session.run(ticks) is not None:
            raise RuntimeError("a breakpoint on a value that does not change has stopped the card")

    return run


def _in_turn(runs: Sequence[Callable[[], object]]) -> Iterator[list[float]]:
    """The CPU times of all runs, round by round."""
    for _ in range(RUNS):
        yield [best_s(run, 1) for run in runs]


def _steps_back() -> None:
    """Steps back from the end of an hour of the gantry, a line each."""
    session = CardCourse(gantry())
    session.run(round(HOUR_S / session.card.period_s))
    times = []
    for _ in range(STEPS):
        began = time.process_time()
        if session.step_back(0).reason is not Reason.STEP:
            raise RuntimeError("PROG0 has no line before")
        times.append(1000 * (time.process_time() - began))
    value_only("debugging: history of an hour", session.timeline.size_bytes / 1e6, "MB")
    at_most("debugging: a step back after an hour, median", statistics.median(times), 100.0, "ms")
    at_most("debugging: a step back after an hour, longest", max(times), 100.0, "ms")


if __name__ == "__main__":
    main()
