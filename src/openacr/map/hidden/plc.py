"""Hidden rows of the PLCs: what is scanned, and what timers and counters remember."""

from openacr.map.hidden.block import HiddenBlock

INSTRUCTIONS = 200  # of one PLC

PLC = HiddenBlock(
    prefix="PC",
    family="plcs",
    count=8,
    doubles=("timer_ms",),  # since the timer count last went down
    ints=(
        "length",  # instructions to scan
        "clock_old",  # counter clock of the tick before
        "noted",  # the scans note in the code what they see
        ("code", INSTRUCTIONS),  # one word each, see plc/scan_cy.py
    ),
    ranges={
        "length": (0, INSTRUCTIONS),
        "noted": (0, 1),
        "timer_ms": (0, 1000),
    },
)
