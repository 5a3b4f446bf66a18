"""Begin and end a session."""

from __future__ import annotations

from openacr.debugger import requests
from openacr.debugger.adapter import CAPABILITIES, Adapter, Json, request
from openacr.debugger.opening import opened
from openacr.errors import UserError


@request(requests.Initialize)
def initialize(adapter: Adapter, arguments: requests.Initialize) -> Json:
    """Say what the debugger can do."""
    return CAPABILITIES


@request(requests.Launch)
def launch(adapter: Adapter, arguments: requests.Launch) -> None:
    """Load a project, the card of a journal, a part program, or connect to a card."""
    _begin(adapter, arguments)


@request(requests.Launch)
def attach(adapter: Adapter, arguments: requests.Launch) -> None:
    """Debug the programs of a card over a link, as a launch with `host` does."""
    if not arguments.host:
        raise UserError("attach: give `host`, the address of a card; a launch makes virtual ones")
    _begin(adapter, arguments)


def _begin(adapter: Adapter, arguments: requests.Launch) -> None:
    adapter.close()
    target = opened(arguments, adapter.show)
    adapter.speed = 1.0 if target.course.is_live else arguments.speed
    adapter.is_stopped_at_entry = arguments.stop_on_entry and not target.course.is_live
    adapter.begin(target)


@request(requests.Nothing)
def configuration_done(adapter: Adapter, arguments: requests.Nothing) -> None:
    """Begin to run, or stand at the beginning."""
    entry = adapter.target.course.entry()
    if adapter.is_stopped_at_entry:
        adapter.stopped(entry)
    else:
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
