"""Binary packets over TCP while eight axes move in real time."""

import time
from collections.abc import Callable

from bench.figures import at_least, at_most, percentile, value_only
from bench.served import Line, served_card, start_moving

COUNT, ROUNDS = 1000, 8
TOGETHER = 50
GET_LONG = bytes.fromhex("00 88 02 30")
GET_GROUP = bytes.fromhex("00 30 02 FF")
LONG_REPLY, GROUP_REPLY = 8, 36


def _times_ms(count: int, ask: Callable[[], object]) -> list[float]:
    times = []
    for _ in range(count):
        began = time.perf_counter()
        ask()
        times.append((time.perf_counter() - began) * 1e3)
    return times


def _best(count: int, ask: Callable[[], object]) -> list[float]:
    """The times of the quietest of some rounds."""
    rounds = (_times_ms(count, ask) for _ in range(ROUNDS))
    return min(rounds, key=lambda times: percentile(times, 0.99))


def _per_s(times_ms: list[float]) -> float:
    return 1e3 * len(times_ms) / sum(times_ms)


def main() -> None:
    with served_card() as served:
        start_moving(Line.to(served.ascii_port))
        host = Line.to(served.binary_port)
        one = _best(COUNT, lambda: host.ask_bytes(GET_LONG, LONG_REPLY))
        group = _best(COUNT, lambda: host.ask_bytes(GET_GROUP, GROUP_REPLY))
        many = _best(
            COUNT // TOGETHER,
            lambda: host.ask_bytes(GET_LONG * TOGETHER, LONG_REPLY * TOGETHER),
        )
        groups = _best(
            COUNT // TOGETHER,
            lambda: host.ask_bytes(GET_GROUP * TOGETHER, GROUP_REPLY * TOGETHER),
        )
    at_most("parameter get, round trip, median", percentile(one, 0.5), 0.15, "ms")
    at_most("parameter get, round trip, 99 %", percentile(one, 0.99), 1.0, "ms")
    value_only("parameter packets, one after the other", _per_s(one), "1/s")
    value_only("packets of eight parameters, one after the other", _per_s(group), "1/s")
    at_least("parameter packets, fifty at a time", _per_s(many) * TOGETHER, 20000, "1/s")
    at_least("parameters in packets of eight", _per_s(groups) * TOGETHER * 8, 100000, "1/s")


if __name__ == "__main__":
    main()
