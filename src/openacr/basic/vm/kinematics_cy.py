"""INVK: the joints of a master, computed by a user program after every tick.

The path of the master is that of the tool. Whenever it has moved, the coordinated
positions of the slaves go to their INVK Input in units, the program runs once from its
first line to its end, and INVK Output are the positions of the joints from the next tick
on. An output the program leaves alone is its input. While the program waits, or takes more
than STATEMENTS in a tick, the joints stay; at rest nothing is computed.
"""

from openacr.basic.vm.opcodes_cy import VM_END, VM_SLICE, VM_WAIT
from openacr.basic.vm.vm_cy import vm_run
from openacr.basic.vm.waits_cy import wait_is_over
from openacr.kernel.axis.axis_cy import axis_scale
from openacr.kernel.path.path_cy import SLAVE_COUNT
from openacr.map import numbers as at
from openacr.map.rows import kernel
from openacr.map.words import mf1
from openacr.views import F32, F64, I32

FIRST_THREAD = 32
MASTERS = 16
STATEMENTS = 1000
# States of a thread, as in scheduler_cy.
IDLE = 0
READY = 1
WAITING = 2
LARGEST_FP32 = 3.4028235e38


def slave_axis(I: I32, m: int, s: int) -> int:
    """The axis of a slave, -1 without one."""
    return I[at.MSI_BASE + m * at.MSI_STRIDE + at.MSI_SLAVE_AXIS + s]


def tool_moved(F: F64, I: I32, m: int) -> bool:
    """Whether the joints have to be computed anew; at rest positions may be written freely."""
    i: int = at.MSI_BASE + m * at.MSI_STRIDE
    moving: int = I[mf1.word[m]] & mf1.IN_MOTION
    due: bool = moving != 0 or I[i + at.MSI_INVK_MOVING] != 0
    I[i + at.MSI_INVK_MOVING] = moving
    moved: bool = False
    for s in range(SLAVE_COUNT):
        axis: int = slave_axis(I, m, s)
        if axis >= 0:
            a: int = at.AXF_BASE + axis * at.AXF_STRIDE
            moved = moved or F[a + at.AXF_SEEN_CNT] != F[a + at.AXF_POSITION_CNT]
            F[a + at.AXF_SEEN_CNT] = F[a + at.AXF_POSITION_CNT]
    return due and moved


def inputs_show(F: F64, I: I32, S: F32, m: int) -> None:
    """Give the program the positions of the tool."""
    for s in range(SLAVE_COUNT):
        axis: int = slave_axis(I, m, s)
        if axis >= 0:
            p: int = at.AX_BASE + axis * at.AX_STRIDE
            place: float = F[at.AXF_BASE + axis * at.AXF_STRIDE + at.AXF_SEEN_CNT] / axis_scale(
                S, axis
            )
            S[p + at.AX_INVK_INPUT_PREVIOUS] = S[p + at.AX_INVK_INPUT]
            S[p + at.AX_INVK_INPUT] = place
            S[p + at.AX_INVK_OUTPUT] = place


def outputs_take(F: F64, I: I32, S: F32, m: int) -> None:
    """Put the joints where the program wants them; an output that is no number changes nothing."""
    for s in range(SLAVE_COUNT):
        axis: int = slave_axis(I, m, s)
        if axis >= 0:
            p: int = at.AX_BASE + axis * at.AX_STRIDE
            a: int = at.AXF_BASE + axis * at.AXF_STRIDE
            joint: float = S[p + at.AX_INVK_OUTPUT]
            if joint == S[p + at.AX_INVK_INPUT]:
                F[a + at.AXF_KINEMATICS_CNT] = F[a + at.AXF_SEEN_CNT] - F[a + at.AXF_POSITION_CNT]
            elif -LARGEST_FP32 <= joint and joint <= LARGEST_FP32:
                joint = joint * axis_scale(S, axis)
                F[a + at.AXF_KINEMATICS_CNT] = joint - F[a + at.AXF_POSITION_CNT]


def kinematics_run(F: F64, I: I32, S: F32, code: I32, nums: F64, m: int, tick: int) -> bool:
    """Begin or continue the program of master m; True if Python is needed."""
    rows: int = at.THI_BASE + (FIRST_THREAD + m) * at.THI_STRIDE
    if I[rows + at.THI_STATE] == IDLE:
        if not tool_moved(F, I, m):
            return False
        inputs_show(F, I, S, m)
        I[rows + at.THI_PC] = 0
        I[rows + at.THI_SP] = 0
        I[rows + at.THI_DEPTH] = 0
        I[rows + at.THI_STATE] = READY
    elif I[rows + at.THI_STATE] == WAITING:
        if not wait_is_over(F, I, S, FIRST_THREAD + m, tick):
            return False
        I[rows + at.THI_STATE] = READY
    event: int = vm_run(F, I, S, code, nums, FIRST_THREAD + m, STATEMENTS, tick)
    if event == VM_SLICE:
        return False
    if event == VM_WAIT:
        I[rows + at.THI_STATE] = WAITING
        return False
    if event == VM_END:
        I[rows + at.THI_STATE] = IDLE
        outputs_take(F, I, S, m)
        return False
    I[rows + at.THI_EVENT] = event
    return True


def kinematics_step(F: F64, I: I32, S: F32, code: I32, nums: F64, tick: int) -> int:
    """Compute the joints of all masters with INVK ON; a thread if Python is needed, else 0."""
    for m in range(MASTERS):
        if I[kernel.kinematics] & (1 << m):
            if kinematics_run(F, I, S, code, nums, m, tick):
                return FIRST_THREAD + m
    return 0
