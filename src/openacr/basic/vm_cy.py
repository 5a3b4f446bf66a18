"""The virtual machine of AcroBASIC: a stack machine over the memory of the card.

`vm_run` executes one thread until something needs the scheduler or Python. Operations
and their operands are int32 numbers in `code`, constants float64 numbers in `nums`; a
thread's own part begins at its rows code_base and num_base, and jump targets count from
there. All state lies in the rows of the thread, so any stop can be continued later.
"""

from openacr.basic.arith_cy import apply_function, apply_operator, finite, long_word
from openacr.cmath import ceil
from openacr.map.numbers import (
    FLAG_LAST,
    KIND_FP32,
    KIND_FP64,
    KIND_LONG,
    PF_BLOCK_MODE,
    PF_PAUSE_MODE,
    PF_PROGRAM_DWELLING,
    PF_PROGRAM_INHIBITED,
    PF_PROGRAM_TIMEOUT,
    PF_TRACE_MODE_ENABLE,
    PF_WORD,
    PROG_BASE,
    PROG_LINE_NUMBER,
    PROG_STRIDE,
    PUBLIC_COUNT,
    STI_BASE,
    STI_DA_BASE,
    STI_DA_COUNT,
    STI_DV_BASE,
    STI_DV_COUNT,
    STI_LA_BASE,
    STI_LA_COUNT,
    STI_LV_BASE,
    STI_LV_COUNT,
    STI_SA_BASE,
    STI_SA_COUNT,
    STI_STRIDE,
    STI_SV_BASE,
    STI_SV_COUNT,
    SYSF_BASE,
    SYSF_PERIOD_S,
    SYSI_BASE,
    SYSI_P_COUNT,
    THF_BASE,
    THF_ERROR_DETAIL,
    THF_FLOW_LIMIT,
    THF_FLOW_STEP,
    THF_RESULT,
    THF_STACK,
    THF_STACK_SIZE,
    THF_STRIDE,
    THF_WAIT_DEADLINE_TK,
    THF_WAIT_VALUE,
    THI_BASE,
    THI_BUDGET,
    THI_CODE_BASE,
    THI_DEPTH,
    THI_ERROR,
    THI_FLOW_BACK,
    THI_FLOW_KIND,
    THI_FLOW_KIND_SIZE,
    THI_FLOW_START,
    THI_FLOW_STOP,
    THI_LINE,
    THI_LINES_AT,
    THI_LINES_COUNT,
    THI_LOCALS,
    THI_NUM_BASE,
    THI_PASSED,
    THI_PC,
    THI_SP,
    THI_SPARE_FLAGS,
    THI_STRIDE,
    THI_TRAP,
    THI_WAIT_KIND,
    THI_WAIT_OPERAND,
    THI_WAIT_SHOW,
    USER_BASE,
)
from openacr.views import F32, F64, I32

__all__ = ["read_bit", "read_parameter", "vm_run", "wait_is_over", "write_bit", "write_parameter"]

PROGRAMS = 16
FLAG_WORDS = 4096
FLOAT32_LIMIT = 3.4028235677973366e38  # from here on rounding to FP32 overflows

# Why vm_run came back.
VM_END = 1
VM_SLICE = 2  # the statements of this slice are used up
VM_WAIT = 3
VM_TRAP = 4  # a statement that Python executes
VM_ERROR = 5
VM_FLAGS = 6  # pause, block or trace mode stops before this line
VM_CALL = 7  # an operand that Python computes
VM_VALUE = 8  # an expression is computed, see row result

# What a thread waits for; the numbers of basic.run.WaitKind.
WAIT_TIME = 1
WAIT_BIT_SET = 2
WAIT_BIT_CLEAR = 3
WAIT_PARAMETER_ABOVE = 4
WAIT_PARAMETER_BELOW = 5
WAIT_ROW_ABOVE = 6
WAIT_ROW_BELOW = 7
WAIT_NEXT_SLICE = 8

# Numbers of openacr.messages.
ERROR_UNDEFINED_VARIABLE = 4
ERROR_INVALID_PARAMETER = 5
ERROR_INVALID_BIT = 6
ERROR_SUBSCRIPT = 7
ERROR_MATH_RESULT = 10
ERROR_INVALID_ARGUMENT = 11
ERROR_LEVEL = 15
ERROR_LINE_NOT_FOUND = 20
ERROR_NEXT = 26
ERROR_WEND = 28
ERROR_RETURN = 29
ERROR_BREAK = 30
ERROR_STACK = 31

