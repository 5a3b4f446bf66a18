"""Statements per second of the byte-code machine."""

from bench.cards import type_lines
from bench.figures import at_least, best_s, value_only
from openacr.basic.vm.vm_cy import vm_run
from openacr.compiled import pick
from openacr.controller import Controller

STATEMENTS = 1_000_000
_run = pick(vm_run)
PROGRAMS = {
    "assignments": ("_L", "P0=P0+1", "P1=P0*2-3", "GOTO L"),
    "loop": ("_L", "FOR P2=1 TO 100", "P0=P0+P2", "NEXT", "GOTO L"),
    "decisions": ("_L", "P0=P0+1", "IF (P0 AND 1) THEN P1=P1+1", "GOTO L"),
}


def _per_s(lines: tuple[str, ...]) -> float:
    card = Controller()
    type_lines(card, "DIM P(10)", "PROG0", "PROGRAM", *lines, "ENDP", "RUN")
    memory, space = card.memory, card.executor.threads.space
    views = memory.F, memory.I, memory.S, space.code, space.nums

    def run() -> None:
        _run(*views, 0, STATEMENTS, 1)

    seconds = best_s(run)
    if card.memory.read(0) == 0:
        raise RuntimeError("the program did not run")
    return STATEMENTS / seconds


def main() -> None:
    found = {name: _per_s(lines) for name, lines in PROGRAMS.items()}
    at_least("program statements per second", found.pop("assignments") / 1e6, 110, "M/s")
    for name, per_s in found.items():
        value_only(f"program statements per second, {name}", per_s / 1e6, "M/s")


if __name__ == "__main__":
    main()
