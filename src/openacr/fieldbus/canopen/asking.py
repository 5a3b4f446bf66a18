"""Nodes of a bus asked by a tool: many at the same time, until all have answered."""

import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import TypeVar

from openacr.errors import UserError
from openacr.fieldbus.canopen.frames import (
    HIGHEST_NODE,
    OF_A_NODE,
    STATE,
    Cob,
    Frame,
    Link,
    NodeState,
)
from openacr.fieldbus.canopen.io_node import IDENTITY, PROFILE, Kind
from openacr.fieldbus.canopen.sdo import NodeError, Read, RefusedError, Script, Talk, number

PAUSE_S = 0.001
TAKEN_S = 0.2  # a frame may wait to be taken by the bus
STATE_S = 2.0  # for health reports
T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Device:
    """What a node says of itself."""

    node: int
    kind: int  # 0x1000
    name: str
    identity: dict[str, int | None]
    counts: dict[str, int]  # digital ones in bytes

    @property
    def is_io(self) -> bool:
        """Whether it is an I/O node, which a card can have."""
        return self.kind & 0xFFFF == PROFILE


class Asking:
    """A tool on a bus; UserError where nothing takes its frames."""

    def __init__(self, link: Link, pause: Callable[[float], None] = time.sleep) -> None:
        self._link, self._pause = link, pause
        self._states: dict[int, int] = {}

    def all(self, scripts: Mapping[int, Script[T]]) -> dict[int, T | NodeError]:
        """Talk with nodes by their ids; what each script returns, or why it has ended."""
        talks = {}
        for node, script in scripts.items():
            talks[node] = Talk(node, script, self._send, self._link.now_s())
            self._hear(talks)
        while not all(talk.is_over for talk in talks.values()):
            self._pause(PAUSE_S)
            self._hear(talks)
        found: dict[int, T | NodeError] = {}
        for node, talk in talks.items():
            found[node] = talk.failure if talk.failure is not None else talk.result  # type: ignore[assignment]
        return found

    def one(self, node: int, script: Script[T]) -> T:
        """Talk with one node; NodeError if it does not answer or refuses."""
        result = self.all({node: script})[node]
        if isinstance(result, NodeError):
            raise NodeError(f"node {node}: {result}")
        return result

    def scan(self) -> list[Device]:
        """All nodes that answer, by their ids; they are only read."""
        first = self.all({node: number(0x1000) for node in range(1, HIGHEST_NODE + 1)})
        there = [node for node, kind in first.items() if not isinstance(kind, NodeError)]
        devices = self.all({node: describe(node) for node in there})
        return [each for each in devices.values() if isinstance(each, Device)]

    def states(self, nodes: Iterable[int]) -> dict[int, int | None]:
        """The states that nodes report within 2 s; None for one that reports none."""
        nodes = list(nodes)
        end_s = self._link.now_s() + STATE_S
        for node in nodes:
            self._send(Frame(Cob.HEALTH + node, is_remote=True))  # guarding
        while self._link.now_s() < end_s and not all(node in self._states for node in nodes):
            self._pause(PAUSE_S)
            self._hear({})
        return {node: self._states.get(node) for node in nodes}

    def _send(self, frame: Frame) -> None:
        end_s = self._link.now_s() + TAKEN_S
        while not self._link.send(frame):
            if self._link.now_s() > end_s:
                why = self._link.trouble().failure or "is another node connected and powered?"
                raise UserError(f"CAN {self._link.name}: the bus takes no frames ({why})")
            self._pause(PAUSE_S)

    def _hear(self, talks: Mapping[int, Talk[T]]) -> None:
        now_s = self._link.now_s()
        for frame in self._link.take():
            node, kind = frame.id & OF_A_NODE, frame.id & ~OF_A_NODE
            if kind == Cob.SDO_ANSWER and node in talks:
                talks[node].hear(frame.data, now_s)
            elif kind == Cob.HEALTH and frame.data and not frame.is_remote:
                self._states[node] = frame.data[0] & STATE
        for talk in talks.values():
            talk.look(now_s)


def state_name(state: int | None) -> str:
    """A state in words."""
    if state is None:
        return "no health report"
    known = {each.value for each in NodeState}
    return NodeState(state).name.replace("_", "-") if state in known else f"state {state}"


def describe(node: int) -> Script[Device]:
    """What a node says of itself; what it does not have is left out."""
    kind = yield from number(0x1000)
    identity: dict[str, int | None] = {}
    for subindex, key in enumerate(IDENTITY, 1):
        try:
            identity[key] = yield from number(0x1018, subindex)
        except RefusedError:
            identity[key] = None
    try:
        name = (yield Read(0x1008)).partition(b"\0")[0].decode("latin-1")
    except RefusedError:
        name = ""
    counts = {}
    for bit, each in enumerate(Kind):
        if kind & 0xFFFF == PROFILE and kind >> 16 + bit & 1:
            counts[each.name.lower()] = yield from number(each.value[0])
    return Device(node, kind, name, identity, counts)
