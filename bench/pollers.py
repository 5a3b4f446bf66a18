"""Eight hosts that poll fifty times a second while eight axes move: is real time kept?"""

import re
import threading
import time

from bench.figures import at_most, percentile, value_only
from bench.served import Line, Served, served_card, start_moving

SECONDS, ROUNDS = 4.0, 3  # the quietest round counts
EVERY_S = 0.02
TERMINALS, PACKETS = 3, 5  # the fourth terminal has started the motion
STATUS = b"".join(bytes((0x00, 0x30, index, 0xFF)) for index in (0, 1, 2, 3, 6))
STATUS_REPLY = 5 * 36


def _poll(times_ms: list[float], line: Line, *, is_text: bool, end_s: float) -> None:
    """Ask at a steady rate; what comes late does not shift what follows."""
    due_s = time.monotonic()
    while due_s < end_s:
        began = time.perf_counter()
        if is_text:
            line.ask(b"?P12290\r")
        else:
            line.ask_bytes(STATUS, STATUS_REPLY)
        times_ms.append((time.perf_counter() - began) * 1e3)
        due_s += EVERY_S
        time.sleep(max(0.0, due_s - time.monotonic()))


def _measure(served: Served) -> list[float]:
    times_ms: list[float] = []
    lines = [(Line.to(served.ascii_port), True) for _ in range(TERMINALS)]
    lines += [(Line.to(served.binary_port), False) for _ in range(PACKETS)]
    end_s = time.monotonic() + SECONDS
    threads = [
        threading.Thread(
            target=_poll, args=(times_ms, line), kwargs={"is_text": is_text, "end_s": end_s}
        )
        for line, is_text in lines
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return times_ms


def _round() -> tuple[float, float, list[float]]:
    """Pacing error [ms] of a card of its own, 99 % and worst, and the times of its answers."""
    with served_card() as served:
        start_moving(Line.to(served.ascii_port))
        times_ms = _measure(served)
    found = re.search(r"([\d.]+) ms \(99 %\), ([\d.]+) ms \(worst\)", served.pacing)
    if found is None:
        raise RuntimeError(f"no pacing report: {served.pacing}")
    return float(found[1]), float(found[2]), times_ms


def main() -> None:
    error_ms, worst_ms, times_ms = min(_round() for _ in range(ROUNDS))
    at_most("pacing error with 8 hosts at 50 Hz, 99 %", error_ms, 5.0, "ms")
    value_only("pacing error with 8 hosts at 50 Hz, worst", worst_ms, "ms")
    value_only("their polls, each", len(times_ms) / 8 / SECONDS, "1/s")
    value_only("answered within, 99 %", percentile(times_ms, 0.99), "ms")


if __name__ == "__main__":
    main()
