"""Run all figures, or those named on the command line."""

import sys
from importlib import import_module

from bench.figures import print_head

ORDER = (
    "gantry",
    "sixteen_axes",
    "everything",
    "lookahead",
    "trajectories",
    "busy",
    "kernel_tick",
    "statements",
    "lexer",
    "check",
    "state",
    "timeline",
    "debugging",
    "sweep",
    "startup",
    "language_server",
    "realtime",
    "terminal_latency",
    "packets",
    "bursts",
    "pollers",
    "compensate",
    "sysvar",
    "moves",
    "interpret",
    "big_file",
    "mill_run",
    "panel",
    "scope",
    "ladder",
    "panel_graphics",
    "panel_scope",
    "bridge",
)


def main() -> None:
    names = sys.argv[1:] or list(ORDER)
    unknown = sorted(set(names) - set(ORDER))
    if unknown:
        sys.exit(f"bench {' '.join(unknown)}: known are {', '.join(ORDER)}")
    print_head()
    for name in names:
        import_module(f"bench.{name}").main()


if __name__ == "__main__":
    main()
