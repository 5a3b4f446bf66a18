"""Plain lines of part programs, read from bytes: `N10 G1 X1.5 Y-2 F100`.

A line is plain when it has nothing but an optional N, one of G0 and G1, axis words and F,
each once, with numbers of at most 15 digits. Such a number is the quotient of two numbers
a double holds exactly, so that it comes out as `float` reads it. Everything else is left
to the parser.

`K` (integers): 0..25 the axis of a letter, -1 if absent; then results of the line. `W` (doubles):
values of the line, program position and factor of the active unit.
"""

from openacr.views import F64, I32, U8

K_LABEL = 26  # N, 0 none
K_CODE = 27  # G, -1 none
K_HAS_FEED = 28
K_AXES = 29  # mask of the axes named
K_LINES = 30  # count of lines read
K_NEXT = 31  # offset of the first line that was not read
K_IS_INCREMENTAL = 32
K_LABELS = 33  # labels found
K_MOTION = 34  # the last of G0 and G1, -1 none
K_ROTARY = 35  # mask of the axes that have no unit
K_NEW_FEED = 36  # whether the rows have another feed than before
K_SIZE = 37

W_VALUE = 0
W_FEED = 1  # of the line, active units
W_WORDS = 2  # axis words
W_POSITION = 10  # program position, default units
W_TIMES = 18
W_PER = 19
W_PRESENT = 20  # feed in force, default units
W_SIZE = 21

AXES = 8
LONGEST = 256
MOST_DIGITS = 15
LAST_LABEL = 999_999
FEED_LETTER = 5
CODE_LETTER = 6

__all__ = ["scan_lines", "skim_lines"]


def scan_blanks(data: U8, pos: int, stop: int) -> int:
    """Skip blanks; returns the position after them."""
    while pos < stop and (data[pos] == 32 or data[pos] == 9):
        pos += 1
    return pos


def scan_number(data: U8, pos: int, stop: int, W: F64) -> int:
    """Read a signed number to W[W_VALUE]; returns the position after it, -1 if not plain."""
    is_negative: bool = False
    if pos < stop and (data[pos] == 45 or data[pos] == 43):
        is_negative = data[pos] == 45
        pos = scan_blanks(data, pos + 1, stop)
    mantissa: int = 0
    digits: int = 0
    scale: float = 1.0
    is_behind_point: bool = False
    while pos < stop:
        char: int = data[pos]
        if 48 <= char <= 57:
            mantissa = mantissa * 10 + (char - 48)
            digits += 1
            if digits > MOST_DIGITS:
                return -1
            if is_behind_point:
                scale = scale * 10.0
        elif char == 46 and not is_behind_point:
            is_behind_point = True
        else:
            break
        pos += 1
    if digits == 0 or (pos < stop and data[pos] == 46):
        return -1
    value: float = float(mantissa) / scale
    W[W_VALUE] = -value if is_negative else value
    return pos


def scan_word(data: U8, pos: int, stop: int, W: F64, K: I32) -> int:
    """Read the word at `pos`; returns the position after it, -1 if it is not plain."""
    letter: int = data[pos]
    if 97 <= letter <= 122:
        letter -= 32
    letter -= 65
    if letter < 0 or letter > 25:
        return -1
    start: int = scan_blanks(data, pos + 1, stop)
    if start >= stop:
        return -1
    is_signed: bool = data[start] == 45 or data[start] == 43
    pos = scan_number(data, start, stop, W)
    if pos < 0:
        return -1
    value: float = W[W_VALUE]
    axis: int = K[letter]
    if axis >= 0:
        bit: int = 1 << axis
        if K[K_AXES] & bit:
            return -1
        K[K_AXES] = K[K_AXES] | bit
        W[W_WORDS + axis] = value
    elif letter == FEED_LETTER:
        if K[K_HAS_FEED] or value <= 0.0:
            return -1
        K[K_HAS_FEED] = 1
        W[W_FEED] = value
    elif letter == CODE_LETTER:
        if K[K_CODE] >= 0 or is_signed or (value != 0.0 and value != 1.0):
            return -1
        K[K_CODE] = int(value)
    else:
        return -1
    return pos


