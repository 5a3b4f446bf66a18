"""A start at a later line: the lines before it are read, and what differs is confirmed."""

from dataclasses import dataclass
from typing import Any

from openacr.cnc.interpreter.replay import Rehearsal, Replay
from openacr.errors import UserError
from openacr.mill.session import Start
from openacr.panel.control.machine.link import Link
from openacr.panel.control.operator.loaded import Loaded
from openacr.panel.control.operator.orders import Order, failure

AT_ONCE = 100  # moves and outputs of a rehearsal between two steps of the machine


@dataclass(slots=True)
class _Rehearsing:
    """The lines before a start line while they are read, and who waits for what differs."""

    steps: Rehearsal
    loaded: Loaded
    start: Start
    order: Order


class Rehearsals:
    """The rehearsal under way, and the last one that can be confirmed."""

    def __init__(self, link: Link) -> None:
        self._link = link
        self._under_way: _Rehearsing | None = None
        self._rehearsed: tuple[str, Start, Replay] | None = None
        self._tokens = 0

    def begin(self, loaded: Loaded, start: Start, order: Order) -> None:
        """Read the lines before a start line; what differs is confirmed by the operator.

        They are read between the steps of the control thread; the order is answered at the end.
        """
        session = self._link.machine
        session.runner.require_start()
        if self._under_way is not None:
            raise UserError("the lines before a start line are being read: wait")
        steps = session.rehearsal(loaded.program, start)
        self._under_way = _Rehearsing(steps, loaded, start, order)

    def go_on(self, loaded: Loaded | None) -> None:
        """Go on reading for AT_ONCE steps, or until a stop waits; `loaded`: the program now."""
        under_way = self._under_way
        if under_way is None:
            return
        try:
            self._link.machine.runner.require_start()  # the machine is where it was
            if loaded is not under_way.loaded:
                raise UserError("another program was loaded")
            for _ in range(AT_ONCE):
                if self._link.is_awaited():
                    return
                next(under_way.steps)
        except StopIteration as done:
            self._under_way = None
            result = self._confirmable(done.value, under_way)
            under_way.order.answer({"ok": True, "result": {"rehearsal": result}})
        except Exception as error:
            self._under_way = None
            under_way.order.answer({"ok": False, "error": failure(error)})

    def _confirmable(self, replay: Replay, under_way: _Rehearsing) -> dict[str, Any]:
        loaded, start = under_way.loaded, under_way.start
        self._tokens += 1
        token = f"{loaded.version[:8]}-{self._tokens}"
        self._rehearsed = (token, start, replay)
        return {
            "token": token,
            "line": start.line,
            "differences": [
                {
                    "name": each.name,
                    "present": each.shown(each.present),
                    "wanted": each.shown(each.wanted),
                }
                for each in replay.differences
            ],
            "warnings": [str(each) for each in replay.warnings],
            "needs_tool": replay.needs_tool,
            "safe_z": replay.safe_level(),
        }

    def confirmed(self, start: Start, token: str) -> Replay:
        """What was rehearsed for a start; UserError where this was not confirmed."""
        if self._rehearsed is None or self._rehearsed[0] != token:
            raise UserError(f"line {start.line}: what differs there is confirmed first")
        _token, rehearsed, replay = self._rehearsed
        if rehearsed.line != start.line or rehearsed.is_dry != start.is_dry:
            raise UserError(f"line {start.line}: line {rehearsed.line} was confirmed")
        return replay

    def forget(self) -> None:
        """A program starts, or another one is loaded: nothing can be confirmed any more."""
        self._rehearsed = None
