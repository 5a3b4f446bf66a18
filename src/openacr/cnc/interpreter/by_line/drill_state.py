"""The canned cycle in force, as rows for the core (`cycles_cy`) and back."""

from __future__ import annotations

from typing import TYPE_CHECKING

from openacr.cnc.codes.active import Drilling
from openacr.cnc.codes.gcodes.cycles import clearances, shift_signs
from openacr.cnc.rows import holes, modes

if TYPE_CHECKING:
    from openacr.cnc.interpreter.by_block.inside import Inside

_WORDS = (("Q", modes.HAS_PECK, holes.peck), ("P", modes.HAS_REST, holes.rest_s))


def take_drilling(run: Inside) -> None:
    """Write what cycles need to know of an interpreter."""
    F, I = run.memory.F, run.memory.I
    drilling = run.drilling or Drilling()
    I[modes.is_drilling], I[holes.rises] = run.drilling is not None, run.dialect.rises_first
    F[holes.initial_u] = drilling.initial
    for level, number, how in (
        (drilling.level, holes.level_u, modes.level_form),
        (drilling.bottom, holes.bottom_u, modes.bottom_form),
    ):
        F[number] = level[0] if level else 0.0
        I[how] = (modes.INCREMENTS if level[1] else modes.WRITTEN) if level else 0
    I[modes.cycle_words] = 0
    for letter, mask, number in _WORDS:
        if letter in drilling.words:
            I[modes.cycle_words] |= mask
            F[number] = drilling.words[letter]
    F[holes.spin] = float(run.modal.spin.value)
    F[holes.clear_u[0]], F[holes.clear_u[1]] = clearances(run)
    F[holes.sign[0]], F[holes.sign[1]] = shift_signs(run)


def hand_back_drilling(run: Inside) -> None:
    """Give an interpreter the cycle in force after lines that were executed together."""
    F, I = run.memory.F, run.memory.I
    if not I[modes.is_drilling]:
        run.drilling = None
        return
    words = {a: F[number] for a, mask, number in _WORDS if I[modes.cycle_words] & mask}
    level, bottom = (
        (F[number], I[how] == modes.INCREMENTS) if I[how] else None
        for number, how in ((holes.level_u, modes.level_form), (holes.bottom_u, modes.bottom_form))
    )
    run.drilling = Drilling(F[holes.initial_u], level, bottom, words)
