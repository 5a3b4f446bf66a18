"""A life with late handlers; as a module it prints the digests, for another build to compare."""

import json

from tests.parity.journeys import JOURNEYS, card, take


def digests() -> list[str]:
    """Of the card after every step of two journeys."""
    found = []
    for name in ("jogs", "programs"):
        made = card()
        made.delay_handlers(20, seed=3)
        for step in JOURNEYS[name]:
            take(made, step)
            found.append(made.digest())
    return found


if __name__ == "__main__":
    print(json.dumps(digests()))