# Levels of the flow stack.
FLOW_IF = 1
FLOW_FOR = 2
FLOW_WHILE = 3
FLOW_GOSUB = 4

# Kinds of locals; the numbers of basic.nodes.LocalKind.
KIND_OF_LV = 0
KIND_OF_SV = 1
KIND_OF_DV = 2

# Operations; operands in parentheses, what is taken from the stack in brackets.
DO_STATEMENT = 0  # (line, 1 if it is the first one of the line)
DO_PUSH = 1  # (constant)
DO_JUMP = 2  # (pc)
DO_JUMP_IF_ZERO = 3  # (pc) [condition]
DO_OPERATOR = 4  # (operator) [a, b]
DO_FUNCTION = 5  # (function) [x]
DO_ADD = 6  # [a, b]
DO_LESS = 7  # [a, b]
DO_LOAD_LONG = 8  # (index in I)
DO_STORE_LONG = 9  # (index in I) [value]
DO_LOAD_SINGLE = 10  # (index in S)
DO_STORE_SINGLE = 11  # (index in S) [value]
DO_LOAD_USER = 12  # (n)
DO_STORE_USER = 13  # (n) [value]
DO_LOAD_LOCAL = 14  # (kind) [n]
DO_STORE_LOCAL = 15  # (kind) [n, value]
DO_LOAD_BIT = 16  # (word, mask)
DO_STORE_BIT = 17  # (word, mask) [value]
DO_LOAD_PARAMETER = 18  # [n]
DO_STORE_PARAMETER = 19  # [n, value]
DO_LOAD_FLAG = 20  # [n]
DO_STORE_FLAG = 21  # [n, value]
DO_LOAD_ELEMENT = 22  # (kind) [array, n]
DO_STORE_ELEMENT = 23  # (kind) [array, n, value]
DO_ENTER = 24  # (kind, start, stop): open an IF or WHILE
DO_LEAVE = 25  # (start): close it, if it is open
DO_ENTER_FOR = 26  # (start, stop) [limit, step]
DO_TEST_FOR = 27  # (pc behind NEXT) [value]
DO_NEXT = 28  # (start) [value]: the stepped value
DO_WEND = 29  # (start, pc of the condition)
DO_BREAK = 30  # (start, pc behind the loop)
DO_GOTO = 31  # (pc)
DO_GOSUB = 32  # (pc)
DO_GOTO_LINE = 33  # [line number]
DO_GOSUB_LINE = 34  # [line number]
DO_RETURN = 35
DO_END = 36
DO_FAIL = 37  # (error, detail)
DO_TRAP = 38  # (statement)
DO_CALL = 39  # (operand)
DO_RESULT = 40  # [value]
DO_DWELL = 41  # [seconds]
DO_INHIBIT = 42  # (1 for the clear state) [flag, timeout]
DO_INHIBIT_POSITION = 43  # (1 for below) [parameter, setpoint, timeout]
DO_MASK = 44  # [parameter, nandmask, ormask]
DO_LOAD_LV = 45  # (n)
DO_STORE_LV = 46  # (n) [value]

