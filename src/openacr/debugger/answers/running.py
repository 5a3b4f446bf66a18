"""Run, step and pause, forwards and backwards."""

from __future__ import annotations

from openacr.debugger import requests
from openacr.debugger.adapter import Adapter, Json, request
from openacr.debugger.target import Target


@request(requests.OfThread)
def continue_(adapter: Adapter, arguments: requests.OfThread) -> Json:
    """Run until something stops the card."""
    owner, target = arguments.thread_id - 1, adapter.standing()
    target.course.resume(owner)
    adapter.resume(owner)
    return {"allThreadsContinued": not target.course.is_live}


def _step(
    adapter: Adapter, arguments: requests.Step, *, into: bool = False, out: bool = False
) -> None:
    owner, target = arguments.thread_id - 1, adapter.standing()
    if _is_by_tick(target, arguments):
        adapter.stopped(target.course.tick())
        return
    target.course.begin_step(owner, into=into, out=out)
    adapter.resume(owner)


def _is_by_tick(target: Target, arguments: requests.Step) -> bool:
    return arguments.granularity == "instruction" or not target.steps_lines(arguments.thread_id - 1)


@request(requests.Step)
def next_(adapter: Adapter, arguments: requests.Step) -> None:
    """Step to the next line, over routines that are called; by instruction: one servo interrupt."""
    _step(adapter, arguments)


@request(requests.Step)
def step_in(adapter: Adapter, arguments: requests.Step) -> None:
    """Step to the next line, into routines."""
    _step(adapter, arguments, into=True)


@request(requests.Step)
def step_out(adapter: Adapter, arguments: requests.Step) -> None:
    """Step to the line after the call of the present routine."""
    _step(adapter, arguments, out=True)


@request(requests.Step)
def step_back(adapter: Adapter, arguments: requests.Step) -> None:
    """Go back to the line that the program has executed before."""
    target = adapter.standing()
    owner, course = arguments.thread_id - 1, target.course
    is_by_tick = _is_by_tick(target, arguments)
    adapter.stopped(course.tick_back() if is_by_tick else course.step_back(owner))


@request(requests.OfThread)
def reverse_continue(adapter: Adapter, arguments: requests.OfThread) -> None:
    """Go back to the last stop before the present."""
    adapter.stopped(adapter.standing().course.run_back())


@request(requests.OfThread)
def pause(adapter: Adapter, arguments: requests.OfThread) -> None:
    """Stop where the card is."""
    if adapter.is_watching:
        stop = adapter.target.course.paused(arguments.thread_id - 1)
        if stop is not None:
            adapter.stopped(stop)
