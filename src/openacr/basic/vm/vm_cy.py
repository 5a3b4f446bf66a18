"""The virtual machine of AcroBASIC: a stack machine over the memory of the card.

`vm_run` executes one thread until something needs the scheduler or Python. Operations
and their operands are int32 numbers in `code`, constants float64 numbers in `nums`; a
thread's own part begins at its rows code_base and num_base, and jump targets count from
there. All state lies in the rows of the thread, so any stop can be continued later.
"""

from openacr import messages
from openacr.basic.vm.arith_cy import (
    apply_operator,
    finite,
    long_word,
)
from openacr.basic.vm.flow_cy import (
    FLOW_FOR,
    FLOW_GOSUB,
    FLOW_WHILE,
    break_level,
    close_level,
    is_open,
    line_place,
    open_level,
    return_level,
    unwind,
)
from openacr.basic.vm.functions_cy import apply_function
from openacr.basic.vm.opcodes_cy import (
    DO_ADD,
    DO_BREAK,
    DO_CALL,
    DO_DWELL,
    DO_END,
    DO_ENTER,
    DO_ENTER_FOR,
    DO_FAIL,
    DO_FUNCTION,
    DO_GOSUB,
    DO_GOSUB_LINE,
    DO_GOTO,
    DO_GOTO_LINE,
    DO_INHIBIT,
    DO_INHIBIT_POSITION,
    DO_JUMP,
    DO_JUMP_IF_ZERO,
    DO_LEAVE,
    DO_LESS,
    DO_LOAD_BIT,
    DO_LOAD_ELEMENT,
    DO_LOAD_FLAG,
    DO_LOAD_LOCAL,
    DO_LOAD_LONG,
    DO_LOAD_LV,
    DO_LOAD_PARAMETER,
    DO_LOAD_SINGLE,
    DO_LOAD_USER,
    DO_MASK,
    DO_NEXT,
    DO_OPERATOR,
    DO_PUSH,
    DO_RESULT,
    DO_RETURN,
    DO_STATEMENT,
    DO_STORE_BIT,
    DO_STORE_ELEMENT,
    DO_STORE_FLAG,
    DO_STORE_LOCAL,
    DO_STORE_LONG,
    DO_STORE_LV,
    DO_STORE_PARAMETER,
    DO_STORE_SINGLE,
    DO_STORE_USER,
    DO_TEST_FOR,
    DO_TRAP,
    DO_WEND,
    VM_CALL,
    VM_END,
    VM_ERROR,
    VM_FLAGS,
    VM_LINE,
    VM_SLICE,
    VM_TRAP,
    VM_VALUE,
    VM_WAIT,
)
from openacr.basic.vm.values_cy import (
    element_place,
    load_kind,
    local_place,
    mask_parameter,
    read_bit,
    read_parameter,
    store_kind,
    store_single,
    whole_index,
    write_bit,
    write_parameter,
)
from openacr.basic.vm.waits_cy import (
    WAIT_TIME,
    inhibit,
    inhibit_position,
    start_wait,
)
from openacr.map import numbers as at
from openacr.map.rows import engine, programs, system, threads
from openacr.map.words import pf
from openacr.views import F32, F64, I32

__all__ = ["vm_run"]

STOPS = pf.BLOCK_MODE | pf.PAUSE_MODE | pf.TRACE_MODE_ENABLE