STOPS = PF_BLOCK_MODE | PF_PAUSE_MODE | PF_TRACE_MODE_ENABLE


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
    rows: int = THI_BASE + t * THI_STRIDE
    reals: int = THF_BASE + t * THF_STRIDE
    base: int = I[rows + THI_CODE_BASE]
    num_base: int = I[rows + THI_NUM_BASE]
    bottom: int = reals + THF_STACK
    top: int = bottom + I[rows + THI_SP]  # place of the next number to be pushed
    pc: int = base + I[rows + THI_PC]
    flags_at: int = PF_WORD + t if t < PROGRAMS else rows + THI_SPARE_FLAGS
    line_at: int = PROG_BASE + t * PROG_STRIDE + PROG_LINE_NUMBER
    error: int = 0
    event: int = 0
    op: int = 0
    at: int = 0
    word: int = 0
    locals_of: int = I[rows + THI_LOCALS]
    storage: int = STI_BASE + locals_of * STI_STRIDE
    if t >= PROGRAMS:
        line_at = rows + THI_LINE
    if top > bottom + THF_STACK_SIZE - 100:
        error = ERROR_STACK
    while error == 0 and event == 0:
        op = code[pc]
        if op == DO_STATEMENT:
            if budget == 0:
                event = VM_SLICE
            elif I[flags_at] & STOPS and code[pc + 2] and not I[rows + THI_PASSED]:
                event = VM_FLAGS
            else:
                budget -= 1
                word = code[pc + 1]
                I[rows + THI_LINE] = word
                I[line_at] = word
                I[rows + THI_PASSED] = 0
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
                error = ERROR_MATH_RESULT
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
            error = 0 if finite(F[top]) else ERROR_MATH_RESULT
            top += 1
            pc += 2
        elif op == DO_STORE_SINGLE:
            top -= 1
            error = store_single(S, code[pc + 1], F[top])
            pc += 2
        elif op == DO_LOAD_USER:
            if code[pc + 1] >= I[SYSI_BASE + SYSI_P_COUNT]:
                error = ERROR_UNDEFINED_VARIABLE
            F[top] = F[USER_BASE + code[pc + 1]]
            top += 1
            pc += 2
        elif op == DO_STORE_USER:
            top -= 1
            if code[pc + 1] < I[SYSI_BASE + SYSI_P_COUNT]:
                F[USER_BASE + code[pc + 1]] = F[top]
            else:
                error = ERROR_UNDEFINED_VARIABLE
            pc += 2
        elif op == DO_LOAD_LV:
            if locals_of < 0:
                error = ERROR_LEVEL
            elif code[pc + 1] >= I[storage + STI_LV_COUNT]:
                error = ERROR_UNDEFINED_VARIABLE
            else:
                F[top] = float(I[I[storage + STI_LV_BASE] + code[pc + 1]])
            top += 1
            pc += 2
        elif op == DO_STORE_LV:
            top -= 1
            if locals_of < 0:
                error = ERROR_LEVEL
            elif code[pc + 1] >= I[storage + STI_LV_COUNT]:
                error = ERROR_UNDEFINED_VARIABLE
            else:
                I[I[storage + STI_LV_BASE] + code[pc + 1]] = long_word(F[top])
            pc += 2
        elif op == DO_LOAD_LOCAL:
            at = local_place(I, locals_of, code[pc + 1], F[top - 1])
            if at < 0:
                error = 0 - at
            else:
                error = load_kind(F, I, S, code[pc + 1], at, top - 1)
            pc += 2
        elif op == DO_STORE_LOCAL:
            top -= 2
            at = local_place(I, locals_of, code[pc + 1], F[top])
            if at < 0:
                error = 0 - at
            else:
                error = store_kind(F, I, S, code[pc + 1], at, F[top + 1])
            pc += 2
        elif op == DO_LOAD_BIT:
            F[top] = -1.0 if I[code[pc + 1]] & code[pc + 2] else 0.0
            top += 1
            pc += 3
        elif op == DO_STORE_BIT:
            top -= 1
            at = code[pc + 1]
            word = code[pc + 2]
            I[at] = I[at] | word if F[top] != 0.0 else I[at] & ~word
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
                error = ERROR_INVALID_BIT
            F[top - 1] = float(0 - word)
            pc += 1
        elif op == DO_STORE_FLAG:
            top -= 2
            error = write_bit(I, whole_index(F[top]), F[top + 1] != 0.0)
            pc += 1
        elif op == DO_LOAD_ELEMENT:
            top -= 1
            at = element_place(I, locals_of, code[pc + 1], F[top - 1], F[top])
            if at < 0:
                error = 0 - at
            else:
                error = load_kind(F, I, S, code[pc + 1], at, top - 1)
            pc += 2
        elif op == DO_STORE_ELEMENT:
            top -= 3
            at = element_place(I, locals_of, code[pc + 1], F[top], F[top + 1])
            if at < 0:
                error = 0 - at
            else:
                error = store_kind(F, I, S, code[pc + 1], at, F[top + 2])
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
                error = ERROR_INVALID_ARGUMENT
            else:
                error = open_level(I, rows, FLOW_FOR, code[pc + 1], code[pc + 2])
            if error == 0:
                at = I[rows + THI_DEPTH] - 1
                F[reals + THF_FLOW_LIMIT + at] = F[top]
                F[reals + THF_FLOW_STEP + at] = F[top + 1]
            pc += 3
        elif op == DO_TEST_FOR:
            top -= 1
            at = reals + I[rows + THI_DEPTH] - 1
            if F[at + THF_FLOW_STEP] > 0.0:
                word = 1 if F[top] <= F[at + THF_FLOW_LIMIT] else 0
            else:
                word = 1 if F[top] >= F[at + THF_FLOW_LIMIT] else 0
            if word:
                pc += 2
            else:
                I[rows + THI_DEPTH] = I[rows + THI_DEPTH] - 1
                pc = base + code[pc + 1]
        elif op == DO_NEXT:
            if is_open(I, rows, FLOW_FOR, code[pc + 1]):
                at = I[rows + THI_DEPTH] - 1
                F[top - 1] = F[top - 1] + F[reals + THF_FLOW_STEP + at]
                error = 0 if finite(F[top - 1]) else ERROR_MATH_RESULT
            else:
                error = ERROR_NEXT
            pc += 2
        elif op == DO_WEND:
            if is_open(I, rows, FLOW_WHILE, code[pc + 1]):
                pc = base + code[pc + 2]
            else:
                error = ERROR_WEND
        elif op == DO_BREAK:
            if break_level(I, rows, code[pc + 1]):
                pc = base + code[pc + 2]
            else:
                error = ERROR_BREAK
        elif op == DO_GOTO:
            unwind(I, rows, code[pc + 1])
            pc = base + code[pc + 1]
        elif op == DO_GOSUB:
            error = open_level(I, rows, FLOW_GOSUB, 0, 0)
            if error == 0:
                I[rows + THI_FLOW_BACK + I[rows + THI_DEPTH] - 1] = pc + 2 - base
                pc = base + code[pc + 1]
        elif op == DO_GOTO_LINE or op == DO_GOSUB_LINE:
            top -= 1
            word = line_place(I, code, rows, F[top])
            if word < 0:
                error = ERROR_LINE_NOT_FOUND
                F[reals + THF_ERROR_DETAIL] = F[top]
            elif op == DO_GOTO_LINE:
                unwind(I, rows, word)
                pc = base + word
            else:
                error = open_level(I, rows, FLOW_GOSUB, 0, 0)
                if error == 0:
                    I[rows + THI_FLOW_BACK + I[rows + THI_DEPTH] - 1] = pc + 1 - base
                    pc = base + word
        elif op == DO_RETURN:
            word = return_level(I, rows)
            if word < 0:
                error = ERROR_RETURN
            else:
                pc = base + word
        elif op == DO_END:
            event = VM_END
        elif op == DO_FAIL:
            error = code[pc + 1]
            F[reals + THF_ERROR_DETAIL] = float(code[pc + 2])
        elif op == DO_TRAP:
            I[rows + THI_TRAP] = code[pc + 1]
            pc += 2
            event = VM_TRAP
        elif op == DO_CALL:
            I[rows + THI_TRAP] = code[pc + 1]
            event = VM_CALL  # pc stays: Python pushes the value and steps over
        elif op == DO_RESULT:
            top -= 1
            F[reals + THF_RESULT] = F[top]
            event = VM_VALUE
        elif op == DO_DWELL:
            top -= 1
            pc += 1
            if F[top] > 0.0:
                event = VM_WAIT
                start_wait(F, I, t, WAIT_TIME, 0, 0.0, F[top], tick)
        elif op == DO_INHIBIT:
            top -= 2
            word = whole_index(F[top])
            at = code[pc + 1]
            if word < 0:  # a computed negative number means the clear state, too
                word = 0 - word
                at = 1 - at
            pc += 2
            if read_bit(I, word) < 0:
                error = ERROR_INVALID_BIT
            elif read_bit(I, word) == at:
                event = VM_WAIT
                at = WAIT_BIT_CLEAR if at else WAIT_BIT_SET
                start_wait(F, I, t, at, word, 0.0, F[top + 1], tick)
        elif op == DO_INHIBIT_POSITION:
            top -= 3
            word = whole_index(F[top])
            at = WAIT_PARAMETER_BELOW if code[pc + 1] else WAIT_PARAMETER_ABOVE
            pc += 2
            if locals_of >= 0:
                I[PF_WORD + locals_of] = I[PF_WORD + locals_of] & ~PF_PROGRAM_TIMEOUT
            error = read_parameter(F, I, S, word, top + 3)
            if error == 0:
                start_wait(F, I, t, at, word, F[top + 1], F[top + 2], tick)
                if wait_is_over(F, I, S, t, tick) == 0:
                    event = VM_WAIT
        elif op == DO_MASK:
            top -= 3
            error = mask_parameter(I, whole_index(F[top]), F[top + 1], F[top + 2])
            pc += 1
        else:
            error = ERROR_MATH_RESULT
    I[rows + THI_SP] = top - bottom
    I[rows + THI_PC] = pc - base
    I[rows + THI_BUDGET] = budget
    if error != 0:
        I[rows + THI_ERROR] = error
        return VM_ERROR
    return event


