"""Bridges: what 1,000 values at 10 Hz cost over OPC UA, and what real time of a card notices."""

import asyncio
import logging
import re
import threading
import time
from collections.abc import Iterator
from concurrent.futures import Future
from contextlib import contextmanager
from multiprocessing import get_context
from multiprocessing.connection import Connection
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from asyncua import Client, ua

from bench.figures import at_most, value_only
from openacr.bridge.bridge import Bridge
from openacr.bridge.feed import Feed
from openacr.bridge.load import parse_bridge
from openacr.bridge.moment import AxisName, Moment
from openacr.bridge.process import BridgeProcess
from openacr.bridge.station_feed import StationFeed
from openacr.bridge.systems import bridge_of
from openacr.map import parameters
from openacr.panel.commands.all import carry_out
from openacr.panel.control.machine.pace import Paced
from openacr.panel.control.station import Station
from openacr.panel.control.thread import ControlThread
from openacr.panel.machine import embedded

SECONDS = 10.0
ITEMS, FEW = 1000, 50
RATE_HZ = 10.0
FIRST = 12288  # of the parameters of axes
HEAD = f"rate_hz = {RATE_HZ}\n[opcua]\nport = 0\n"
LATE = re.compile(r"([\d.]+) ms \(99 %\), ([\d.]+) ms \(worst\)")


class Changing:
    """A machine of which every value differs at every reading."""

    axes: tuple[AxisName, ...] = ()

    def __init__(self) -> None:
        self._number, self._parameters = 0.0, list[int]()

    def start(self, parameters: list[int], rate_hz: float) -> None:
        self._parameters = parameters

    def newest(self) -> Moment:
        self._number += 1.0
        return Moment(watched=dict.fromkeys(self._parameters, self._number))

    def write(self, number: int, value: float, *, is_flag: bool) -> "Future[None]":
        raise NotImplementedError

    def stop(self) -> None:
        """Nothing is read."""


def values(count: int) -> str:
    """The tables of values of this many parameters."""
    numbers = sorted(number for number in parameters() if number >= FIRST)[:count]
    rows = (f'[[value]]\nname = "v{k}"\nparameter = {n}\n' for k, n in enumerate(numbers))
    return "".join(rows)


@contextmanager
def running(feed: Feed, count: int) -> Iterator[Bridge]:
    """A bridge with an OPC UA server."""
    bridge = bridge_of(parse_bridge(HEAD + values(count)), Path(), feed)
    bridge.start()
    try:
        yield bridge
    finally:
        bridge.stop()


def _cpu_s() -> float:
    """The processor time of the thread of the bridge."""
    thread = next(each for each in threading.enumerate() if each.name == Bridge.__name__)
    return time.clock_gettime(time.pthread_getcpuclockid(thread.ident or 0))


def _percent(work: Any) -> float:
    before_s, began_s = _cpu_s(), time.monotonic()
    work()
    return 100.0 * (_cpu_s() - before_s) / (time.monotonic() - began_s)


async def _subscribe(place: str, to_bench: Connection) -> None:
    """Subscribe all values as a host does, and count the changes while the bench measures."""
    count = 0

    class Handler:
        def datachange_notification(self, _node: Any, _value: Any, _data: Any) -> None:
            nonlocal count
            count += 1

    async with Client(place, timeout=60) as client:
        subscription = await client.create_subscription(1000.0 / RATE_HZ, Handler())
        nodes = [client.get_node(ua.NodeId(f"user.v{k}", 2)) for k in range(ITEMS)]
        await subscription.subscribe_data_change(nodes)
        count = 0
        to_bench.send(count)
        await asyncio.to_thread(to_bench.recv)
        to_bench.send(count)
        await subscription.delete()


def _host(place: str, to_bench: Connection) -> None:
    logging.disable()  # the client of the library logs every end
    asyncio.run(_subscribe(place, to_bench))


@contextmanager
def _subscribed(place: str) -> Iterator[Connection]:
    """A host in a process of its own, as it would be: it takes no time of the interpreter."""
    processes = get_context("spawn")
    to_host, to_bench = processes.Pipe()
    host = processes.Process(target=_host, args=(place, to_bench), daemon=True)
    host.start()
    to_host.recv()
    yield to_host
    host.join()


def _late_ms(count: int | None) -> tuple[float, float]:
    """How late the virtual mill is, 99 % and worst, beside a bridge of this many values."""
    with TemporaryDirectory() as folder:
        installation = embedded(Path(folder))
        control = ControlThread(Station(installation, carry_out))
        control.start()
        time.sleep(3.0)
        if count is None:
            time.sleep(SECONDS)
        else:
            bridge = BridgeProcess(parse_bridge(HEAD + values(count)), Path(), StationFeed(control))
            bridge.start()
            time.sleep(SECONDS)
            bridge.stop()
        control.stop()
        pace = installation.pace
        found = LATE.search(pace.report() if isinstance(pace, Paced) else "")
        installation.close()
    if found is None:
        raise RuntimeError("the pace says nothing")
    return float(found[1]), float(found[2])


def main() -> None:
    with running(Changing(), ITEMS) as bridge:
        place = bridge.places[0].split(" ", 1)[1]
        used = _percent(lambda: time.sleep(SECONDS))
        with _subscribed(place) as host:
            began_s = time.monotonic()
            served = _percent(lambda: time.sleep(SECONDS))
            host.send(None)
            changes_hz = host.recv() / (time.monotonic() - began_s)
    at_most(f"bridge: {ITEMS} OPC UA items at {RATE_HZ:g} Hz", used, 15.0, "% core")
    at_most("bridge: the same, all subscribed by a host", served, 25.0, "% core")
    value_only("bridge: changes the host got", changes_hz, "1/s")
    for name, count in (
        ("without a bridge", None),
        (f"with a bridge of {FEW} values", FEW),
        (f"with a bridge of {ITEMS} values", ITEMS),
    ):
        late_ms, worst_ms = _late_ms(count)
        value_only(f"virtual mill {name}: late (99 %)", late_ms, "ms")
        value_only(f"virtual mill {name}: late (worst)", worst_ms, "ms")


if __name__ == "__main__":
    main()
