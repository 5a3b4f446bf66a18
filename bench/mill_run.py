"""A part program from its text to the last pulse: how many times faster than real time?"""

import math
import time
from collections.abc import Iterator

from bench.figures import at_least
from openacr.cnc.loading.load import load
from openacr.mill.session import MillSession, Start
from openacr.sysvar import Store

MOVES, FEED_UPM = 8000, 6000.0
RADIUS, STEP_RAD = 50.0, 0.01  # 0.5 mm a move: one every 5 ms
MAX_MACHINE_SPEED, FEED_ACC = 650_000, 650_008


def surface() -> Iterator[str]:
    """A winding way of short straight moves."""
    yield f"G21 G90 G64 F{FEED_UPM}"
    for n in range(MOVES):
        angle = n * STEP_RAD
        x, y = RADIUS * (math.cos(angle) - 1.0), RADIUS * math.sin(angle)
        yield f"G1 X{x:.4f} Y{y:.4f} Z{0.5 * math.sin(angle / 7):.4f}"
    yield "M2"


def main() -> None:
    store = Store()
    store.write(MAX_MACHINE_SPEED, 2.0 * FEED_UPM)
    store.write(FEED_ACC, 1000.0)
    shop = MillSession.virtual(store, say=lambda _text: None)
    program = load("\n".join(surface()), shop.cells)
    began = time.process_time()
    shop.start(program, Start())
    while shop.runner.is_busy:
        shop.step()
    lasted = time.process_time() - began
    shop.close()
    ratio = shop.runner.run_s / lasted
    at_least(f"{MOVES} moves of 0.5 mm, {shop.runner.run_s:.0f} s of machine", ratio, 20.0, "x")


if __name__ == "__main__":
    main()
