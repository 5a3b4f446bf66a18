"""Lines of part programs, read from bytes: `N10 G3 X1.5 Y-2 I.5 J0 F100 (finish)`.

A line is plain when it has nothing but an optional N, words with a number of at most 15 digits
each, and remarks. Such a number is the quotient of two numbers a double holds exactly, so that it
comes out as `float` reads it. Everything else is left to the parser.

The shape of a line is its words in their order without their values, G and M codes with theirs:

    token = 1 + letter                                    of a word, A is 0
    token = (1 + letter) * TOKEN_CODE + 10 * value        of a code

What is known of shapes is in a table of slots, found by the hash of the tokens. The meaning is
the caller's: 0 and above is a shape of lines it reads many at a time, `SLOW_SHAPE` one of lines
that are left to the parser.
"""

from openacr.cnc.rows import scans
from openacr.views import F64, I32, U8

__all__ = ["scan_line", "scan_shape"]

TOKEN_CODE = 16384
SLOT_MASK = 1023
HASH_MASK = 1073741823
LONGEST = 256
MOST_DIGITS = 15
LAST_LABEL = 999_999
CODE_G = 6
CODE_M = 12
LABEL_N = 13
CODE_O = 14
LAST_CODE = 1000.0
LONGEST_KIND = 12  # letters of MSG, DEBUG, PRINT and what else may come before a comma


def scan_blanks(data: U8, pos: int, stop: int) -> int:
    """Skip blanks; returns the position after them."""
    while pos < stop and (data[pos] == 32 or data[pos] == 9):
        pos += 1
    return pos


def scan_number(data: U8, pos: int, stop: int, F: F64) -> int:
    """Read a signed number to F[scans.value]; returns the position after it, -1 if not plain."""
    is_negative: bool = False
    if pos < stop and (data[pos] == 45 or data[pos] == 43):
        is_negative = data[pos] == 45
        pos = scan_blanks(data, pos + 1, stop)
    mantissa: int = 0
    digits: int = 0
    scale: float = 1.0
    is_after_point: bool = False
    while pos < stop:
        char: int = data[pos]
        if 48 <= char <= 57:
            mantissa = mantissa * 10 + (char - 48)
            digits += 1
            if digits > MOST_DIGITS:
                return -1
            if is_after_point:
                scale = scale * 10.0
        elif char == 46 and not is_after_point:
            is_after_point = True
        else:
            break
        pos += 1
    if digits == 0 or (pos < stop and data[pos] == 46):
        return -1
    value: float = float(mantissa) / scale
    F[scans.value] = -value if is_negative else value
    return pos


def scan_remark(data: U8, pos: int, stop: int) -> int:
    """Skip the remark at `pos`; -1 where it has no end, or may be a message: `(MSG, text)`."""
    is_name: bool = True
    letters: int = 0
    pos += 1
    while pos < stop and data[pos] != 41:
        char: int = data[pos]
        if char == 10 or char == 13:
            return -1
        if char == 44 and is_name and letters <= LONGEST_KIND:
            return -1
        if 65 <= char <= 90 or 97 <= char <= 122:
            letters += 1
        elif 33 <= char <= 126:
            is_name = False
        pos += 1
    return pos + 1 if pos < stop else -1


def scan_label(data: U8, pos: int, stop: int, I: I32) -> int:
    """Read the digits of N; N0, N1.5 and numbers above the labels only count lines."""
    first: int = pos
    label: int = 0
    while pos < stop and 48 <= data[pos] <= 57:
        label = label * 10 + (data[pos] - 48)
        pos += 1
        if pos - first > MOST_DIGITS:
            return -1
    if pos == first:
        return -1
    if pos < stop and data[pos] == 46:
        label = 0
        pos += 1
        while pos < stop and 48 <= data[pos] <= 57:
            pos += 1
        if pos < stop and data[pos] == 46:
            return -1
    I[scans.label] = label if label <= LAST_LABEL else 0
    return pos


