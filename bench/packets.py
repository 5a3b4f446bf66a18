"""Binary packets per second over TCP while eight axes move in real time."""

import time
from collections.abc import Callable

from bench.figures import value_only
from bench.served import Line, served_card, start_moving

COUNT = 3000
TOGETHER = 50
GET_LONG = bytes.fromhex("00 88 02 30")
GET_GROUP = bytes.fromhex("00 30 02 FF")


def _per_s(count: int, ask: Callable[[], object]) -> float:
    began = time.perf_counter()
    for _ in range(count):
        ask()
    return count / (time.perf_counter() - began)


def main() -> None:
    with served_card() as served:
        start_moving(Line.to(served.ascii_port))
        host = Line.to(served.binary_port)
        one = _per_s(COUNT, lambda: host.ask_bytes(GET_LONG, 8))
        group = _per_s(COUNT, lambda: host.ask_bytes(GET_GROUP, 36))
        many = _per_s(COUNT // TOGETHER, lambda: host.ask_bytes(GET_LONG * TOGETHER, 8 * TOGETHER))
    value_only("parameter packets, one after the other", one, "1/s")
    value_only("packets of eight parameters, one after the other", group, "1/s")
    value_only("parameter packets, fifty at a time", many * TOGETHER, "1/s")


if __name__ == "__main__":
    main()
