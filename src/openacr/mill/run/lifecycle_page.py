"""Generator of the life cycle page: `python -m openacr.mill.run.lifecycle_page FILE`."""

import sys
from collections.abc import Iterator
from itertools import groupby
from pathlib import Path

from openacr.mill.run.lifecycle import ENDINGS, TRANSITIONS, Action, Event, State, Transition

HEAD = """# The life cycle of a run

Written by `make docs` from the table in `openacr.mill.run.lifecycle`; do not edit.

A machine is in one of these states. Other programs read the number in P244. A status line shows
the names, and for PAUSED the text of the guide, `----PAUSE----`.

"""
PICTURE = """
## Transitions between states

Endings, which are possible in every state, are omitted here; the table has them.

"""
TABLE = """
## All transitions

An event that is not listed for a state is refused and changes nothing. If an action refuses,
the state stays; endings (bold) are entered even if their action fails halfway.
A feed hold during homing raises alarm 34, which is `FAULT`. RESUME given in HOLD is `CYCLE_START`,
START given in PAUSED is `RESUME`.

"""


def page() -> str:
    """The page as Markdown."""
    return HEAD + _states() + PICTURE + _picture() + TABLE + _table()


def _states() -> str:
    rows = (f"| {state.name} | {state.cell} | {state.value} |" for state in State)
    return "\n".join(("| state | P244 | meaning |", "|---|---|---|", *rows)) + "\n"


def _picture() -> str:
    arrows = (
        f"    {state.name} --> {row.state.name}: {event.name}"
        for (state, event), row in TRANSITIONS.items()
        if row.action not in ENDINGS or event is Event.END
        if event not in (Event.LINK_LOST, Event.ACKNOWLEDGE)
    )
    last = f"    {State.ALARM.name} --> {State.IDLE.name}: {Event.ACKNOWLEDGE.name}"
    lines = ("```mermaid", "stateDiagram-v2", "    [*] --> IDLE", *arrows, last, "```")
    return "\n".join(lines) + "\n"


def _table() -> str:
    lines = ["| event | in | then | action |", "|---|---|---|---|", *_rows()]
    return "\n".join(lines) + "\n"


def _rows() -> Iterator[str]:
    """One row for each event and outcome, with the states that share it."""

    def outcome(item: tuple[tuple[State, Event], Transition]) -> tuple[Event, Transition]:
        return item[0][1], item[1]

    for (event, (state, action)), group in groupby(TRANSITIONS.items(), outcome):
        states = ", ".join(pair[0].name for pair, _ in group)
        text = f"**{action.value}**" if action in ENDINGS else action.value
        text = "" if action is Action.NOTHING else text
        yield f"| {event.name}: {event.value} | {states} | {state.name} | {text} |"


def main() -> None:
    """Write the page to the file named on the command line."""
    Path(sys.argv[1]).write_text(page())


if __name__ == "__main__":
    main()
