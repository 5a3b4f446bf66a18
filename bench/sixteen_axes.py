"""Sixteen moving axes with full servo and modelled plant at 2 kHz, against real time."""

from bench.cards import jog_all, many_axes, move_all
from bench.figures import at_least, best_s

SPAN_S = 10.0
REST_S = 1000.0


def main() -> None:
    card = many_axes()
    left_out = best_s(lambda: card.advance(seconds=REST_S))
    card.leave_out_rest(False)
    still = best_s(lambda: card.advance(seconds=SPAN_S))
    move_all(card)
    card.advance(seconds=1.0)
    moved = best_s(lambda: card.advance(seconds=SPAN_S))
    if not card.bit[516]:
        raise RuntimeError("the move has ended too early")
    at_least("16 axes, one coordinated move: times real time", SPAN_S / moved, 300, "x")
    card = many_axes()
    jog_all(card, 0, 16)
    card.advance(seconds=1.0)
    jogged = best_s(lambda: card.advance(seconds=SPAN_S))
    at_least("16 axes jogging: times real time", SPAN_S / jogged, 300, "x")
    at_least("16 axes at rest, each tick in full: times real time", SPAN_S / still, 1000, "x")
    at_least("16 axes at rest: times real time", REST_S / left_out, 50_000, "x")


if __name__ == "__main__":
    main()