def scan_line(data: U8, pos: int, stop: int, W: F64, K: I32) -> int:
    """Read the line at `pos`; returns the position of the next one, -1 if it is not plain."""
    K[K_LABEL] = 0
    K[K_CODE] = -1
    K[K_HAS_FEED] = 0
    K[K_AXES] = 0
    start: int = pos
    pos = scan_blanks(data, pos, stop)
    if pos < stop and (data[pos] == 78 or data[pos] == 110):
        pos = scan_blanks(data, pos + 1, stop)
        if pos >= stop or data[pos] < 48 or data[pos] > 57:
            return -1
        first: int = pos
        label: int = 0
        while pos < stop and 48 <= data[pos] <= 57:
            label = label * 10 + (data[pos] - 48)
            pos += 1
            if pos - first > 6:
                return -1
        if label < 1 or label > LAST_LABEL:
            return -1
        K[K_LABEL] = label
        pos = scan_blanks(data, pos, stop)
    while pos < stop and data[pos] != 10 and data[pos] != 13:
        pos = scan_word(data, pos, stop, W, K)
        if pos < 0:
            return -1
        pos = scan_blanks(data, pos, stop)
    if pos - start > LONGEST:
        return -1
    if pos < stop and data[pos] == 13:
        pos += 1
        if pos < stop and data[pos] == 10:
            pos += 1
    elif pos < stop:
        pos += 1
    return pos


def scan_lines(data: U8, pos: int, stop: int, W: F64, K: I32, ends: F64, lines: I32,
               most: int) -> int:  # fmt: skip
    """Write feed moves to `ends` (8 values each) and their line numbers (from 0) to `lines`.

    Ends at a line that is not plain, has G0, or changes the feed. Returns the count of rows.
    """
    row: int = 0
    line: int = 0
    K[K_NEW_FEED] = 0
    while pos < stop and row < most:
        after: int = scan_line(data, pos, stop, W, K)
        if after < 0 or K[K_CODE] == 0:
            break
        if K[K_HAS_FEED]:
            feed: float = W[W_FEED] * W[W_TIMES] / W[W_PER]
            if feed != W[W_PRESENT]:
                if row > 0:
                    break
                W[W_PRESENT] = feed
                K[K_NEW_FEED] = 1
        if K[K_AXES]:
            lines[row] = line
            base: int = row * AXES
            for axis in range(AXES):
                if K[K_AXES] & (1 << axis):
                    value: float = W[W_WORDS + axis]
                    if not K[K_ROTARY] & (1 << axis):
                        value = value * W[W_TIMES] / W[W_PER]
                    if K[K_IS_INCREMENTAL]:
                        value = W[W_POSITION + axis] + value
                    W[W_POSITION + axis] = value
                ends[base + axis] = W[W_POSITION + axis]
            row += 1
        line += 1
        pos = after
    K[K_LINES] = line
    K[K_NEXT] = pos
    return row


def skim_lines(data: U8, pos: int, stop: int, W: F64, K: I32, labels: I32, most: int) -> int:
    """Skip plain lines; writes labels as (label, line from 0, position) to `labels`.

    Returns the count of lines.
    """
    line: int = 0
    count: int = 0
    K[K_MOTION] = -1
    while pos < stop and count < most:
        after: int = scan_line(data, pos, stop, W, K)
        if after < 0:
            break
        if K[K_CODE] >= 0:
            K[K_MOTION] = K[K_CODE]
        if K[K_LABEL]:
            labels[3 * count] = K[K_LABEL]
            labels[3 * count + 1] = line
            labels[3 * count + 2] = pos
            count += 1
        line += 1
        pos = after
    K[K_LABELS] = count
    K[K_NEXT] = pos
    return line
