"""The history of the card, beyond the protocol: moments and branches."""

from __future__ import annotations

from openacr.debugger import requests
from openacr.debugger.adapter import Adapter, Json, request
from openacr.timeline import Moment


@request(requests.Seek)
def openacr_seek(adapter: Adapter, arguments: requests.Seek) -> Json:
    """Go to a tick of the present branch, or of another one."""
    target = adapter.standing()
    if arguments.branch is not None:
        target.course.timeline.switch(arguments.branch)
    adapter.stopped(target.course.seek(Moment(arguments.tick, arguments.within)))
    return {}


@request(requests.Nothing)
def openacr_timeline(adapter: Adapter, arguments: requests.Nothing) -> Json:
    """The branches of the history, and the present moment."""
    timeline = adapter.target.course.timeline
    return {
        "branch": timeline.branch.number,
        "tick": timeline.now.tick,
        "within": timeline.now.within,
        "period_s": adapter.target.course.period_s,
        "bytes": timeline.size_bytes,
        "branches": [
            {
                "number": each.number, "parent": each.parent, "first": each.first.tick,
                "last": each.last.tick, "fork": each.fork.tick if each.fork else None,
            }
            for each in timeline.branches
        ],
    }  # fmt: skip