def scan_word(data: U8, pos: int, stop: int, F: F64, I: I32) -> int:
    """Read the word at `pos`; returns the position after it, -1 if it is not plain."""
    letter: int = data[pos]
    if 97 <= letter <= 122:
        letter -= 32
    letter -= 65
    if letter < 0 or letter > 25 or letter == LABEL_N or letter == CODE_O:
        return -1
    if I[scans.token_cnt] >= scans.MOST_TOKENS:
        return -1
    start: int = scan_blanks(data, pos + 1, stop)
    pos = scan_number(data, start, stop, F)
    if pos < 0:
        return -1
    value: float = F[scans.value]
    token: int = letter + 1
    if letter == CODE_G or letter == CODE_M:
        if data[start] == 45 or data[start] == 43 or value > LAST_CODE:
            return -1
        tenths: int = int(value * 10.0)
        if float(tenths) != value * 10.0:
            return -1
        token = token * TOKEN_CODE + tenths
    else:
        F[scans.word[letter]] = value
    I[scans.token[I[scans.token_cnt]]] = token
    I[scans.token_cnt] += 1
    I[scans.token_hash] = (I[scans.token_hash] * 31 + token) & HASH_MASK
    return pos


def scan_next(data: U8, pos: int, stop: int, start: int) -> int:
    """Skip the end of a line at `pos`; returns the next line, -1 if the line is too long."""
    if pos - start > LONGEST:
        return -1
    if pos < stop and data[pos] == 13:
        pos += 1
        if pos < stop and data[pos] == 10:
            pos += 1
    elif pos < stop:
        pos += 1
    return pos


def scan_line(data: U8, pos: int, stop: int, F: F64, I: I32) -> int:
    """Read the line at `pos`; returns the position of the next one, -1 if it is not plain."""
    I[scans.label] = 0
    I[scans.token_cnt] = 0
    I[scans.token_hash] = 0
    start: int = pos
    pos = scan_blanks(data, pos, stop)
    if pos < stop and (data[pos] == 78 or data[pos] == 110):
        pos = scan_label(data, scan_blanks(data, pos + 1, stop), stop, I)
        if pos < 0:
            return -1
        pos = scan_blanks(data, pos, stop)
    while pos < stop and data[pos] != 10 and data[pos] != 13:
        if data[pos] == 40:
            pos = scan_remark(data, pos, stop)
        elif data[pos] == 59:
            while pos < stop and data[pos] != 10 and data[pos] != 13:
                pos += 1
        else:
            pos = scan_word(data, pos, stop, F, I)
        if pos < 0:
            return -1
        pos = scan_blanks(data, pos, stop)
    return scan_next(data, pos, stop, start)


def scan_slot(I: I32) -> int:
    """The slot of the shape of the line, or the free one where it belongs."""
    count: int = I[scans.token_cnt]
    slot: int = I[scans.token_hash] & SLOT_MASK
    at: int = scans.slot[scans.SLOT * slot]
    while I[at + scans.SLOT_COUNT]:
        if I[at + scans.SLOT_COUNT] == count:
            first: int = I[at + scans.SLOT_FIRST]
            k: int = 0
            while k < count and I[first + k] == I[scans.token[k]]:
                k += 1
            if k == count:
                return at
        slot = (slot + 1) & SLOT_MASK
        at = scans.slot[scans.SLOT * slot]
    return at


def scan_shape(I: I32) -> int:
    """The meaning of the shape of the line; NO_SHAPE if it is not known."""
    at: int = scan_slot(I)
    return I[at + scans.SLOT_MEANING] if I[at + scans.SLOT_COUNT] else scans.NO_SHAPE


def scan_motion(I: I32) -> int:
    """The last of G0 to G3 in the line, -1 none."""
    found: int = -1
    for k in range(I[scans.token_cnt]):
        code: int = I[scans.token[k]] - (CODE_G + 1) * TOKEN_CODE
        if code == 0 or code == 10 or code == 20 or code == 30:
            found = code
    return found
