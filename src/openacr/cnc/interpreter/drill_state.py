"""The canned cycle in force, as rows for the core (`cycles_cy`) and back."""

from __future__ import annotations

from typing import TYPE_CHECKING

from openacr.cnc.codes.active import Drilling
from openacr.cnc.codes.gcodes.cycles import clearances, shift_signs
from openacr.cnc.interpreter import run_rows_cy as core

if TYPE_CHECKING:
    from openacr.cnc.interpreter.inside import Inside
    from openacr.views import F64, I32

_WORDS = (("Q", core.HAS_PECK, core.W_PECK), ("P", core.HAS_REST, core.W_REST))


def take_drilling(run: Inside, W: F64, M: I32) -> None:
    """Write what cycles need to know of an interpreter."""
    drilling = run.drilling or Drilling()
    M[core.M_IS_DRILLING], M[core.M_RISES] = run.drilling is not None, run.dialect.rises_first
    W[core.W_INITIAL] = drilling.initial
    levels = (drilling.level, core.W_LEVEL, core.M_LEVEL), (
        drilling.bottom, core.W_BOTTOM, core.M_BOTTOM,
    )  # fmt: skip
    for level, number, how in levels:
        W[number] = level[0] if level else 0.0
        M[how] = (core.INCREMENTS if level[1] else core.WRITTEN) if level else 0
    M[core.M_WORDS] = 0
    for letter, mask, number in _WORDS:
        if letter in drilling.words:
            M[core.M_WORDS] |= mask
            W[number] = drilling.words[letter]
    W[core.W_SPIN] = float(run.modal.spin.value)
    W[core.W_CLEAR], W[core.W_CLEAR + 1] = clearances(run)
    W[core.W_SIGNS], W[core.W_SIGNS + 1] = shift_signs(run)


def hand_back_drilling(run: Inside, W: F64, M: I32) -> None:
    """Give an interpreter the cycle in force after lines that were executed together."""
    if not M[core.M_IS_DRILLING]:
        run.drilling = None
        return
    words = {a: W[number] for a, mask, number in _WORDS if M[core.M_WORDS] & mask}
    level, bottom = (
        (W[number], M[how] == core.INCREMENTS) if M[how] else None
        for number, how in ((core.W_LEVEL, core.M_LEVEL), (core.W_BOTTOM, core.M_BOTTOM))
    )
    run.drilling = Drilling(W[core.W_INITIAL], level, bottom, words)
