"""Begin and end a session."""

from __future__ import annotations

from openacr.debugger import questions, requests
from openacr.debugger.adapter import CAPABILITIES, Adapter, Json, request
from openacr.debugger.opening import opened
from openacr.debugger.session import DebugSession


@request(requests.Initialize)
def initialize(adapter: Adapter, arguments: requests.Initialize) -> Json:
    """Say what the debugger can do."""
    return CAPABILITIES


@request(requests.Launch)
def launch(adapter: Adapter, arguments: requests.Launch) -> None:
    """Load a project, or the card of a journal."""
    card, journal = opened(arguments)
    session = DebugSession(card, adapter.show)
    if journal is not None:
        last_tk = max([journal.header.tick, *(entry.tick for entry in journal.entries)])
        session.timeline.foresee(journal.entries, last_tk)
    adapter.speed = arguments.speed
    adapter.is_stopped_at_entry = arguments.stop_on_entry
    adapter.begin(session)
    for program in arguments.run:
        questions.run_program(card, program)


@request(requests.Nothing)
def configuration_done(adapter: Adapter, arguments: requests.Nothing) -> None:
    """Begin to run, or stand at the beginning."""
    if adapter.is_stopped_at_entry:
        adapter.stopped(adapter.session.entry())
    else:
        adapter.session.entry()
        adapter.resume()


@request(requests.Nothing)
def disconnect(adapter: Adapter, arguments: requests.Nothing) -> None:
    """End the session and the card."""
    adapter.is_running = False
    adapter.is_ended = True


@request(requests.Nothing)
def terminate(adapter: Adapter, arguments: requests.Nothing) -> None:
    """End the card."""
    adapter.is_running = False
    adapter.is_ended = True
    adapter.event("terminated")
