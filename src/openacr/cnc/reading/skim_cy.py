"""Lines skipped at load: those of shapes that can have no error, with their labels."""

from openacr.cmath import floor
from openacr.cnc.reading.rich_cy import scan_rich
from openacr.cnc.reading.scan_cy import scan_line, scan_motion, scan_shape
from openacr.cnc.rows import scans
from openacr.views import F64, I32, U8

__all__ = ["skim_lines"]


LETTER = 0  # numbers of a limit of words; LETTER is -1 after the last one of a shape
LOW = 1
HIGH = 2
IS_WHOLE = 3
LIMIT = 4


def skim_fits(F: F64, limits: F64, at: int) -> bool:
    """Whether the words of the line read last are within limits."""
    while limits[at + LETTER] >= 0.0:
        value: float = F[scans.word[int(limits[at + LETTER])]]
        if value < limits[at + LOW] or value > limits[at + HIGH]:
            return False
        if limits[at + IS_WHOLE] > 0.0 and floor(value) != value:
            return False
        at += LIMIT
    return True


def skim_lines(
    data: U8, pos: int, stop: int, F: F64, I: I32, limits: F64, labels: I32, most: int
) -> int:
    """Skip lines of known shapes; writes labels as (label, line from 0, position) to `labels`.

    What is known of a shape is where its limits begin in `limits`. Returns the count of lines.
    """
    line: int = 0
    count: int = 0
    motion: int = -1
    I[scans.has_words] = 0
    I[scans.status] = scans.AT_END
    while pos < stop and count < most:
        after: int = scan_line(data, pos, stop, F, I)
        if after < 0:
            after = scan_rich(data, pos, stop, F, I)
        if after < 0:
            I[scans.status] = scans.HARD
            break
        if I[scans.token_cnt]:
            meaning: int = scan_shape(I)
            if meaning < 0:
                I[scans.status] = scans.NEW if meaning == scans.NO_SHAPE else scans.SLOW
                break
            if not skim_fits(F, limits, meaning):
                I[scans.status] = scans.SLOW
                break
            I[scans.has_words] = 1
            code: int = scan_motion(I)
            if code >= 0:
                motion = code
        if I[scans.label]:
            labels[3 * count] = I[scans.label]
            labels[3 * count + 1] = line
            labels[3 * count + 2] = pos
            count += 1
        line += 1
        pos = after
    I[scans.motion] = motion
    I[scans.label_cnt] = count
    I[scans.next_at] = pos
    return line