# values


def whole_index(value: float) -> int:
    """A number from the stack as an index; beyond 32 bits it is one that exists nowhere."""
    if not (-2147483648.0 < value < 2147483647.0):
        return 2147483647
    return int(value)


def store_single(S: F32, at: int, value: float) -> int:
    """Store into an FP32 row, rounded to nearest."""
    if not (-FLOAT32_LIMIT < value < FLOAT32_LIMIT):
        return ERROR_MATH_RESULT
    S[at] = value
    return 0


def load_kind(F: F64, I: I32, S: F32, kind: int, at: int, to: int) -> int:
    """F[to] := the local variable or array element at `at`."""
    if kind == KIND_OF_LV:
        F[to] = float(I[at])
    elif kind == KIND_OF_SV:
        F[to] = S[at]
    else:
        F[to] = F[at]
    return 0


def store_kind(F: F64, I: I32, S: F32, kind: int, at: int, value: float) -> int:
    """Store into the local variable or array element at `at`."""
    if kind == KIND_OF_LV:
        I[at] = long_word(value)
    elif kind == KIND_OF_SV:
        return store_single(S, at, value)
    else:
        F[at] = value
    return 0


def local_place(I: I32, program: int, kind: int, index: float) -> int:
    """Where a local variable lies in the view of its kind, or minus an error number."""
    rows: int = STI_BASE + program * STI_STRIDE
    number: int = whole_index(index)
    base: int = 0
    count: int = 0
    if program < 0:
        return -ERROR_LEVEL
    if kind == KIND_OF_LV:
        base = I[rows + STI_LV_BASE]
        count = I[rows + STI_LV_COUNT]
    elif kind == KIND_OF_SV:
        base = I[rows + STI_SV_BASE]
        count = I[rows + STI_SV_COUNT]
    else:
        base = I[rows + STI_DV_BASE]
        count = I[rows + STI_DV_COUNT]
    if number < 0:
        return -ERROR_SUBSCRIPT
    if number >= count:
        return -ERROR_UNDEFINED_VARIABLE
    return base + number


