"""The devices of one machine at work: each is stepped in its period, and drives its inputs."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any, Protocol

import msgspec

from openacr.errors import StoreError, UserError
from openacr.map.memory import Memory
from openacr.map.rows import machine_devices, motors
from openacr.plant import inputs
from openacr.plant.build import analogs
from openacr.plant.describe.check_devices import class_faults
from openacr.plant.describe.counts import position_of
from openacr.plant.describe.schema import Axis, DeviceTable, World
from openacr.plant.devices.device import Device, Value
from openacr.plant.devices.kinds import device_class, made
from openacr.plant.physics.drive_cy import converter_volts


class Attached:
    """One device with its wiring."""

    def __init__(
        self, memory: Memory, world: World, table: DeviceTable, folder: Path | None
    ) -> None:
        self._memory, self.table = memory, table
        found = device_class(table.kind, folder)
        for fault in class_faults((), table, found):
            raise UserError(f"{fault.text} ({fault.hint})" if fault.hint else fault.text)
        self.device = made(found, table.settings)
        self._wired = dict(self._reads(memory, world))
        self._given: dict[str, Value] = {}  # signals at the terminals of the card
        self.by_hand: dict[str, Value] = {name: kind() for name, kind in found.COMMANDS.items()}

    @property
    def free(self) -> list[str]:
        """The commands that are given by hand: nothing is wired to them."""
        return [name for name in self.device.COMMANDS if name not in self._wired]

    def step(self, dt_s: float) -> None:
        """Let a period pass; UserError if the device fails."""
        try:
            signals = dict(self.device.step(dt_s, self.commands))
        except Exception as error:
            text = f"has failed in its step: {type(error).__name__}: {error}"
            raise self._wrong(text) from error
        for name, value in signals.items():
            if self._given.get(name) != value:
                self._put(name, value)
        self._given.update(signals)

    @property
    def commands(self) -> dict[str, Value]:
        """The commands as they are now: from what is wired, or by hand."""
        return {**self.by_hand, **{name: read() for name, read in self._wired.items()}}

    @property
    def signals(self) -> dict[str, Value]:
        """The signals of the last step."""
        return dict(self._given)

    def put_back(self, device: Device, by_hand: dict[str, Value]) -> None:
        """Return to a state; the terminals are those of the same moment."""
        self.device, self.by_hand = device, by_hand
        self._given.clear()

    def _reads(self, memory: Memory, world: World) -> Iterator[tuple[str, Callable[[], Value]]]:
        """What each wired command is read from."""
        dac_step = 2.0 ** (analogs.FULL_DAC_BITS - world.card.dac_bits)
        axes = {axis.number: axis for axis in world.axis}
        for name, flag in self.table.outputs.items():
            yield name, partial(_is_on, memory, *inputs.output_place(flag))
        for name, dac in self.table.dacs.items():
            yield name, partial(converter_volts, memory.S, dac, dac_step)
        for name, number in self.table.axes.items():
            yield name, partial(_position_u, memory, axes[number])

    def _put(self, name: str, value: Any) -> None:
        kind = self.device.SIGNALS.get(name)
        if kind is None:
            known = ", ".join(self.device.SIGNALS) or "none"
            raise self._wrong(f"gives a signal {name!r}: it has {known}")
        if kind is float and not (isinstance(value, int | float) and math.isfinite(value)):
            raise self._wrong(f"gives {name} as {value!r}: it must be a finite number of volts")
        if kind is bool and name in self.table.inputs:
            inputs.drive(self._memory, self.table.inputs[name], bool(value))
        elif name in self.table.analogs:
            analogs.put_volts(self._memory, self.table.analogs[name], float(value))

    def _wrong(self, text: str) -> UserError:
        return UserError(f"the device {self.table.label} {text}")


def _is_on(memory: Memory, word: int, mask: int) -> bool:
    return memory.I[word] & mask != 0


def _position_u(memory: Memory, axis: Axis) -> float:
    return position_of(axis, memory.F[motors.position_cnt[axis.number]])


class RealDevices(Protocol):
    """What is real of a machine: drives and terminals on a bus."""

    def attend(self, tick: int) -> int:
        """Exchange signals at the end of a tick; the next tick to be called in."""


class AttachedDevices:
    """All devices of a machine; the engine calls `attend` in the tick that is due."""

    def __init__(self, memory: Memory, world: World, folder: Path | None) -> None:
        self._memory = memory
        self._all = [Attached(memory, world, table, folder) for table in world.device]
        self._real: RealDevices | None = None

    def join(self, real: RealDevices) -> None:
        """Attend real devices as well, from the next tick on, restarts of the card included."""
        self._real = real
        self.power_up()

    def __iter__(self) -> Iterator[Attached]:
        """The devices in the order of the machine file."""
        return iter(self._all)

    def power_up(self) -> None:
        """Step all devices in the first tick."""
        self._memory.F[machine_devices.due_tk] = 1.0 if self._all or self._real else 0.0

    def attend(self, tick: int, period_s: float) -> None:
        """Step the devices whose period begins at a tick; all of them begin in the first."""
        passed = tick - 1
        due_tk = math.inf
        for each in self._all:
            every_tk = max(1, round(each.table.period_s / period_s))
            if passed % every_tk == 0:
                each.step(every_tk * period_s)
            due_tk = min(due_tk, tick + every_tk - passed % every_tk)
        if self._real is not None:
            due_tk = min(due_tk, self._real.attend(tick))
        self._memory.F[machine_devices.due_tk] = due_tk

    def command(self, device: str, name: str, value: float) -> tuple[int, Value]:
        """Give a command by hand; the number of the device, and the value as it is taken.

        UserError for a device or command that does not exist, and for one that is wired.
        """
        labels = [each.table.label for each in self._all]
        if device not in labels:
            known = f"known are {', '.join(labels)}" if labels else "the machine has no devices"
            raise UserError(f"device {device!r}: {known}")
        number = labels.index(device)
        found = self._all[number]
        kind = found.device.COMMANDS.get(name)
        if kind is None or name not in found.free:
            why = "is wired to the card" if kind else "does not exist"
            known = ", ".join(found.free) or "none"
            raise UserError(f"command {name!r} of {device} {why}: by hand are given {known}")
        if not math.isfinite(value):
            raise UserError(f"command {name!r} of {device}: {value} is not a finite number")
        found.by_hand[name] = kind(value)
        return number, found.by_hand[name]

    def label(self, number: int) -> str:
        """The name of a device by its number; LookupError if there is none."""
        return self._all[number].table.label

    # --- snapshots --------------------------------------------------------------------

    def state(self) -> list[bytes]:
        """The state of each device, and what was set by hand."""
        return [msgspec.json.encode((each.device, each.by_hand)) for each in self._all]

    def restore(self, states: list[bytes]) -> None:
        """Return to a state; StoreError if it is not one of these devices."""
        if len(states) != len(self._all):
            raise StoreError(f"the snapshot has {len(states)} devices, not {len(self._all)}")
        try:
            found = [
                msgspec.json.decode(state, type=tuple[type(each.device), dict[str, bool | float]])  # type: ignore[misc]
                for each, state in zip(self._all, states, strict=True)
            ]
        except (msgspec.MsgspecError, RecursionError) as error:
            raise StoreError(f"the snapshot holds a device that cannot be read: {error}") from None
        for each, (device, by_hand) in zip(self._all, found, strict=True):
            if by_hand.keys() != each.by_hand.keys():
                raise StoreError(f"the snapshot is of another version of {each.table.label}")
            each.put_back(device, by_hand)
