"""Lines with formulas, assignments and statements: their shape, and the numbers in it.

The shape is the text without its numbers: a token for every character, in capitals, one for any
blanks between two of them, one for a remark, and one for a number, whole or with a point. Numbers
that decide more than a value belong to the shape: those of G and M codes, of O-words, and of
parameters (`#5`, `P5`). So all lines of a shape are parsed alike.

    token = 256 + character,  RICH_... ,  RICH_NAMED + n of a parameter,  codes as in `scan_cy`

`scans.number` gets the other numbers in their order. Quotes, characters that are not ASCII, and
what a remark may hide are left to the parser.
"""

from openacr.cnc.reading.scan_cy import (
    HASH_MASK,
    LAST_CODE,
    TOKEN_CODE,
    scan_blanks,
    scan_label,
    scan_next,
    scan_number,
    scan_remark,
)
from openacr.cnc.rows import scans
from openacr.views import F64, I32, U8

__all__ = ["scan_rich"]

RICH_LINE = 200  # the first token
RICH_WHOLE = 201
RICH_POINT = 202
RICH_BLANK = 203
RICH_REMARK = 204
RICH_CHARACTER = 256
RICH_NAMED = 1048576
LAST_NAMED = 1048575

PAREN = 40
HASH = 35
LETTER_G = 71
LETTER_M = 77
LETTER_O = 79
LETTER_P = 80


def rich_capital(character: int) -> int:
    """A letter in capitals."""
    return character - 32 if 97 <= character <= 122 else character


def rich_is_letter(character: int) -> bool:
    """Whether a character in capitals is a letter."""
    return 65 <= character <= 90


def rich_token(I: I32, token: int) -> bool:
    """Add a token; False where there is no room."""
    if I[scans.token_cnt] >= scans.MOST_RICH:
        return False
    I[scans.token[I[scans.token_cnt]]] = token
    I[scans.token_cnt] += 1
    I[scans.token_hash] = (I[scans.token_hash] * 31 + token) & HASH_MASK
    return True


def rich_number(
    data: U8, pos: int, stop: int, F: F64, I: I32, start: int, before: int, earlier: int
) -> int:
    """Read a number after the characters `before` and `earlier`; -1 if it is left."""
    after: int = scan_number(data, pos, stop, F)
    if after < 0:
        return -1
    value: float = F[scans.value]
    is_whole: bool = True
    for k in range(pos, after):
        if data[k] == 46:
            is_whole = False
    is_word: bool = not rich_is_letter(earlier)
    names: bool = before == HASH
    if is_word and (before == LETTER_G or before == LETTER_M):
        tenths: int = int(value * 10.0)
        if value > LAST_CODE or float(tenths) != value * 10.0:
            return -1
        return after if rich_token(I, (before - 64) * TOKEN_CODE + tenths) else -1
    if is_word and I[scans.bracket] == PAREN and before == LETTER_P:
        names = is_whole
    if is_word and I[scans.bracket] != PAREN and before == LETTER_O:
        names = True
    if names:
        if not is_whole or value > LAST_NAMED:
            return -1
        return after if rich_token(I, RICH_NAMED + int(value)) else -1
    if I[scans.number_cnt] >= scans.MOST_NUMBERS:
        return -1
    if not rich_token(I, RICH_WHOLE if is_whole else RICH_POINT):
        return -1
    F[scans.number[I[scans.number_cnt]]] = value
    I[scans.number_at[I[scans.number_cnt]]] = pos - start
    I[scans.number_cnt] += 1
    return after


def rich_name(data: U8, pos: int, stop: int, I: I32) -> int:
    """Read `<name>`; returns the position after it, -1 if it has no end."""
    while pos < stop:
        character: int = rich_capital(data[pos])
        if character < 32 or character > 126 or not rich_token(I, RICH_CHARACTER + character):
            return -1
        pos += 1
        if character == 62:
            return pos
    return -1


def rich_is_taken(character: int) -> bool:
    """Whether a character belongs to expressions: letters, # ( ) * + - / < = > @ [ ] ^."""
    if rich_is_letter(character) or character == HASH or 40 <= character <= 43:
        return True
    if character == 45 or character == 47 or 60 <= character <= 62:
        return True
    return character == 64 or character == 91 or character == 93 or character == 94


def scan_rich(data: U8, pos: int, stop: int, F: F64, I: I32) -> int:
    """Read the line at `pos`; returns the position of the next one, -1 if it is left."""
    start: int = pos
    I[scans.label] = 0
    I[scans.token_cnt] = 0
    I[scans.token_hash] = 0
    I[scans.number_cnt] = 0
    pos = scan_blanks(data, pos, stop)
    if pos < stop and rich_capital(data[pos]) == 78:
        pos = scan_label(data, scan_blanks(data, pos + 1, stop), stop, I)
        if pos < 0:
            return -1
    rich_token(I, RICH_LINE)
    before: int = 0  # the last character, 0 at the start; 49 after a number
    earlier: int = 0
    depth: int = 0
    first: bool = True
    while pos < stop and data[pos] != 10 and data[pos] != 13:
        character: int = rich_capital(data[pos])
        has_blank: bool = character == 32 or character == 9
        if has_blank:
            pos = scan_blanks(data, pos, stop)
            if pos >= stop or data[pos] == 10 or data[pos] == 13:
                break
            character = rich_capital(data[pos])
        is_remark: bool = character == PAREN and (
            I[scans.bracket] != PAREN or before == 0 or before == 49 or before == 41
        )
        if character == 59 and depth == 0:
            while pos < stop and data[pos] != 10 and data[pos] != 13:
                pos += 1
            break
        if is_remark and depth == 0:
            pos = scan_remark(data, pos, stop)
            if pos < 0 or not rich_token(I, RICH_REMARK):
                return -1
            continue
        if is_remark or (first and character == 47):
            return -1
        if has_blank and not first and not rich_token(I, RICH_BLANK):
            return -1
        first = False
        if 48 <= character <= 57 or character == 46:
            if before == 49:
                return -1
            pos = rich_number(data, pos, stop, F, I, start, before, earlier)
            if pos < 0:
                return -1
            earlier = before
            before = 49
            continue
        if not rich_is_taken(character) or not rich_token(I, RICH_CHARACTER + character):
            return -1
        if character == PAREN:
            depth += 1
        elif character == 41:
            depth -= 1
        pos += 1
        if character == 60 and I[scans.bracket] != PAREN and (before == HASH or before == LETTER_O):
            pos = rich_name(data, pos, stop, I)
            if pos < 0:
                return -1
        earlier = 0 if has_blank else before
        before = character
    return scan_next(data, pos, stop, start)