def element_place(I: I32, program: int, kind: int, array: float, index: float) -> int:
    """Where an array element lies in the view of its kind, or minus an error number.

    The table of references leads to a header that holds the number of elements; they
    follow behind it, those of DA aligned for the float64 view.
    """
    rows: int = STI_BASE + program * STI_STRIDE
    which: int = whole_index(array)
    number: int = whole_index(index)
    table: int = 0
    count: int = 0
    header: int = 0
    if program < 0:
        return -ERROR_LEVEL
    if kind == KIND_OF_LV:
        table = I[rows + STI_LA_BASE]
        count = I[rows + STI_LA_COUNT]
    elif kind == KIND_OF_SV:
        table = I[rows + STI_SA_BASE]
        count = I[rows + STI_SA_COUNT]
    else:
        table = I[rows + STI_DA_BASE]
        count = I[rows + STI_DA_COUNT]
    if count == 0:
        return -ERROR_UNDEFINED_VARIABLE
    if which < 0 or which >= count:
        return -ERROR_SUBSCRIPT
    header = I[table + which]
    if header == 0:
        return -ERROR_UNDEFINED_VARIABLE
    if number < 0 or number >= I[header]:
        return -ERROR_SUBSCRIPT
    if kind == KIND_OF_DV:
        return ((header + 1) >> 1) + number
    return header + 1 + number


