"""Hidden rows of the engine: what it has still to do in the present call."""

from openacr.map.hidden.block import HiddenBlock

ENGINE = HiddenBlock(
    prefix="ENG",
    count=1,
    ints=(
        "ticks_left",
        "in_tick",  # how far the present tick has got, see engine/loop_cy.py
        "until_word",  # stop when the masked word equals the state; 0 never
        "until_mask",
        "until_state",
        "trace_every",  # ticks between two samples, 0 no trace
        "trace_wait",
        "trace_row",
        "trace_rows",
    ),
)
