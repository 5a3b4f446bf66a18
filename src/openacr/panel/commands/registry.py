"""The table of commands: a decorated function is one command of the panel, whole.

```python
@command("spindle.off", en="SPINDLE OFF", de="SPINDEL AUS")
def spindle_off(machine: MillSession, *, at_once: bool = False) -> None:
    '''Switch the spindle off.'''
```

Before the `*` it names the parts of the station that it needs, after it the arguments of the
command with their types and limits. The WebSocket, `POST /api/commands/spindle.off`, OpenAPI, HELP
and the texts of the screens follow from it.
"""

import inspect
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeVar, cast

import msgspec

from openacr.panel.control.operator.orders import Order, PanelError, RoleError
from openacr.panel.control.station import Station
from openacr.panel.helps import Page
from openacr.panel.roles import Role

Do = Callable[..., object]
D = TypeVar("D", bound=Do)
LONGEST_WAIT_S = 0.5  # a command that moves axes is not carried out later than this
# What a command may need beside the parts of the station, which have their own names.
NEEDS: dict[str, Callable[[Station, Order], object]] = {
    "station": lambda station, _order: station,
    "order": lambda _station, order: order,
    "person": lambda _station, order: order.person,
    "client": lambda _station, order: order.person.client,
    "session": lambda station, _order: station.link.required,
    "machine": lambda station, _order: station.link.machine,
}


class Args(msgspec.Struct, forbid_unknown_fields=True, frozen=True, kw_only=True):
    """Arguments of a command; what is not declared is refused."""


@dataclass(frozen=True, slots=True)
class Command:
    """One row of the table."""

    name: str
    role: Role
    do: Do
    args: type[Args]
    needs: tuple[str, ...]
    titles: dict[str, str]  # by language; without any no screen names it
    page: Page | None  # of HELP, for operators
    needs_control: bool
    is_motion: bool
    is_stop: bool

    @property
    def text(self) -> str:
        """What it does, for those who give it by a script."""
        return inspect.getdoc(self.do) or ""

    @property
    def summary(self) -> str:
        """What it does, in one line."""
        return self.text.partition("\n")[0]

    @property
    def more(self) -> str:
        """What there is to know beside that; empty for most."""
        return self.text.partition("\n")[2].strip()

    def carry_out(self, station: Station, order: Order, args: Args) -> object:
        """Call the function with what it needs; UserError where the machine is out of reach."""
        needed = [
            NEEDS[name](station, order) if name in NEEDS else getattr(station, name)
            for name in self.needs
        ]
        return self.do(*needed, **{name: getattr(args, name) for name in args.__struct_fields__})


COMMANDS: dict[str, Command] = {}


def command(
    name: str,
    role: Role = Role.OPERATE,
    *,
    en: str = "",
    de: str = "",
    page: Page | None = None,
    needs_control: bool = True,
    is_motion: bool = False,
    is_stop: bool = False,
) -> Callable[[D], D]:
    """Declare a command; `en` and `de`: how a key names it, the text `name` of the screens.

    `is_motion`: it may begin motion, so an old one is refused. `is_stop`: what was received
    before it and may begin motion is refused: a stop overtakes it. ValueError for a name that is
    taken, and for a title in one language only.
    """
    if bool(en) != bool(de):
        raise ValueError(f"{name}: a title is given in every language, or in none")
    titles = {"en": en, "de": de} if en else {}

    def declare(do: D) -> D:
        if name in COMMANDS:
            raise ValueError(f"there are two commands {name!r}")
        needs, args = _taken(name, do)
        COMMANDS[name] = Command(
            name, role, do, args, needs, titles, page, needs_control, is_motion, is_stop
        )
        return do

    return declare


def _taken(name: str, do: Do) -> tuple[tuple[str, ...], type[Args]]:
    """What a function needs, and the arguments of its command as a type that checks them."""
    needs: list[str] = []
    fields: list[Any] = []
    for each in inspect.signature(do, eval_str=True).parameters.values():
        if each.kind is not each.KEYWORD_ONLY:
            needs.append(each.name)
        elif each.default is each.empty:
            fields.append((each.name, each.annotation))
        else:
            fields.append((each.name, each.annotation, each.default))
    title = "".join(word.capitalize() for word in name.split("."))
    args = msgspec.defstruct(
        title,
        fields,
        bases=(Args,),
        module=do.__module__,
        frozen=True,
        kw_only=True,
        forbid_unknown_fields=True,
    )
    return tuple(needs), cast(type[Args], args)


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
    return row.carry_out(station, order, args)
