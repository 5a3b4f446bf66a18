"""How soon a query is answered over TCP while eight axes move in real time.

A bare asyncio echo server on the same machine takes turns with the card, so that the
noise of the machine shows in both.
"""

import re
import time
from collections.abc import Callable

from bench.figures import at_most, percentile, value_only
from bench.served import Line, echo_server, served_card, start_moving

BLOCKS, PER_BLOCK = 30, 100
BETWEEN_S = 0.0007
QUERY = b"?P12290\r"


def _measure(times: list[float], ask: Callable[[], object]) -> None:
    for _ in range(PER_BLOCK):
        began = time.perf_counter()
        ask()
        times.append((time.perf_counter() - began) * 1e3)
        time.sleep(BETWEEN_S)


def main() -> None:
    card_ms: list[float] = []
    echo_ms: list[float] = []
    with served_card() as served, echo_server() as echo_port:
        host, echo = Line.to(served.ascii_port), Line.to(echo_port)
        start_moving(host)
        for _ in range(BLOCKS):
            _measure(card_ms, lambda: host.ask(QUERY))
            _measure(echo_ms, lambda: echo.ask_bytes(QUERY, len(QUERY)))
        if host.ask(b"?BIT516\r") != b"?BIT516\r\n-1\r\nP00>":
            raise RuntimeError("the axes did not move all the time")
    at_most("terminal query, 99 % answered within", percentile(card_ms, 0.99), 2.0, "ms")
    value_only("terminal query, median", percentile(card_ms, 0.5), "ms")
    value_only("bare echo server, 99 %", percentile(echo_ms, 0.99), "ms")
    value_only("bare echo server, median", percentile(echo_ms, 0.5), "ms")
    ratio = percentile(card_ms, 0.5) / percentile(echo_ms, 0.5)
    value_only("terminal query to echo, medians", ratio, "x")
    found = re.search(r"([\d.]+) ms \(median\), ([\d.]+) ms \(99 %\)", served.pacing)
    if found is None:
        raise RuntimeError(f"no pacing report: {served.pacing}")
    at_most("pacing error, 99 %", float(found[2]), 5.0, "ms")
    value_only("pacing error, median", float(found[1]), "ms")


if __name__ == "__main__":
    main()
