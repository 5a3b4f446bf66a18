"""Lines skipped at load: those of shapes that can have no error, with their labels."""

from openacr.cnc.reading.rich_cy import scan_rich
from openacr.cnc.reading.scan_cy import (
    K_HAS_WORDS,
    K_LABEL,
    K_LABELS,
    K_MOTION,
    K_NEXT,
    K_STATUS,
    K_TOKENS,
    SCAN_END,
    SCAN_HARD,
    SCAN_NEW,
    SCAN_SLOW,
    SHAPE_NONE,
    scan_line,
    scan_motion,
    scan_shape,
)
from openacr.views import F64, I32, U8

__all__ = ["skim_lines"]


def skim_lines(
    data: U8, pos: int, stop: int, W: F64, K: I32, L: I32, T: I32, N: F64, Q: I32, labels: I32,
    most: int
) -> int:  # fmt: skip
    """Skip lines of known shapes; writes labels as (label, line from 0, position) to `labels`.

    Returns the count of lines.
    """
    line: int = 0
    count: int = 0
    motion: int = -1
    K[K_HAS_WORDS] = 0
    K[K_STATUS] = SCAN_END
    while pos < stop and count < most:
        after: int = scan_line(data, pos, stop, W, K, L)
        if after < 0:
            after = scan_rich(data, pos, stop, W, K, L, N, Q)
        if after < 0:
            K[K_STATUS] = SCAN_HARD
            break
        if K[K_TOKENS]:
            meaning: int = scan_shape(K, L, T)
            if meaning < 0:
                K[K_STATUS] = SCAN_NEW if meaning == SHAPE_NONE else SCAN_SLOW
                break
            K[K_HAS_WORDS] = 1
            code: int = scan_motion(K, L)
            if code >= 0:
                motion = code
        if K[K_LABEL]:
            labels[3 * count] = K[K_LABEL]
            labels[3 * count + 1] = line
            labels[3 * count + 2] = pos
            count += 1
        line += 1
        pos = after
    K[K_MOTION] = motion
    K[K_LABELS] = count
    K[K_NEXT] = pos
    return line
