"""The words of a scenario file: one field per key, with its limits.

Moments. An action or expectation names when it applies: `time_s` (seconds from the start),
`when` (a condition) and/or `after` (a checkpoint reached before), and `delay_s` on top of
the last two; `every` repeats an action each time its condition becomes true again. An expectation
without a moment applies at the end of the run.
"""

from enum import Enum
from typing import Annotated

from msgspec import UNSET, Meta, Struct, UnsetType

from openacr.plant.world.fault_kinds import TORQUE, VOLTS, MachineFault
from openacr.plant.world.faults import QUANTITIES

Seconds = Annotated[float, Meta(ge=0.0)]
Bit = Annotated[int, Meta(ge=0, le=32767)]
Parameter = Annotated[int, Meta(ge=0, le=65535)]
Sixteenth = Annotated[int, Meta(ge=0, le=15)]
Text = Annotated[str, Meta(min_length=1)]


class Key(Enum):
    """A control key an operator presses on a terminal."""

    ESCAPE = "escape"
    CTRL_X = "ctrl-x"
    CTRL_Y = "ctrl-y"
    CTRL_Z = "ctrl-z"

    @property
    def character(self) -> str:
        """The character the key sends."""
        return {"escape": "\x1b", "ctrl-x": "\x18", "ctrl-y": "\x19", "ctrl-z": "\x1a"}[self.value]


class State(Enum):
    """The state of a program."""

    IDLE = "idle"
    RUNNING = "running"
    DWELLING = "dwelling"
    INHIBITED = "inhibited"
    PAUSED = "paused"
    BLOCKED = "blocked"
    ERROR = "error"


class Condition(Struct, frozen=True, forbid_unknown_fields=True, rename={"is_": "is"}):
    """Something that becomes true: a bit, a value beyond a bound, a text, a program state."""

    bit: Bit | None = None
    is_: bool | None = None
    becomes: bool | None = None
    parameter: Parameter | None = None
    axis: Sixteenth | None = None
    above: float | None = None
    below: float | None = None
    printed: Text | None = None
    program: Sixteenth | None = None
    state: State | None = None


class Drag(Struct, frozen=True, forbid_unknown_fields=True):
    """Move the load of an axis by hand: by a distance in units, over a time."""

    axis: Sixteenth
    by: float
    over_s: Seconds = 0.0


class Fault(Struct, frozen=True, forbid_unknown_fields=True):
    """Cause a fault on an axis of the machine, by its number in machine.toml."""

    axis: Sixteenth
    kind: MachineFault
    at: float | None = None
    torque_nm: Annotated[float, Meta(ge=TORQUE.low)] | None = None
    volts: Annotated[float, Meta(gt=VOLTS.low)] | None = None

    @property
    def value(self) -> float:
        """The number that belongs to the kind, 0 where there is none."""
        key = QUANTITIES.get(self.kind)
        return (getattr(self, key) if key else None) or 0.0


class Mend(Struct, frozen=True, forbid_unknown_fields=True):
    """End one kind of fault of an axis, or all."""

    axis: Sixteenth
    kind: MachineFault | None = None


class Analog(Struct, frozen=True, forbid_unknown_fields=True):
    """Apply a value to an analog input, named by the parameter that shows it."""

    input: Parameter
    value: float


class Command(Struct, frozen=True, forbid_unknown_fields=True):
    """Give a command to a device of the machine by hand; `value` of a contact is true or false."""

    device: Text
    name: Text
    value: bool | float = True


class Action(Struct, frozen=True, forbid_unknown_fields=True):
    """One entry of `[[at]]`: a moment and what the operator does then."""

    time_s: Seconds | None = None
    when: Condition | None = None
    after: Text | None = None
    delay_s: Seconds = 0.0
    every: bool = False
    set: tuple[Bit, ...] = ()
    clear: tuple[Bit, ...] = ()
    release: tuple[Bit, ...] = ()
    press: tuple[Bit, ...] = ()
    press_s: Seconds = 0.1
    send: Text | None = None
    key: Key | None = None
    stream: Text | None = None
    drag: Drag | None = None
    analog: Analog | None = None
    fault: Fault | None = None
    mend: Mend | None = None
    command: Command | None = None
    checkpoint: Text | None = None


class Expectation(Struct, frozen=True, forbid_unknown_fields=True, rename={"is_": "is"}):
    """One entry of `[[expect]]`: a moment and what must hold then."""

    name: str = ""
    time_s: Seconds | None = None
    when: Condition | None = None
    after: Text | None = None
    delay_s: Seconds = 0.0
    parameter: Parameter | None = None
    flag: Bit | None = None
    is_: bool | float | UnsetType = UNSET
    above: float | None = None
    below: float | None = None
    tolerance: Annotated[float, Meta(ge=0.0)] = 0.0
    axis: Sixteenth | None = None
    position: float | None = None
    commanded: float | None = None
    program: Sixteenth | None = None
    state: State | None = None
    printed: Text | tuple[Text, ...] | None = None
    between: tuple[Text, Text] | None = None
    duration_s: Seconds | None = None


class Scenario(Struct, frozen=True, forbid_unknown_fields=True):
    """A whole scenario file."""

    duration_s: Annotated[float, Meta(gt=0.0, le=1e7)] | None = None
    at: tuple[Action, ...] = ()
    expect: tuple[Expectation, ...] = ()