def parameter_kind(I: I32, number: int) -> int:
    """The kind of parameter `number`, 0 where none is defined."""
    if number < 0 or number >= PUBLIC_COUNT:
        return 0
    return (I[number >> 4] >> ((number & 15) << 1)) & 3


def read_parameter(F: F64, I: I32, S: F32, number: int, to: int) -> int:
    """F[to] := parameter `number`; an error number or 0."""
    kind: int = parameter_kind(I, number)
    if kind == KIND_LONG:
        F[to] = float(I[number])
    elif kind == KIND_FP32:
        F[to] = S[number]
        if not finite(F[to]):
            return ERROR_MATH_RESULT
    elif kind == KIND_FP64:
        if number >= I[SYSI_BASE + SYSI_P_COUNT]:
            return ERROR_UNDEFINED_VARIABLE
        F[to] = F[USER_BASE + number]
    else:
        return ERROR_INVALID_PARAMETER
    return 0


def write_parameter(F: F64, I: I32, S: F32, number: int, value: float) -> int:
    """Parameter `number` := value, converted as its kind demands; an error number or 0."""
    kind: int = parameter_kind(I, number)
    if kind == KIND_LONG:
        I[number] = long_word(value)
    elif kind == KIND_FP32:
        return store_single(S, number, value)
    elif kind == KIND_FP64:
        if number >= I[SYSI_BASE + SYSI_P_COUNT]:
            return ERROR_UNDEFINED_VARIABLE
        F[USER_BASE + number] = value
    else:
        return ERROR_INVALID_PARAMETER
    return 0


def mask_parameter(I: I32, number: int, nandmask: float, ormask: float) -> int:
    """P := (P AND NOT nandmask) OR ormask on a LONG parameter; an error number or 0."""
    if parameter_kind(I, number) != KIND_LONG:
        return ERROR_INVALID_PARAMETER
    I[number] = (I[number] & ~long_word(nandmask)) | long_word(ormask)
    return 0


def read_bit(I: I32, number: int) -> int:
    """State of flag `number`, 1 or 0; -1 if there is none."""
    if number < 0 or number > FLAG_LAST:
        return -1
    return (I[FLAG_WORDS + (number >> 5)] >> (number & 31)) & 1


def write_bit(I: I32, number: int, on: bool) -> int:
    """Set or clear flag `number`; an error number or 0."""
    at: int = FLAG_WORDS + (number >> 5)
    bit: int = number & 31
    mask: int = 1
    if number < 0 or number > FLAG_LAST:
        return ERROR_INVALID_BIT
    mask = mask << bit
    if bit == 31:
        mask = -2147483648
    I[at] = I[at] | mask if on else I[at] & ~mask
    return 0


# flow levels


def open_level(I: I32, rows: int, kind: int, start: int, stop: int) -> int:
    """Push a level whose text is the code from start up to stop; an error number or 0."""
    depth: int = I[rows + THI_DEPTH]
    if depth >= THI_FLOW_KIND_SIZE:
        return ERROR_STACK
    I[rows + THI_FLOW_KIND + depth] = kind
    I[rows + THI_FLOW_START + depth] = start
    I[rows + THI_FLOW_STOP + depth] = stop
    I[rows + THI_DEPTH] = depth + 1
    return 0


def is_open(I: I32, rows: int, kind: int, start: int) -> bool:
    """Whether the innermost level is this one."""
    depth: int = I[rows + THI_DEPTH] - 1
    return (
        depth >= 0
        and I[rows + THI_FLOW_KIND + depth] == kind
        and I[rows + THI_FLOW_START + depth] == start
    )


def close_level(I: I32, rows: int, start: int) -> None:
    """Pop the level that begins at start, if it is the innermost one."""
    depth: int = I[rows + THI_DEPTH] - 1
    if (
        depth >= 0
        and I[rows + THI_FLOW_KIND + depth] != FLOW_GOSUB
        and I[rows + THI_FLOW_START + depth] == start
    ):
        I[rows + THI_DEPTH] = depth


def break_level(I: I32, rows: int, start: int) -> bool:
    """Pop levels up to and including the loop that begins at start; False if it is not open."""
    depth: int = I[rows + THI_DEPTH] - 1
    while depth >= 0 and I[rows + THI_FLOW_KIND + depth] != FLOW_GOSUB:
        if I[rows + THI_FLOW_START + depth] == start and I[rows + THI_FLOW_KIND + depth] != FLOW_IF:
            I[rows + THI_DEPTH] = depth
            return True
        depth -= 1
    return False


