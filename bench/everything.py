"""Sixteen axes that do everything at once at 5 kHz, against real time.

Each axis takes part in a coordinated move, jogs, follows a gear and a cam, and closes its
servo loop through both filters on a modelled motor.
"""

from bench.cards import NAMES, jog_all, many_axes, move_all, type_lines
from bench.figures import at_least, best_s

SPAN_S = 4.0
PERIOD_S = 0.0002
TARGET = 150
MOVING, JOGGING, GEARING, CAMMING = 516, 792, 788, 790


def _each(text: str) -> str:
    """A statement for all axes: `NAME` stands for the axis."""
    command, value = text.split("*")
    return command + " ".join(f"{name}{value}" for name in NAMES)


def main() -> None:
    card = many_axes(16, 20.0)
    type_lines(card, f"PERIOD {PERIOD_S}", "DIM LA(1)", "DIM LA0(5)")
    type_lines(card, "LA0(1)=100 : LA0(2)=200 : LA0(3)=100")
    for line in ("PGAIN *0.002", "DGAIN *0.00001", "IGAIN *0.1", "ILIMIT *1", "FFVEL *0.000001"):
        type_lines(card, _each(line))
    type_lines(card, _each("LOPASS *300"), _each("NOTCH *(150,30)"))
    for n, name in enumerate(NAMES):
        type_lines(
            card, f"GEAR SRC {name} ENC{n}", f"GEAR RATIO {name}0.01", f"GEAR ON {name}",
            f"CAM DIM {name}1", f"CAM SEG {name}(0,4000,LA0)", f"CAM SRC {name} ENC{n}",
            f"CAM ON {name}",
        )  # fmt: skip
    jog_all(card, 0, 16)
    move_all(card)
    card.advance(seconds=0.5)
    took = best_s(lambda: card.advance(seconds=SPAN_S))
    for axis in range(16):
        flags = [MOVING, *(flag + 32 * axis for flag in (JOGGING, GEARING, CAMMING))]
        if axis < 8 and not all(card.bit[flag] for flag in flags):
            raise RuntimeError(f"axis {axis} does not do everything")
    name = "16 axes: move, jog, gear, cam, filters, plant, 5 kHz"
    at_least(name, SPAN_S / took, TARGET, "x")


if __name__ == "__main__":
    main()
