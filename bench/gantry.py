"""The gantry example, programs, plant and all, against real time."""

from bench.cards import gantry
from bench.figures import at_least, best_s

SPAN_S = 30.0


def main() -> None:
    card = gantry()
    card.advance(seconds=1.0)
    at_least(
        "gantry: times real time", SPAN_S / best_s(lambda: card.advance(seconds=SPAN_S)), 500, "x"
    )


if __name__ == "__main__":
    main()
