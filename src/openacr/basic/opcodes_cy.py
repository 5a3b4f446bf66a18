"""The vocabulary of the virtual machine: operations, reasons to stop, error numbers."""

# Why vm_run came back.
VM_END = 1
VM_SLICE = 2  # the statements of this slice are used up
VM_WAIT = 3
VM_TRAP = 4  # a statement that Python executes
VM_ERROR = 5
VM_FLAGS = 6  # pause, block or trace mode stops before this line
VM_CALL = 7  # an operand that Python computes
VM_VALUE = 8  # an expression is computed, see row result

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
