"""The table of commands: name, role, arguments and what is done."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeVar

import msgspec

from openacr.panel.control.orders import Order, PanelError, RoleError
from openacr.panel.control.station import Station
from openacr.panel.roles import Role


class Args(msgspec.Struct, forbid_unknown_fields=True, frozen=True, kw_only=True):
    """Arguments of a command; what is not declared is refused."""


class NoArgs(Args, frozen=True):
    """A command without arguments."""


A = TypeVar("A", bound=Args)
Do = Callable[[Station, Order, Any], object]
LONGEST_WAIT_S = 0.5  # a command that moves axes is not carried out later than this


@dataclass(frozen=True, slots=True)
class Command:
    """One row of the table."""

    name: str
    role: Role
    args: type[Args]
    do: Do
    needs_control: bool
    is_motion: bool
    is_stop: bool

    @property
    def summary(self) -> str:
        """What it does, in one line."""
        return (self.do.__doc__ or "").partition("\n")[0]


COMMANDS: dict[str, Command] = {}


def command(
    name: str,
    role: Role = Role.OPERATE,
    *,
    needs_control: bool = True,
    is_motion: bool = False,
    is_stop: bool = False,
) -> Callable[[Callable[[Station, Order, A], object]], Callable[[Station, Order, A], object]]:
    """Declare a command; `is_motion`: it may begin motion, so an old one is refused.

    `is_stop`: what was received before it and may begin motion is refused: a stop overtakes it.
    """

    def declare(
        do: Callable[[Station, Order, A], object],
    ) -> Callable[[Station, Order, A], object]:
        args = do.__annotations__["args"]
        COMMANDS[name] = Command(name, role, args, do, needs_control, is_motion, is_stop)
        return do

    return declare


def carry_out(station: Station, order: Order, now_s: float) -> object:
    """Carry an order out; an error says why it is not."""
    row = COMMANDS.get(order.name)
    if row is None:
        raise PanelError("bad", f"there is no command {order.name!r}")
    if order.person.role < row.role:
        raise RoleError(row.role)
    try:
        args = msgspec.convert(order.args, row.args, strict=True)
    except msgspec.ValidationError as error:
        raise PanelError("bad", f"{order.name}: {error}") from None
    if row.is_motion and now_s - order.received_s > LONGEST_WAIT_S:
        waited_s = now_s - order.received_s
        raise PanelError("stale", f"the command waited {waited_s:.1f} s: give it again")
    if row.is_motion and order.received_s < station.stopped_s:
        raise PanelError("refused", "a stop was received after this command: give it again")
    if row.is_motion:
        station.interlocks.require_unmeasured()
    if row.is_stop:
        station.stopped_s = max(station.stopped_s, order.received_s)
        if station.times.halt(now_s):
            return None
    if row.needs_control:
        station.people.require_control(order.person.client)
    if row.is_motion:
        station.stopping.allow_motion()
    return row.do(station, order, args)
