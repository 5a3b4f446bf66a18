"""Snapshot, restore and digest of a card in motion."""

from bench.cards import gantry
from bench.figures import best_s, value_only

TIMES = 20


def main() -> None:
    card = gantry()
    card.advance(seconds=10.0)
    snapshot = card.snapshot()

    def repeat(work: object) -> float:
        return best_s(lambda: [work() for _ in range(TIMES)]) / TIMES * 1e3  # type: ignore[operator]

    value_only("snapshot", repeat(card.snapshot), "ms")
    value_only("restore", repeat(lambda: card.restore(snapshot)), "ms")
    value_only("digest", repeat(card.digest), "ms")


if __name__ == "__main__":
    main()
