"""Run, step and pause, forwards and backwards."""

from __future__ import annotations

from openacr.debugger import requests
from openacr.debugger.adapter import Adapter, Json, request
from openacr.debugger.calls import PROGRAMS


@request(requests.OfThread)
def continue_(adapter: Adapter, arguments: requests.OfThread) -> Json:
    """Run until something stops the card."""
    adapter.standing()
    adapter.resume()
    return {"allThreadsContinued": True}


def _step(
    adapter: Adapter, arguments: requests.Step, *, into: bool = False, out: bool = False
) -> None:
    program = arguments.thread_id - 1
    session = adapter.standing()
    if arguments.granularity == "instruction" or program >= PROGRAMS:
        adapter.stopped(session.tick())
        return
    session.begin_step(program, into=into, out=out)
    adapter.resume()


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
    session = adapter.standing()
    program = arguments.thread_id - 1
    if arguments.granularity == "instruction" or program >= PROGRAMS:
        adapter.stopped(session.tick_back())
    else:
        adapter.stopped(session.step_back(program))


@request(requests.OfThread)
def reverse_continue(adapter: Adapter, arguments: requests.OfThread) -> None:
    """Go back to the last stop before the present."""
    adapter.stopped(adapter.standing().run_back())


@request(requests.OfThread)
def pause(adapter: Adapter, arguments: requests.OfThread) -> None:
    """Stop where the card is."""
    if adapter.is_running:
        adapter.stopped(adapter.session.paused(arguments.thread_id - 1))
