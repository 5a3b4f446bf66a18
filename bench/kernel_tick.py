"""The servo interrupt alone: 16 axes idle, moving and mixed, without plant and programs.

The targets are the figures of a first prototype on another machine.
"""

from bench.cards import NAMES, jog_all, many_axes, move_all
from bench.figures import at_most, best_s, value_only
from openacr.controller import Controller
from openacr.map.rows import axes, motors

TICKS = 20_000


def _ns(card: Controller) -> float:
    card.leave_out_rest(False)
    return best_s(lambda: card.advance(TICKS)) / TICKS * 1e9


def _without_plant(card: Controller) -> Controller:
    for axis in range(16):
        card.memory.I[motors.kind[axis]] = 0
    return card


def main() -> None:
    card = _without_plant(many_axes())
    at_most("servo interrupt, 16 axes at rest", _ns(card), 222, "ns")
    for axis in range(16):
        card.memory.I[axes.on[axis]] = 0
    value_only("servo interrupt, 16 axes off", _ns(card), "ns")
    card = _without_plant(many_axes())
    move_all(card)
    at_most("servo interrupt, 16 axes in one move", _ns(card), 341, "ns")
    card = _without_plant(many_axes())
    jog_all(card, 0, 8)
    card.send("".join(f" {name}1e6" for name in NAMES[8:]) + "\r")
    at_most("servo interrupt, 8 axes jogging, 8 in a move", _ns(card), 571, "ns")


if __name__ == "__main__":
    main()
