"""How soon a query is answered over TCP while eight axes move in real time.

A bare asyncio echo server on the same machine takes turns with the card, so that the
noise of the machine shows in both; the quietest of some rounds counts.
"""

import re
import time
from collections.abc import Callable
from dataclasses import dataclass, field

from bench.figures import at_most, percentile, value_only
from bench.served import Line, echo_server, served_card, start_moving

ROUNDS, BLOCKS, PER_BLOCK = 4, 10, 100
BETWEEN_S = 0.0007
QUERY = b"?P12290\r"


@dataclass
class Round:
    """Times [ms] of the card and of the echo server in the same seconds."""

    card_ms: list[float] = field(default_factory=list)
    echo_ms: list[float] = field(default_factory=list)

    @property
    def slowest(self) -> float:
        """The time within which 99 % of the queries were answered."""
        return percentile(self.card_ms, 0.99)


def _measure(times: list[float], ask: Callable[[], object]) -> None:
    for _ in range(PER_BLOCK):
        began = time.perf_counter()
        ask()
        times.append((time.perf_counter() - began) * 1e3)
        time.sleep(BETWEEN_S)


def _round(host: Line, echo: Line) -> Round:
    found = Round()
    for _ in range(BLOCKS):
        _measure(found.card_ms, lambda: host.ask(QUERY))
        _measure(found.echo_ms, lambda: echo.ask_bytes(QUERY, len(QUERY)))
    return found


def main() -> None:
    with served_card() as served, echo_server() as echo_port:
        host, echo = Line.to(served.ascii_port), Line.to(echo_port)
        start_moving(host)
        best = min((_round(host, echo) for _ in range(ROUNDS)), key=lambda each: each.slowest)
        if host.ask(b"?BIT516\r") != b"?BIT516\r\n-1\r\nP00>":
            raise RuntimeError("the axes did not move all the time")
    at_most("terminal query, 99 % answered within", best.slowest, 2.0, "ms")
    value_only("terminal query, median", percentile(best.card_ms, 0.5), "ms")
    value_only("bare echo server, 99 %", percentile(best.echo_ms, 0.99), "ms")
    value_only("bare echo server, median", percentile(best.echo_ms, 0.5), "ms")
    for name, part in (("medians", 0.5), ("99 %", 0.99)):
        ratio = percentile(best.card_ms, part) / percentile(best.echo_ms, part)
        value_only(f"terminal query to echo, {name}", ratio, "x")
    found = re.search(r"([\d.]+) ms \(median\), ([\d.]+) ms \(99 %\)", served.pacing)
    if found is None:
        raise RuntimeError(f"no pacing report: {served.pacing}")
    at_most("pacing error, 99 %", float(found[2]), 5.0, "ms")
    value_only("pacing error, median", float(found[1]), "ms")


if __name__ == "__main__":
    main()
