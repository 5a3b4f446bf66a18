"""Lines skipped at load: those of shapes that can have no error, with their labels."""

from openacr.cnc.reading.rich_cy import scan_rich
from openacr.cnc.reading.scan_cy import scan_line, scan_motion, scan_shape
from openacr.cnc.rows import scans
from openacr.views import F64, I32, U8

__all__ = ["skim_lines"]


def skim_lines(data: U8, pos: int, stop: int, F: F64, I: I32, labels: I32, most: int) -> int:
    """Skip lines of known shapes; writes labels as (label, line from 0, position) to `labels`.

    Returns the count of lines.
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
