"""Back in time: an hour of the gantry, sought at random moments."""

import random
import statistics
import time

from bench.cards import gantry
from bench.figures import at_most, value_only
from openacr.timeline import Timeline

HOUR_S = 3600.0
SEEKS = 50


def main() -> None:
    card = gantry()
    timeline = Timeline(card)
    begin = time.perf_counter()
    timeline.advance(round(HOUR_S / card.period_s))
    spent_s = time.perf_counter() - begin
    first, last = timeline.branch.first.tick, timeline.branch.last.tick
    times = []
    for _ in range(SEEKS):
        tick = random.randint(first, last)
        begin = time.perf_counter()
        timeline.seek(tick)
        times.append(1000 * (time.perf_counter() - begin))
    value_only("timeline: an hour of the gantry", HOUR_S / spent_s, "x real")
    value_only("timeline: keyframes and inputs of the hour", timeline.size_bytes / 1e6, "MB")
    at_most("timeline: any moment of the hour, median", statistics.median(times), 100.0, "ms")
    value_only("timeline: any moment of the hour, longest", max(times), "ms")
