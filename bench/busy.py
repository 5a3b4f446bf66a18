"""A card with everything at work: sixteen programs, eight PLCs and eight moving axes."""

from bench.cards import jog_all, many_axes, type_lines
from bench.figures import at_least, best_s, value_only
from openacr.controller import Controller

SPAN_S = 10.0
PROGRAMS, PLCS, AXES = 16, 8, 8
RUNGS = 50  # of four instructions: as many as a PLC can hold
LOOP = ("_L", "P{n}=P{n}+1", "IF (P{n} AND 1) THEN P{m}=P{m}*0.5+3", "GOTO L")


def busy() -> Controller:
    """All programs in endless loops, full PLCs that are scanned in every interrupt."""
    card = many_axes(AXES)
    jog_all(card, 0, AXES)
    type_lines(card, "SYS", "DIM P(100)")
    for number in range(PLCS):
        type_lines(card, "SYS", f"DIM PLC{number}(4000)", f"PLC{number}", "PROGRAM")
        for rung in range(RUNGS):
            a, b = 128 + rung % 30, 160 + (rung + number) % 30
            type_lines(card, f"LD {a}", f"AND NOT {b}", f"OR {a + 1}", f"OUT {b + 1}")
        type_lines(card, "ENDP", "RUN")
    for number in range(PROGRAMS):
        if number >= 8:
            type_lines(card, "SYS", f"DIM PROG{number}(2000)")
        lines = (line.format(n=number, m=number + 50) for line in LOOP)
        type_lines(card, f"PROG{number}", "PROGRAM", *lines, "ENDP", "RUN")
    return card


def main() -> None:
    card = busy()
    card.advance(seconds=1.0)
    before = sum(card.p[number] for number in range(PROGRAMS))
    spent = best_s(lambda: card.advance(seconds=SPAN_S))
    if not card.bit[792] or card.p[0] == 0:
        raise RuntimeError("axis 0 does not jog, or program 0 does not run")
    per_s = (sum(card.p[number] for number in range(PROGRAMS)) - before) / card.p[6916]
    at_least("16 programs, 8 PLCs, 8 axes: times real time", SPAN_S / spent, 200, "x")
    value_only("  passes of the programs' loops per second", 1000 * per_s, "1/s")


if __name__ == "__main__":
    main()