def vm_run(
    F: F64,
    I: I32,
    S: F32,
    code: I32,
    nums: F64,
    t: int,
    budget: int,
    tick: int,
) -> int:
    """Execute thread t for at most `budget` statements; one of the VM_ numbers above."""
    rows: int = at.THI_BASE + t * at.THI_STRIDE
    reals: int = at.THF_BASE + t * at.THF_STRIDE
    base: int = I[at.THCI_BASE + t * at.THCI_STRIDE + at.THCI_CODE_BASE]
    num_base: int = I[at.THCI_BASE + t * at.THCI_STRIDE + at.THCI_NUM_BASE]
    bottom: int = reals + at.THF_STACK
    top: int = bottom + I[rows + at.THI_SP]  # place of the next number to be pushed
    pc: int = base + I[rows + at.THI_PC]
    flags_at: int = at.PF_WORD + t if t < programs.COUNT else rows + at.THI_SPARE_FLAGS
    line_at: int = at.PROG_BASE + t * at.PROG_STRIDE + at.PROG_LINE_NUMBER
    error: int = 0
    event: int = 0
    op: int = 0
    place: int = 0
    word: int = 0
    locals_of: int = I[rows + at.THI_LOCALS]
    storage: int = at.STI_BASE + locals_of * at.STI_STRIDE
    announced: int = (I[engine.line_stops] >> t) & 1 if t < programs.COUNT else 0
    first_budget: int = budget
    if t >= programs.COUNT:
        line_at = rows + at.THI_LINE
    if top > bottom + threads.STACK_SIZE - 100:
        error = messages.STACK_OVERFLOW.number
    while error == 0 and event == 0:
        op = code[pc]
        if op == DO_STATEMENT:
            if budget == 0:
                event = VM_SLICE
            elif (
                announced
                and code[pc + 2]
                and I[engine.line_announced] != t + 1
                and not I[rows + at.THI_PASSED]
            ):
                event = VM_LINE
            elif I[flags_at] & STOPS and code[pc + 2] and not I[rows + at.THI_PASSED]:
                event = VM_FLAGS
            else:
                if announced:
                    I[engine.line_announced] = 0
                budget -= 1
                word = code[pc + 1]
                I[rows + at.THI_LINE] = word
                I[line_at] = word
                I[rows + at.THI_PASSED] = 0
                pc += 3
        elif op == DO_PUSH:
            F[top] = nums[num_base + code[pc + 1]]
            top += 1
            pc += 2
        elif op == DO_JUMP:
            pc = base + code[pc + 1]
        elif op == DO_JUMP_IF_ZERO:
            top -= 1
            pc = base + code[pc + 1] if F[top] == 0.0 else pc + 2
        elif op == DO_OPERATOR:
            top -= 1
            error = apply_operator(F, code[pc + 1], top - 1)
            pc += 2
        elif op == DO_FUNCTION:
            error = apply_function(F, I, code[pc + 1], top - 1)
            pc += 2
        elif op == DO_ADD:
            top -= 1
            F[top - 1] = F[top - 1] + F[top]
            if not finite(F[top - 1]):
                error = messages.MATH_ERROR.number
            pc += 1
        elif op == DO_LESS:
            top -= 1
            F[top - 1] = -1.0 if F[top - 1] < F[top] else 0.0
            pc += 1
        elif op == DO_LOAD_LONG:
            F[top] = float(I[code[pc + 1]])
            top += 1
            pc += 2
        elif op == DO_STORE_LONG:
            top -= 1
            I[code[pc + 1]] = long_word(F[top])
            pc += 2
        elif op == DO_LOAD_SINGLE:
            F[top] = S[code[pc + 1]]
            error = 0 if finite(F[top]) else messages.MATH_ERROR.number
            top += 1
            pc += 2
        elif op == DO_STORE_SINGLE:
            top -= 1
            error = store_single(S, code[pc + 1], F[top])
            pc += 2
        elif op == DO_LOAD_USER:
            if code[pc + 1] >= I[system.p_count]:
                error = messages.UNDEFINED_VARIABLE.number
            F[top] = F[at.USER_BASE + code[pc + 1]]
            top += 1
            pc += 2
        elif op == DO_STORE_USER:
            top -= 1
            if code[pc + 1] < I[system.p_count]:
                F[at.USER_BASE + code[pc + 1]] = F[top]
            else:
                error = messages.UNDEFINED_VARIABLE.number
            pc += 2
        elif op == DO_LOAD_LV:
            if locals_of < 0:
                error = messages.NOT_VALID_AT_THIS_LEVEL.number
            elif code[pc + 1] >= I[storage + at.STI_LV_COUNT]:
                error = messages.UNDEFINED_VARIABLE.number
            else:
                F[top] = float(I[I[storage + at.STI_LV_BASE] + code[pc + 1]])
            top += 1
            pc += 2
        elif op == DO_STORE_LV:
            top -= 1
            if locals_of < 0:
                error = messages.NOT_VALID_AT_THIS_LEVEL.number
            elif code[pc + 1] >= I[storage + at.STI_LV_COUNT]:
                error = messages.UNDEFINED_VARIABLE.number
            else:
                I[I[storage + at.STI_LV_BASE] + code[pc + 1]] = long_word(F[top])
            pc += 2
        elif op == DO_LOAD_LOCAL:
            place = local_place(I, locals_of, code[pc + 1], F[top - 1])
            if place < 0:
                error = 0 - place
            else:
                error = load_kind(F, I, S, code[pc + 1], place, top - 1)
            pc += 2
        elif op == DO_STORE_LOCAL:
            top -= 2
            place = local_place(I, locals_of, code[pc + 1], F[top])
            if place < 0:
                error = 0 - place
            else:
                error = store_kind(F, I, S, code[pc + 1], place, F[top + 1])
            pc += 2
        elif op == DO_LOAD_BIT:
            F[top] = -1.0 if I[code[pc + 1]] & code[pc + 2] else 0.0
            top += 1
            pc += 3
        elif op == DO_STORE_BIT:
            top -= 1
            place = code[pc + 1]
            word = code[pc + 2]
            I[place] = I[place] | word if F[top] != 0.0 else I[place] & ~word
            pc += 3
        elif op == DO_LOAD_PARAMETER:
            error = read_parameter(F, I, S, whole_index(F[top - 1]), top - 1)
            pc += 1
        elif op == DO_STORE_PARAMETER:
            top -= 2
            error = write_parameter(F, I, S, whole_index(F[top]), F[top + 1])
            pc += 1
        elif op == DO_LOAD_FLAG:
            word = read_bit(I, whole_index(F[top - 1]))
            if word < 0:
                error = messages.INVALID_BIT.number
            F[top - 1] = float(0 - word)
            pc += 1
        elif op == DO_STORE_FLAG:
            top -= 2
            error = write_bit(I, whole_index(F[top]), F[top + 1] != 0.0)
            pc += 1
        elif op == DO_LOAD_ELEMENT:
            top -= 1
            place = element_place(I, locals_of, code[pc + 1], F[top - 1], F[top])
            if place < 0:
                error = 0 - place
            else:
                error = load_kind(F, I, S, code[pc + 1], place, top - 1)
            pc += 2
        elif op == DO_STORE_ELEMENT:
            top -= 3
            place = element_place(I, locals_of, code[pc + 1], F[top], F[top + 1])
            if place < 0:
                error = 0 - place
            else:
                error = store_kind(F, I, S, code[pc + 1], place, F[top + 2])
            pc += 2
        elif op == DO_ENTER:
            error = open_level(I, rows, code[pc + 1], code[pc + 2], code[pc + 3])
            pc += 4
        elif op == DO_LEAVE:
            close_level(I, rows, code[pc + 1])
            pc += 2
        elif op == DO_ENTER_FOR:
            top -= 2
            if F[top + 1] == 0.0:
                error = messages.INVALID_ARGUMENT.number
            else:
                error = open_level(I, rows, FLOW_FOR, code[pc + 1], code[pc + 2])
            if error == 0:
                place = I[rows + at.THI_DEPTH] - 1
                F[reals + at.THF_FLOW_LIMIT + place] = F[top]
                F[reals + at.THF_FLOW_STEP + place] = F[top + 1]
            pc += 3
        elif op == DO_TEST_FOR:
            top -= 1
            place = reals + I[rows + at.THI_DEPTH] - 1
            if F[place + at.THF_FLOW_STEP] > 0.0:
                word = 1 if F[top] <= F[place + at.THF_FLOW_LIMIT] else 0
            else:
                word = 1 if F[top] >= F[place + at.THF_FLOW_LIMIT] else 0
            if word:
                pc += 2
            else:
                I[rows + at.THI_DEPTH] = I[rows + at.THI_DEPTH] - 1
                pc = base + code[pc + 1]
        elif op == DO_NEXT:
            if is_open(I, rows, FLOW_FOR, code[pc + 1]):
                place = I[rows + at.THI_DEPTH] - 1
                F[top - 1] = F[top - 1] + F[reals + at.THF_FLOW_STEP + place]
                error = 0 if finite(F[top - 1]) else messages.MATH_ERROR.number
            else:
                error = messages.NEXT_WITHOUT_FOR.number
            pc += 2
        elif op == DO_WEND:
            if is_open(I, rows, FLOW_WHILE, code[pc + 1]):
                pc = base + code[pc + 2]
            else:
                error = messages.WEND_WITHOUT_WHILE.number
        elif op == DO_BREAK:
            if break_level(I, rows, code[pc + 1]):
                pc = base + code[pc + 2]
            else:
                error = messages.BREAK_WITHOUT_LOOP.number
        elif op == DO_GOTO:
            unwind(I, rows, code[pc + 1])
            pc = base + code[pc + 1]
        elif op == DO_GOSUB:
            error = open_level(I, rows, FLOW_GOSUB, 0, 0)
            if error == 0:
                I[rows + at.THI_FLOW_BACK + I[rows + at.THI_DEPTH] - 1] = pc + 2 - base
                pc = base + code[pc + 1]
        elif op == DO_GOTO_LINE or op == DO_GOSUB_LINE:
            top -= 1
            word = line_place(I, code, rows, base, F[top])
            if word < 0:
                error = messages.LINE_NOT_FOUND.number
                F[reals + at.THF_ERROR_DETAIL] = F[top]
            elif op == DO_GOTO_LINE:
                unwind(I, rows, word)
                pc = base + word
            else:
                error = open_level(I, rows, FLOW_GOSUB, 0, 0)
                if error == 0:
                    I[rows + at.THI_FLOW_BACK + I[rows + at.THI_DEPTH] - 1] = pc + 1 - base
                    pc = base + word
        elif op == DO_RETURN:
            word = return_level(I, rows)
            if word < 0:
                error = messages.RETURN_WITHOUT_GOSUB.number
            else:
                pc = base + word
        elif op == DO_END:
            event = VM_END
        elif op == DO_FAIL:
            error = code[pc + 1]
            F[reals + at.THF_ERROR_DETAIL] = float(code[pc + 2])
        elif op == DO_TRAP:
            I[rows + at.THI_TRAP] = code[pc + 1]
            pc += 2
            event = VM_TRAP
        elif op == DO_CALL:
            I[rows + at.THI_TRAP] = code[pc + 1]
            event = VM_CALL  # pc stays: Python pushes the value and steps over
        elif op == DO_RESULT:
            top -= 1
            F[reals + at.THF_RESULT] = F[top]
            event = VM_VALUE
        elif op == DO_DWELL:
            top -= 1
            pc += 1
            if F[top] > 0.0:
                start_wait(F, I, t, WAIT_TIME, 0, 0.0, F[top], tick)
                event = VM_WAIT
        elif op == DO_INHIBIT:
            top -= 2
            word = inhibit(F, I, t, code[pc + 1], top, tick)
            event = VM_WAIT if word > 0 else 0
            error = 0 - word if word < 0 else 0
            pc += 2
        elif op == DO_INHIBIT_POSITION:
            top -= 3
            word = inhibit_position(F, I, S, t, code[pc + 1], top, tick)
            event = VM_WAIT if word > 0 else 0
            error = 0 - word if word < 0 else 0
            pc += 2
        elif op == DO_MASK:
            top -= 3
            error = mask_parameter(I, whole_index(F[top]), F[top + 1], F[top + 2])
            pc += 1
        else:
            error = messages.MATH_ERROR.number
    I[rows + at.THI_SP] = top - bottom
    I[rows + at.THI_PC] = pc - base
    I[rows + at.THI_BUDGET] = budget
    I[engine.statements] = I[engine.statements] + first_budget - budget
    if error != 0:
        I[rows + at.THI_ERROR] = error
        return VM_ERROR
    return event
