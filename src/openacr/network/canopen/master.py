"""What the network master has to do at a tick, and when it wants to be asked again."""

from __future__ import annotations

from openacr.map.memory import Memory
from openacr.map.rows import network_master
from openacr.map.words import canf
from openacr.network.canopen import exchange, startup
from openacr.network.canopen.modelled import ModelledNodes
from openacr.network.canopen.rows import TIMES, Master, Phase


def made(memory: Memory) -> Master:
    """The master of a card, with the modelled nodes."""
    master = Master(memory)
    master.buses = (ModelledNodes(master),)
    return master


def attend(master: Master) -> None:
    """Do everything that is due."""
    for bus in master.buses:
        bus.attend()
    _serve_requests(master)
    if master.is_due(network_master.phase_tk):
        _end_phase(master)
    if master.phase is Phase.RUNNING:
        _run(master)


def _serve_requests(master: Master) -> None:
    """Begin with what the request flags ask for, unless it is being done."""
    flags, phase = master.flags(), master.phase
    if flags & canf.RESET_NETWORK and phase is not Phase.RESETTING:
        startup.reset(master)
    elif flags & canf.START_NETWORK and phase not in _BUSY:
        startup.start(master)


_BUSY = (Phase.INTERROGATING, Phase.RESETTING, Phase.POWER_UP)


def _end_phase(master: Master) -> None:
    if master.phase is Phase.INTERROGATING:
        startup.ask_next(master)
    else:
        startup.become_ready(master)


def _run(master: Master) -> None:
    exchange.receive(master)
    if master.is_due(network_master.sync_tk):
        exchange.cycle(master)
    if master.is_due(network_master.health_tk):
        exchange.check_health(master)
    if master.phase is Phase.RUNNING:
        exchange.note_changes(master)


def next_tk(master: Master) -> float:
    """The tick at which something is due; 0 if nothing is."""
    times = [*(master.time(row) for row in TIMES), *(bus.next_tk() for bus in master.buses)]
    return min((time for time in times if time), default=0.0)
