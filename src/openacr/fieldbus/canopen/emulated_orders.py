"""Orders to emulated nodes, as lines of text: levels at their terminals, and their faults."""

import math
from collections.abc import Callable
from dataclasses import dataclass

from openacr.errors import UserError
from openacr.fieldbus.canopen.asking import state_name
from openacr.fieldbus.canopen.emulated import EmulatedNode, EmulatedNodes
from openacr.map.rows import bus_nodes


@dataclass(frozen=True, slots=True)
class Order:
    """What can be ordered of a node: its arguments after the id, what it does."""

    arguments: tuple[str, ...]
    help: str
    act: Callable[[EmulatedNode, list[float]], str]

    def usage(self, name: str) -> str:
        """How it is written."""
        return " ".join([name, "NODE", *self.arguments])


class Orders:
    """Takes orders for the nodes of a bus."""

    def __init__(self, nodes: EmulatedNodes) -> None:
        self._nodes = nodes

    def command(self, text: str) -> str:
        """Do an order; what was done. UserError if it is not one."""
        if text.strip() == "state":
            return self.states()
        order, node, values = self.check(text)
        return f"node {node.id} {order.act(node, values)}"

    def check(self, text: str) -> tuple[Order, EmulatedNode, list[float]]:
        """An order, its node and its numbers; UserError if it is not one."""
        name, *given = text.split() or [""]
        order = ORDERS.get(name)
        if order is None:
            raise UserError(f"{name or 'nothing'}: the orders are {', '.join([*ORDERS, 'state'])}")
        if len(given) != 1 + len(order.arguments):
            raise UserError(f"{text}: write {order.usage(name)}")
        node, *values = (_number(each, text) for each in given)
        found = [each for each in self._nodes.nodes if each.id == node]
        if not found:
            known = ", ".join(str(each.id) for each in self._nodes.nodes)
            raise UserError(f"{text}: the nodes are {known}")
        return order, found[0], values

    def states(self) -> str:
        """A line for each node: its state, inputs and outputs that are on, analog outputs."""
        return "\n".join(_described(node) for node in self._nodes.nodes)

    @staticmethod
    def help() -> str:
        """All orders, with what they do."""
        lines = [f"{order.usage(name):28} {order.help}" for name, order in ORDERS.items()]
        return "\n".join([*lines, f"{'state':28} the state of each node"])


def _described(node: EmulatedNode) -> str:
    state = "no power" if node.state is None else state_name(node.state)
    on = [str(number) for number in range(node.outputs) if node.output(number)]
    return f"node {node.id}: {state}, outputs on: {' '.join(on) or 'none'}"


def _number(text: str, order: str) -> float:
    try:
        value = float(int(text, 0)) if text.lower().startswith("0x") else float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise UserError(f"{order}: {text} is not a number")
    return value


def _channel(node: EmulatedNode, value: float, row: tuple[int, ...], what: str) -> int:
    count = node.memory.I[row[node.place]]
    if value not in range(count):
        has = f"from 0 to {count - 1}" if count else "not there"
        raise UserError(f"node {node.id}: {what} are {has}")
    return int(value)


def _set_input(node: EmulatedNode, values: list[float]) -> str:
    number = _channel(node, values[0], bus_nodes.digital_inputs, "digital inputs")
    node.set_input(number, values[1] != 0.0)
    return f"has input {number} {'on' if values[1] else 'off'}"


def _set_analog(node: EmulatedNode, values: list[float]) -> str:
    number = _channel(node, values[0], bus_nodes.analog_inputs, "analog inputs")
    node.memory.F[bus_nodes.measured[node.place] + number] = values[1]
    return f"has {values[1]:g} at analog input {number}"


def _power(is_on: bool) -> Callable[[EmulatedNode, list[float]], str]:
    def act(node: EmulatedNode, values: list[float]) -> str:
        node.is_cut = not is_on
        return "has power" if is_on else "has no power"

    return act


def _silence(is_silent: bool) -> Callable[[EmulatedNode, list[float]], str]:
    def act(node: EmulatedNode, values: list[float]) -> str:
        node.is_disconnected = is_silent
        return "is disconnected" if is_silent else "is connected"

    return act


def _emergency(node: EmulatedNode, values: list[float]) -> str:
    code = int(values[0]) & 0xFFFF
    node.emergency(code)
    return f"reports emergency 0x{code:04X}"


ORDERS = {
    "input": Order(("NUMBER", "LEVEL"), "a digital input is on (1) or off (0)", _set_input),
    "analog": Order(("NUMBER", "VALUE"), "the value at an analog input, in its unit", _set_analog),
    "power-off": Order((), "the node has no power: its outputs are off", _power(False)),
    "power-on": Order((), "the node has power again and begins anew", _power(True)),
    "disconnect": Order((), "the node is off the cable; its outputs stay", _silence(True)),
    "connect": Order((), "the node is on the cable again", _silence(False)),
    "emergency": Order(("CODE",), "the node reports an emergency; 0 ends it", _emergency),
}
