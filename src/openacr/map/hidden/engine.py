"""Hidden rows of the engine: what it has still to do in the present call."""

from openacr.map.hidden.block import HiddenBlock, Merge

ENGINE = HiddenBlock(
    prefix="ENG",
    family="engine",
    count=1,
    merged_usually=Merge.ORDER,
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
        "trace_peaks",  # keep the extremes between samples, see engine/trace_cy.py
        "watch_count",
        "sample_count",  # values recorded in the trace beside the axes
        "stop",  # return at the end of this tick
        "line_stops",  # programs whose lines are announced before they begin, one bit each
        "line_announced",  # program whose next line has been announced, plus 1; negative: is to be
        "statements",  # that have begun in this tick
    ),
    ranges={
        "in_tick": (0, 0),  # between ticks
    },
)

# What the caller waits for: the engine returns after a tick in which one of these changed.
WATCH = HiddenBlock(
    prefix="WAT",
    family="watches",
    count=128,
    merged_usually=Merge.ORDER,
    doubles=("bound",),
    ints=(
        "kind",  # where the value is, see engine/watch_cy.py
        "row",
        "mask",  # of a word
        "is_above",  # a number is compared with the bound: 1 above it, 0 below it
        "state",
        "fired",  # since the caller last asked
    ),
)

# Values that a trace records beside the axes.
SAMPLE = HiddenBlock(
    prefix="SMV",
    family="trace_values",
    count=64,
    merged_usually=Merge.ORDER,
    ints=("kind", "row", "mask"),  # as those of WATCH
)
