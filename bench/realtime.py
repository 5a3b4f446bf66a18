"""The loop on the wall clock: how late its ticks begin, beside cyclictest, and what it computes.

Both run at the same priority for the same time, one after the other, if this computer has
cyclictest (package rt-tests) and gives the right.
"""

import re
import shutil
import subprocess
import time

from bench.cards import many_axes, move_all
from bench.figures import at_most, value_only
from openacr.channels import StreamKind
from openacr.compiled import is_compiled
from openacr.controller import Controller
from openacr.controller.realtime_loop import RealtimeFigures
from openacr.errors import UserError
from openacr.io.realtime_rights import PRIORITY, RealtimeRights

SPAN_S = 10.0
MOST_US = 2000
ATTENDED = 20  # looks at the loop between two lines of a host


def live(axis_count: int, period_s: float, span_s: float) -> RealtimeFigures:
    """Some axes in one move for a time, with Python beside them."""
    card = many_axes(axis_count)
    card.ask(f"PERIOD {period_s}\r")
    move_all(card, axis_count)
    return _figures(card, span_s)


def _figures(card: Controller, span_s: float) -> RealtimeFigures:
    rights = RealtimeRights()
    loop = card.real_time()
    loop.start(rights.take)
    try:
        host = loop.open_stream(StreamKind.TERMINAL)
        end_s = time.monotonic() + span_s
        while time.monotonic() < end_s:
            loop.receive(host, b"VER\r")  # what its line leaves in the state is taken over
            while loop.take_output(host):
                pass
            for _ in range(ATTENDED):
                loop.advance()
                time.sleep(0.001)
    finally:
        loop.close()
        rights.give_back()
    return loop.figures()


def cyclictest_us(interval_us: int, span_s: float) -> tuple[float, float] | None:
    """Lateness of 99.99 % of the cycles and the worst; None if it cannot run."""
    command = shutil.which("cyclictest")
    if command is None:
        return None
    loops = round(span_s * 1e6 / interval_us)
    options = ["-q", "-m", "-t1", f"-p{PRIORITY}", f"-i{interval_us}", f"-l{loops}", f"-h{MOST_US}"]
    made = subprocess.run([command, *options], capture_output=True, text=True, check=False)
    bins = [(int(a), int(b)) for a, b in re.findall(r"^(\d+)\s+(\d+)$", made.stdout, re.M)]
    worst = re.search(r"# Max Latencies: (\d+)", made.stdout)
    if worst is None:
        return None
    seen, wanted = 0, 0.9999 * sum(count for _, count in bins)
    for late_us, count in bins:
        seen += count
        if count and seen >= wanted:
            return float(late_us), float(worst[1])
    return float(worst[1]), float(worst[1])


def main(span_s: float = SPAN_S) -> None:
    """Print the figures."""
    if not is_compiled:
        print("real time: needs the compiled core")
        return
    try:
        RealtimeRights()
    except UserError as failure:
        print(f"real time: {failure}")
        return
    for axis_count, period_s in ((4, 0.001), (8, 0.0005)):
        name = f"real time, {axis_count} axes, {1e-3 / period_s:g} kHz"
        beside = cyclictest_us(round(1e6 * period_s), span_s)
        found = live(axis_count, period_s, span_s)
        late_us = 1e6 * found.wake.most_s
        if beside is None:
            value_only(f"{name}: late, 99.99 %", late_us, "us")
        else:
            value_only(f"{name}: cyclictest, worst", beside[1], "us")
            at_most(f"{name}: late, 99.99 %", late_us, beside[0] + 20.0, "us")
        value_only(f"{name}: late, worst", 1e6 * found.wake.worst_s, "us")
        value_only(f"{name}: missed periods", found.missed, "")
        at_most(f"{name}: computing", 100.0 * found.work.median_s / period_s, 15, "%")
        at_most(f"{name}: computing, 99.99 %", 100.0 * found.work.most_s / period_s, 15, "%")
        at_most(f"{name}: taking a list over, worst", 1e6 * found.worst_take_s, 20, "us")


if __name__ == "__main__":
    main()
