"""Back in time: an hour of the gantry, sought at random moments; what recording costs."""

import random
import statistics
import tempfile
import time
from itertools import count
from pathlib import Path

from bench.cards import gantry
from bench.figures import at_most, best_s, value_only
from openacr.panel.commands.all import carry_out
from openacr.panel.control.station import Station
from openacr.panel.machine import embedded
from openacr.timeline import Timeline

HOUR_S = 3600.0
SEEKS = 50
OPERATED_S = 300.0  # of the virtual mill with its screens
STEP_S = 0.002
RECORDED_S = 5.0


def main() -> None:
    _hour()
    _operated()


def _hour() -> None:
    """An hour of programs on a card."""
    card = gantry()
    timeline = Timeline(card)
    begin = time.perf_counter()
    timeline.advance(round(HOUR_S / card.period_s))
    spent_s = time.perf_counter() - begin
    times = _seeks_ms(timeline)
    value_only("timeline: an hour of the gantry", HOUR_S / spent_s, "x real")
    value_only("timeline: keyframes and inputs of the hour", timeline.size_bytes / 1e6, "MB")
    at_most("timeline: any moment of the hour, median", statistics.median(times), 100.0, "ms")
    value_only("timeline: any moment of the hour, longest", max(times), "ms")


def _seeks_ms(timeline: Timeline) -> list[float]:
    first, last = timeline.branch.first.tick, timeline.branch.last.tick
    times = []
    for _ in range(SEEKS):
        tick = random.randint(first, last)
        begin = time.perf_counter()
        timeline.seek(tick)
        times.append(1000 * (time.perf_counter() - begin))
    return times


def _operated() -> None:
    """The virtual mill with the polls of its screens, by hand."""
    with tempfile.TemporaryDirectory() as folder:
        installation = embedded(Path(folder))
        station = Station(installation, carry_out)
        clock = count(1)

        def run(seconds: float) -> None:
            for _ in range(round(seconds / STEP_S)):
                station.step(next(clock) * STEP_S)

        station.open(0.0)
        history = station.times.history
        run(OPERATED_S)
        hour_mb = history.timeline.size_bytes / 1e6 * HOUR_S / OPERATED_S
        recorded_s = best_s(lambda: run(RECORDED_S))
        station.times.seek(history.lived_tk)
        times = _seeks_ms(history.timeline)
        station.times.operate(next(clock) * STEP_S)
        history.card.recorder = None
        ratio = recorded_s / best_s(lambda: run(RECORDED_S))
        station.close()
        installation.close()
    value_only("timeline: an hour of the operated virtual mill", hour_mb, "MB")
    at_most("timeline: any moment of it, median", statistics.median(times), 100.0, "ms")
    at_most("timeline: CPU time of it, recorded to not recorded", ratio, 1.1, "")
