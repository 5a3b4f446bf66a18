"""Take over what a handler has changed on its copy of the state: a list, entry by entry.

Entry k is L[6 k] to L[6 k + 5]: what is to be done, where, and 64 bits before and after (or
32 bits in each first half); a call of the kernel has its number, its two whole numbers and its
value there. Nothing here waits, allocates or fails: the loop does it between two ticks.
"""

from openacr.kernel.calls_cy import kernel_call
from openacr.views import F32, F64, I32

__all__ = ["changes_take"]

ENTRY = 6

# What is done; 0 to 8 are the cells of map/merging.py.
WORD = 0
BITS = 1
WORD_SHIFT = 2
ORDER_WORD = 4
NUMBER = 5
NUMBER_SHIFT = 6
ORDER_NUMBER = 8
CALL = 16
MASKED = 17  # some bits of a word, given as a mask and their values


def changes_take(F: F64, I: I32, S: F32, L: I32, D: F64, first: int, count: int) -> None:
    """Change the state by `count` entries of a list from `first` on; D are its 64-bit numbers."""
    for k in range(first, first + count):
        e: int = ENTRY * k
        kind: int = L[e]
        place: int = L[e + 1]
        if kind == WORD or kind == ORDER_WORD:
            I[place] = L[e + 4]
        elif kind == BITS:
            I[place] = I[place] ^ (L[e + 2] ^ L[e + 4])
        elif kind == WORD_SHIFT:
            I[place] = I[place] + (L[e + 4] - L[e + 2])
        elif kind == NUMBER or kind == ORDER_NUMBER:
            I[2 * place] = L[e + 4]
            I[2 * place + 1] = L[e + 5]
        elif kind == NUMBER_SHIFT:
            if I[2 * place] == L[e + 2] and I[2 * place + 1] == L[e + 3]:
                I[2 * place] = L[e + 4]
                I[2 * place + 1] = L[e + 5]
            else:
                F[place] = F[place] + (D[3 * k + 2] - D[3 * k + 1])
        elif kind == MASKED:
            I[place] = (I[place] & ~L[e + 2]) | (L[e + 4] & L[e + 2])
        elif kind == CALL:
            kernel_call(F, I, S, place, L[e + 2], L[e + 3], D[3 * k + 2])
