"""Hidden rows of the execution of AcroBASIC: threads and their time slices.

Threads 0-15 are the programs, 16-31 the command channels, 32-47 the kinematics of masters
(INVK). All a thread knows lies in its rows, so a snapshot taken at any tick continues where
it was.
"""

from openacr.map.hidden.block import ROWS_I, HiddenBlock, Merge

STACK = 192  # numbers on the expression stack of one thread
DEPTH = 64  # FOR, WHILE, GOSUB and IF levels open at a time

THREAD = HiddenBlock(
    prefix="TH",
    family="threads",
    count=48,
    doubles=(
        "result",  # of an expression computed for a command
        "error_detail",
        "wait_value",
        "wait_deadline_tk",  # 0: no time limit
        ("flow_limit", DEPTH),  # FOR: end value and step
        ("flow_step", DEPTH),
        ("stack", STACK),
    ),
    ints=(
        "state",  # see basic/vm/scheduler_cy.py
        "event",  # why the VM came back, see basic/vm/vm_cy.py
        "budget",  # statements left in this slice
        "pc",  # next operation, counted from code_base
        "sp",  # numbers on the expression stack
        "depth",  # open flow levels
        "line",  # line number of the present statement
        "trap",  # Python statement to execute
        "error",
        "lines_at",  # table of line numbers for computed jumps
        "lines_count",
        "locals",  # program whose locals and flags are meant, -1 none
        "passed",  # a stop before this line is already dealt with
        "spare_flags",  # stands in for the program flags where there is no program
        "wait_kind",
        "wait_operand",
        "wait_show",  # program flag that is set while waiting
        ("flow_kind", DEPTH),
        ("flow_start", DEPTH),  # text of the level: code from start up to stop
        ("flow_stop", DEPTH),
        ("flow_back", DEPTH),  # GOSUB: where to return
    ),
    ranges={
        "state": (0, 3),
        "budget": (0, 1 << 16),
        "depth": (0, DEPTH),
        "error": (0, 255),
        "locals": (-1, 15),
        "wait_operand": (0, ROWS_I),
        "wait_deadline_tk": (0, 1e18),
        "error_detail": (-1e15, 1e15),
    },
)

# Where code and constants of each thread begin in the buffers of this process.
THREAD_CODE = HiddenBlock(
    prefix="THC", family="thread_code", count=48, ints=("code_base", "num_base")
)

SCHEDULER = HiddenBlock(
    prefix="SCH",
    family="scheduler",
    count=1,
    merged={Merge.BITS: ("programs", "channels")},
    merged_usually=Merge.LOOP,
    ints=(
        "programs",  # mask of the threads 0-15 that are not idle
        "channels",  # mask of the threads 16-31 that are not idle
        "phase",
        "cursor",  # channel that is being served
        "slot",  # place in the ring
        "ticks_left",  # of the present slice
        "thread",  # thread that owns the present slice, -1 none
        "low",  # last of the programs 8-15 that had the shared slice
    ),
    ranges={
        "programs": (0, 0xFFFF),
        "channels": (0, 0xFFFF),
        "phase": (0, 0),  # between ticks
        "cursor": (0, 32),
        "slot": (0, 9),
        "ticks_left": (-1, 1 << 20),
        "thread": (-1, 15),
        "low": (0, 15),
    },
)
