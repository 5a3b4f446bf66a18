"""A card wired together with its simulated machine, its storage and its streams.

Power-up and REBOOT are here as well.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from functools import partial
from pathlib import Path

from openacr.basic.execute.control import ProgramControl
from openacr.basic.execute.executor import Executor
from openacr.basic.execute.system import System
from openacr.basic.language.plc_names import PlcNames
from openacr.basic.language.scope import Scope, join_names
from openacr.basic.memory.program_memory import PROGRAMS
from openacr.controller.inputs import InputLog
from openacr.controller.packets import PacketHost
from openacr.controller.persistence import Persistence
from openacr.controller.streams import Streams
from openacr.controller.views import Bits, Parameters
from openacr.engine.watches import give_orders, take_orders
from openacr.errors import CardError, UserError
from openacr.journal.entries import Entered
from openacr.lang.lexer import Token
from openacr.map.numbers import (
    P_CARD_SERIAL_NUMBER,
    P_FIRMWARE_VERSION,
    P_UPDATE_NUMBER,
)
from openacr.map.rows import plcs
from openacr.models import DEFAULT_MODEL, MODELS, Model
from openacr.motion.axis import drive
from openacr.motion.card import Card
from openacr.network.networks import Networks
from openacr.plant.build import apply
from openacr.plant.describe import schema
from openacr.plant.world.attached_devices import AttachedDevices
from openacr.plc.control import Plcs
from openacr.plc.reader import PlcLine, read_line
from openacr.protocol.events import ControlKey


class CardParts:
    """The parts of a virtual card, each connected to the others that it needs."""

    def __init__(
        self,
        model: str | Model = DEFAULT_MODEL,
        *,
        world: schema.World | None = None,
        data: Path | None = None,
        device_folder: Path | None = None,
    ) -> None:
        self.model = _model(model)
        self.world = world or schema.default_world(self.model)
        self.card = Card(self.model)
        self.memory, self.clock = self.card.memory, self.card.clock
        self.system = System(self.card)
        self.executor = Executor(self.system)
        self.plcs = Plcs(self.memory, self._plc_text)
        self.networks = Networks(self.memory, self._deliver)
        self.devices = AttachedDevices(self.memory, self.world, device_folder)
        self.control = ProgramControl(self.system, self.executor, self.plcs)
        self.system.control = self.control
        self.system.runner = self.executor
        self.system.reboot = self._ask_reboot
        self.system.read_plc = self._read_plc
        host = PacketHost(
            self.card,
            lambda: self.system.storage.locals.strings,
            short_overrides=self.world.card.short_override_packets,
        )
        self.streams = Streams(self.system.sessions, host, self.press)
        self.inputs = InputLog(self.clock)
        self.p = Parameters(self.memory, partial(self.inputs.note, Entered.PARAMETER))
        self.bit = Bits(self.memory, partial(self.inputs.note, Entered.FLAG))
        self._wants_reboot = False
        self._apply_world()
        self.nonvolatile = Persistence.open(self.system, data)
        self.nonvolatile.power_up()
        self._start_boot_programs()

    def press(self, key: ControlKey) -> None:
        """Act on Ctrl-X, Ctrl-Y or Ctrl-Z, typed on any stream."""
        if key is ControlKey.CTRL_Y:
            drive.clear_kills(self.card)
            return
        for program in range(PROGRAMS):
            self.executor.halt_program(program)
        for plc in range(plcs.COUNT):
            self.plcs.halt(plc)
        drive.kill_all(self.card)
        if key is ControlKey.CTRL_Z:
            drive.disable_all(self.card)

    def _apply_world(self) -> None:
        apply.apply_world(self.world, self.memory)
        self.card.set_period(self.world.card.period_s)
        self.memory.I[P_CARD_SERIAL_NUMBER] = self.model.serial_number
        self.memory.I[P_FIRMWARE_VERSION] = self.model.firmware_number
        self.memory.I[P_UPDATE_NUMBER] = self.model.update
        self.networks.power_up()
        self.devices.power_up()

    def _ask_reboot(self) -> None:
        self._wants_reboot = True

    def reboot_if_requested(self) -> bool:
        """Restart as at power-up if REBOOT was given; the world outside stays as it is."""
        if not self._wants_reboot:
            return False
        self._wants_reboot = False
        self.clock.before_tk += self.clock.tick
        for plc in range(plcs.COUNT):
            self.system.listeners.plc_changes(plc)
        orders = take_orders(self.memory)
        outside = apply.take_state(self.memory)
        self.executor.threads.reset()
        self.system.restart(keeps_memory=self.nonvolatile.battery.is_on)
        self.executor.threads.space.rebuild()  # the rows that locate the compiled code are gone
        self._apply_world()
        apply.put_state(self.memory, outside)
        give_orders(self.memory, orders)
        self.nonvolatile.restart()
        self.streams.moves.clear()
        self.streams.disconnect_all()
        self._start_boot_programs()
        return True

    def _start_boot_programs(self) -> None:
        with suppress(CardError):  # no host is connected to report it to
            self.system.start_boot_programs()

    def _plc_text(self, plc: int) -> Iterator[tuple[int, PlcLine]]:
        for line in self.system.programs.lines(PROGRAMS + plc):
            yield line.number, line.tree

    def _read_plc(self, found: list[Token], scope: Scope) -> tuple[PlcLine | None, int]:
        join_names(found, scope.numbered)
        line = read_line(found, PlcNames(scope.aliases))
        return line, line.count if line else 0

    def _deliver(self, channel: int, text: str) -> None:
        """Write text on a channel, by channel number."""
        for session in self.system.sessions.values():
            if session.index == channel:
                session.write(text)


def _model(model: str | Model) -> Model:
    if isinstance(model, Model):
        return model
    if model not in MODELS:
        raise UserError(f"controller model {model}: known are {', '.join(MODELS)}")
    return MODELS[model]
