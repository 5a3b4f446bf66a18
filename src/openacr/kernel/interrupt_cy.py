"""Flags and captures that start a move (TRG) or end it early (INT)."""

from openacr.kernel.axis_cy import axis_word
from openacr.kernel.path_cy import SLAVE_COUNT, master_word, move_record, move_stop_rate
from openacr.kernel.profile_cy import STOPPING, profile_stop
from openacr.map.numbers import (
    AF1_CAPTURE_COMPLETE,
    AXF_BASE,
    AXF_POSITION_CNT,
    AXF_STRIDE,
    AXF_TARGET_CNT,
    FLAG_LAST,
    FLAG_WORD_BASE,
    MA_BASE,
    MA_INT_RESPONSE_PERIOD,
    MA_STRIDE,
    MF1_START_MOVE_INHIBIT,
    MF1_TRG_PENDING,
    MQF_BASE,
    MQF_JRK_UPS3,
    MQF_LENGTH_U,
    MQF_STRIDE,
    MQI_BASE,
    MQI_INTERRUPT,
    MQI_SLAVES,
    MQI_STRIDE,
    MQI_TRIGGER,
    MQI_TRIGGER_AXIS,
    MSF_BASE,
    MSF_ORIGIN_U,
    MSF_STRETCH_U,
    MSF_STRIDE,
    MSF_TARGET_CNT,
    MSI_BASE,
    MSI_CUT,
    MSI_FIRST,
    MSI_HEAD,
    MSI_PIECE,
    MSI_QUEUED,
    MSI_RESPONSE,
    MSI_SIZE,
    MSI_SLAVE_AXIS,
    MSI_STEP_GO,
    MSI_STRIDE,
    PRI_BASE,
    PRI_KIND,
    PRI_STRIDE,
)
from openacr.views import F32, F64, I32

__all__ = ["master_cut"]


def flag_state(I: I32, wanted: int) -> bool:
    """Whether flag `wanted - 1` is set or, for a negative number, flag `-wanted - 1` clear."""
    number: int = (wanted if wanted > 0 else -wanted) - 1
    if not 0 <= number <= FLAG_LAST:
        return False
    is_set: bool = (I[FLAG_WORD_BASE + (number >> 5)] >> (number & 31)) & 1 != 0
    return is_set == (wanted > 0)


def response_period(I: I32, m: int) -> int:
    """Ticks from one look at the flag of an INT to the next, -1 never."""
    period: int = I[MA_BASE + m * MA_STRIDE + MA_INT_RESPONSE_PERIOD]
    if period < 0:
        return -1
    return max(period, 1)


def master_cut(F: F64, I: I32, S: F32, m: int) -> None:
    """Slow the path to rest with STP (DEC if that is 0) and drop the rest of the move.

    Where its target is nearer than that, the move goes on to it.
    """
    q: int = MQF_BASE + move_record(I, m) * MQF_STRIDE
    if I[PRI_BASE + m * PRI_STRIDE + PRI_KIND] == STOPPING:
        return
    rate: float = move_stop_rate(F, move_record(I, m))
    f: int = MSF_BASE + m * MSF_STRIDE
    if I[MSI_BASE + m * MSI_STRIDE + MSI_PIECE]:
        I[MSI_BASE + m * MSI_STRIDE + MSI_PIECE] = 0
        F[f + MSF_STRETCH_U] = F[f + MSF_ORIGIN_U] + F[q + MQF_LENGTH_U]
    end: float = F[f + MSF_STRETCH_U]
    profile_stop(F, I, m, end, rate, F[q + MQF_JRK_UPS3], STOPPING)
    I[MSI_BASE + m * MSI_STRIDE + MSI_CUT] = 1


def cut_end(F: F64, I: I32, m: int) -> None:
    """A move has ended before its target: its slaves are wanted where they are.

    Those that take part in a waiting move keep the end of that one as planned end.
    """
    i: int = MSI_BASE + m * MSI_STRIDE
    waiting: int = 0
    for k in range(1, I[i + MSI_QUEUED]):
        place: int = I[i + MSI_HEAD] + k
        if place >= I[i + MSI_SIZE]:
            place -= I[i + MSI_SIZE]
        waiting |= I[MQI_BASE + (I[i + MSI_FIRST] + place) * MQI_STRIDE + MQI_SLAVES]
    slaves: int = I[MQI_BASE + move_record(I, m) * MQI_STRIDE + MQI_SLAVES]
    for s in range(SLAVE_COUNT):
        axis: int = I[i + MSI_SLAVE_AXIS + s]
        if slaves & (1 << s) and axis >= 0:
            a: int = AXF_BASE + axis * AXF_STRIDE
            F[a + AXF_TARGET_CNT] = F[a + AXF_POSITION_CNT]
            if not waiting & (1 << s):
                F[MSF_BASE + m * MSF_STRIDE + MSF_TARGET_CNT + s] = F[a + AXF_POSITION_CNT]


def interrupt_step(F: F64, I: I32, S: F32, m: int) -> None:
    """INT: look at the flag of the present move every response period."""
    i: int = MSI_BASE + m * MSI_STRIDE
    if I[i + MSI_CUT] or I[i + MSI_RESPONSE] < 0:
        return
    I[i + MSI_RESPONSE] -= 1
    if I[i + MSI_RESPONSE] > 0:
        return
    I[i + MSI_RESPONSE] = response_period(I, m)
    if flag_state(I, I[MQI_BASE + move_record(I, m) * MQI_STRIDE + MQI_INTERRUPT]):
        master_cut(F, I, S, m)


def move_barred(I: I32, m: int) -> bool:
    """Whether the move at the head may not begin yet; a trigger that has come is used up."""
    word: int = master_word(m)
    flags: int = I[word]
    if flags & MF1_START_MOVE_INHIBIT and not I[MSI_BASE + m * MSI_STRIDE + MSI_STEP_GO]:
        return True
    if not flags & MF1_TRG_PENDING:
        return False
    q: int = MQI_BASE + move_record(I, m) * MQI_STRIDE
    bit: int = I[q + MQI_TRIGGER]
    axis: int = I[q + MQI_TRIGGER_AXIS] - 1
    if bit == 0 and axis < 0:  # the trigger is meant for a later move
        return False
    came: bool = flag_state(I, bit) if bit else I[axis_word(axis)] & AF1_CAPTURE_COMPLETE != 0
    if came:
        I[q + MQI_TRIGGER] = 0
        I[q + MQI_TRIGGER_AXIS] = 0
        I[word] = flags & ~MF1_TRG_PENDING
    return not came