def unwind(I: I32, rows: int, target: int) -> None:
    """Pop the levels of the present routine whose text does not contain the target."""
    depth: int = I[rows + THI_DEPTH] - 1
    while (
        depth >= 0
        and I[rows + THI_FLOW_KIND + depth] != FLOW_GOSUB
        and not (I[rows + THI_FLOW_START + depth] <= target < I[rows + THI_FLOW_STOP + depth])
    ):
        depth -= 1
    I[rows + THI_DEPTH] = depth + 1


def return_level(I: I32, rows: int) -> int:
    """Pop up to the latest GOSUB and give the place behind it, or -1."""
    depth: int = I[rows + THI_DEPTH] - 1
    while depth >= 0:
        if I[rows + THI_FLOW_KIND + depth] == FLOW_GOSUB:
            I[rows + THI_DEPTH] = depth
            return I[rows + THI_FLOW_BACK + depth]
        depth -= 1
    return -1


def line_place(I: I32, code: I32, rows: int, line: float) -> int:
    """The place of a stored line by bisection in the table of (line, place), or -1."""
    number: int = whole_index(line)
    table: int = I[rows + THI_CODE_BASE] + I[rows + THI_LINES_AT]
    low: int = 0
    high: int = I[rows + THI_LINES_COUNT]
    middle: int = 0
    while low < high:
        middle = (low + high) >> 1
        if code[table + 2 * middle] < number:
            low = middle + 1
        else:
            high = middle
    if low < I[rows + THI_LINES_COUNT] and code[table + 2 * low] == number:
        return code[table + 2 * low + 1]
    return -1


# waits


def start_wait(
    F: F64,
    I: I32,
    t: int,
    kind: int,
    operand: int,
    value: float,
    seconds: float,
    tick: int,
) -> None:
    """Note what thread t waits for, with a time limit if seconds is positive."""
    rows: int = THI_BASE + t * THI_STRIDE
    reals: int = THF_BASE + t * THF_STRIDE
    period: float = F[SYSF_BASE + SYSF_PERIOD_S]
    show: int = PF_PROGRAM_DWELLING if kind == WAIT_TIME else PF_PROGRAM_INHIBITED
    I[rows + THI_WAIT_KIND] = kind
    I[rows + THI_WAIT_OPERAND] = operand
    I[rows + THI_WAIT_SHOW] = show
    F[reals + THF_WAIT_VALUE] = value
    F[reals + THF_WAIT_DEADLINE_TK] = 0.0
    if seconds > 0.0 and period > 0.0:
        F[reals + THF_WAIT_DEADLINE_TK] = float(tick) + ceil(seconds / period - 1.0e-6)


def wait_is_over(F: F64, I: I32, S: F32, t: int, tick: int) -> int:
    """1 if what thread t waits for has come, 2 if its time is up, else 0."""
    rows: int = THI_BASE + t * THI_STRIDE
    reals: int = THF_BASE + t * THF_STRIDE
    kind: int = I[rows + THI_WAIT_KIND]
    operand: int = I[rows + THI_WAIT_OPERAND]
    value: float = F[reals + THF_WAIT_VALUE]
    deadline: float = F[reals + THF_WAIT_DEADLINE_TK]
    present: float = 0.0
    met: bool = False
    if kind == WAIT_BIT_SET:
        met = read_bit(I, operand) == 1
    elif kind == WAIT_BIT_CLEAR:
        met = read_bit(I, operand) == 0
    elif kind == WAIT_ROW_ABOVE:
        met = float(I[operand]) > value
    elif kind == WAIT_ROW_BELOW:
        met = float(I[operand]) < value
    elif kind == WAIT_PARAMETER_ABOVE or kind == WAIT_PARAMETER_BELOW:
        if read_parameter(F, I, S, operand, reals + THF_RESULT) != 0:
            return 1  # it was freed meanwhile: nothing to wait for
        present = F[reals + THF_RESULT]
        met = present > value if kind == WAIT_PARAMETER_ABOVE else present < value
    if met:
        return 1
    if deadline > 0.0 and float(tick) >= deadline:
        return 1 if kind == WAIT_TIME or kind == WAIT_NEXT_SLICE else 2
    return 0
