"""Variables, parameters and flags of AcroBASIC: where they lie and how they are converted."""

from openacr import messages
from openacr.basic.vm.arith_cy import (
    finite,
    long_word,
)
from openacr.map import numbers as at
from openacr.map.flags_cy import flag_bit, put_flag
from openacr.map.kinds_cy import kind_of, store_long
from openacr.map.rows import system
from openacr.views import F32, F64, I32

__all__ = ["read_bit", "read_parameter", "write_bit", "write_parameter"]

FLOAT32_LIMIT = 3.4028235677973366e38  # from here on rounding to FP32 overflows

# Kinds of locals; the numbers of basic.nodes.LocalKind.
KIND_OF_LV = 0
KIND_OF_SV = 1
KIND_OF_DV = 2


def whole_index(value: float) -> int:
    """A number from the stack as an index; beyond 32 bits it is one that exists nowhere."""
    if not (-2147483648.0 < value < 2147483647.0):
        return 2147483647
    return int(value)


def store_single(S: F32, place: int, value: float) -> int:
    """Store into an FP32 row, rounded to nearest."""
    if not (-FLOAT32_LIMIT < value < FLOAT32_LIMIT):
        return messages.MATH_ERROR.number
    S[place] = value
    return 0


def load_kind(F: F64, I: I32, S: F32, kind: int, place: int, to: int) -> int:
    """F[to] := the local variable or array element at `place`."""
    if kind == KIND_OF_LV:
        F[to] = float(I[place])
    elif kind == KIND_OF_SV:
        F[to] = S[place]
    else:
        F[to] = F[place]
    return 0


def store_kind(F: F64, I: I32, S: F32, kind: int, place: int, value: float) -> int:
    """Store into the local variable or array element at `place`."""
    if kind == KIND_OF_LV:
        I[place] = long_word(value)
    elif kind == KIND_OF_SV:
        return store_single(S, place, value)
    else:
        F[place] = value
    return 0


def local_place(I: I32, program: int, kind: int, index: float) -> int:
    """Where a local variable lies in the view of its kind, or minus an error number."""
    rows: int = at.STI_BASE + program * at.STI_STRIDE
    number: int = whole_index(index)
    base: int = 0
    count: int = 0
    if program < 0:
        return -messages.NOT_VALID_AT_THIS_LEVEL.number
    if kind == KIND_OF_LV:
        base = I[rows + at.STI_LV_BASE]
        count = I[rows + at.STI_LV_COUNT]
    elif kind == KIND_OF_SV:
        base = I[rows + at.STI_SV_BASE]
        count = I[rows + at.STI_SV_COUNT]
    else:
        base = I[rows + at.STI_DV_BASE]
        count = I[rows + at.STI_DV_COUNT]
    if number < 0:
        return -messages.SUBSCRIPT_OUT_OF_RANGE.number
    if number >= count:
        return -messages.UNDEFINED_VARIABLE.number
    return base + number


def element_place(I: I32, program: int, kind: int, array: float, index: float) -> int:
    """Where an array element lies in the view of its kind, or minus an error number.

    The table of references leads to a header that holds the number of elements; they
    follow it, those of DA aligned for the float64 view.
    """
    rows: int = at.STI_BASE + program * at.STI_STRIDE
    which: int = whole_index(array)
    number: int = whole_index(index)
    table: int = 0
    count: int = 0
    header: int = 0
    if program < 0:
        return -messages.NOT_VALID_AT_THIS_LEVEL.number
    if kind == KIND_OF_LV:
        table = I[rows + at.STI_LA_BASE]
        count = I[rows + at.STI_LA_COUNT]
    elif kind == KIND_OF_SV:
        table = I[rows + at.STI_SA_BASE]
        count = I[rows + at.STI_SA_COUNT]
    else:
        table = I[rows + at.STI_DA_BASE]
        count = I[rows + at.STI_DA_COUNT]
    if count == 0:
        return -messages.UNDEFINED_VARIABLE.number
    if which < 0 or which >= count:
        return -messages.SUBSCRIPT_OUT_OF_RANGE.number
    header = I[table + which]
    if header == 0:
        return -messages.UNDEFINED_VARIABLE.number
    if number < 0 or number >= I[header]:
        return -messages.SUBSCRIPT_OUT_OF_RANGE.number
    if kind == KIND_OF_DV:
        return ((header + 1) >> 1) + number
    return header + 1 + number


def read_parameter(F: F64, I: I32, S: F32, number: int, to: int) -> int:
    """F[to] := parameter `number`; an error number or 0."""
    kind: int = kind_of(I, number)
    if kind == at.KIND_LONG:
        F[to] = float(I[number])
    elif kind == at.KIND_FP32:
        F[to] = S[number]
        if not finite(F[to]):
            return messages.MATH_ERROR.number
    elif kind == at.KIND_FP64:
        if number >= I[system.p_count]:
            return messages.UNDEFINED_VARIABLE.number
        F[to] = F[at.USER_BASE + number]
    else:
        return messages.INVALID_PARAMETER.number
    return 0


def write_parameter(F: F64, I: I32, S: F32, number: int, value: float) -> int:
    """Parameter `number` := value, converted as its kind demands; an error number or 0."""
    kind: int = kind_of(I, number)
    if kind == at.KIND_LONG:
        store_long(I, number, long_word(value))
    elif kind == at.KIND_FP32:
        return store_single(S, number, value)
    elif kind == at.KIND_FP64:
        if number >= I[system.p_count]:
            return messages.UNDEFINED_VARIABLE.number
        F[at.USER_BASE + number] = value
    else:
        return messages.INVALID_PARAMETER.number
    return 0


def mask_parameter(I: I32, number: int, nandmask: float, ormask: float) -> int:
    """P := (P AND NOT nandmask) OR ormask on a LONG parameter; an error number or 0."""
    if kind_of(I, number) != at.KIND_LONG:
        return messages.INVALID_PARAMETER.number
    store_long(I, number, (I[number] & ~long_word(nandmask)) | long_word(ormask))
    return 0


def read_bit(I: I32, number: int) -> int:
    """State of flag `number`, 1 or 0; -1 if there is none."""
    return flag_bit(I, number) if 0 <= number <= at.FLAG_LAST else -1


def write_bit(I: I32, number: int, on: bool) -> int:
    """Set or clear flag `number`; an error number or 0."""
    if number < 0 or number > at.FLAG_LAST:
        return messages.INVALID_BIT.number
    put_flag(I, number, on)
    return 0
