"""What the network master has to do at a tick, and when it wants to be asked again."""

from __future__ import annotations

from openacr.map.memory import Memory
from openacr.map.rows import network_master, network_slaves
from openacr.map.words import canf
from openacr.network.canopen import exchange, startup
from openacr.network.canopen.rows import SLAVES, TIMES, Master, Phase
from openacr.plant.bus import bus


def power_up(memory: Memory) -> None:
    """Begin after switching the card on."""
    startup.power_up(Master(memory))


def attend(memory: Memory) -> None:
    """Do everything that is due."""
    master = Master(memory)
    bus.follow_power(memory)
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
    exchange.receive_changes(master)
    if master.is_due(network_master.arrival_tk):
        exchange.arrive(master)
    if master.is_due(network_master.sync_tk):
        exchange.cycle(master)
    if master.is_due(network_master.health_tk):
        exchange.check_health(master)
    if master.phase is Phase.RUNNING:
        exchange.note_changes(master)


def next_tk(memory: Memory) -> float:
    """The tick at which something is due; 0 if nothing is."""
    master = Master(memory)
    times = [master.time(row) for row in TIMES]
    times += [memory.F[network_slaves.change_tk[slave]] for slave in range(SLAVES)]
    change_s = bus.next_change_s(memory)
    if change_s is not None:
        after_s = change_s - bus.now_s(memory)
        times.append(master.later_tk(after_s * 1000))
    return min((time for time in times if time), default=0.0)
