"""The parameters ESAVE keeps: how each is taken from a card and put back.

Commands made from rows with a `Setting` enter themselves (`saving.keep`), the others stand
in a table here. Order matters when all are put back: the servo period before the filters that
follow from it, attachments before what belongs to a master.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from openacr.basic.memory.saved_flags import saved_beside_commands
from openacr.basic.memory.saving import Saved, each, kept
from openacr.errors import CardError
from openacr.kernel.sources import source_cy
from openacr.map import numbers as at
from openacr.map.rows import axes, canopen, canopen_adcs, canopen_dacs, canopen_nodes, kernel
from openacr.map.rows import masters as master_rows
from openacr.map.words import mf2
from openacr.messages import INVALID_ARGUMENT
from openacr.motion.axis import attach, filters, maintenance, settings
from openacr.motion.card import SLAVES, Card
from openacr.motion.path import buffer
from openacr.motion.sources import sources, time_base

if TYPE_CHECKING:
    from openacr.basic.execute.system import System
    from openacr.motion.axis.settings import LimitEnables

STREAM_MODES = (at.P_COM1_STARTUP_MODE, at.P_COM2_STARTUP_MODE)
_NETWORK = range(canopen.parameters, canopen.number_of_analog_outputs + 1)
_SCALES = (
    canopen_dacs.dac_gain,
    canopen_dacs.dac_offset,
    canopen_adcs.adc_gain,
    canopen_adcs.adc_offset,
)


def _numbered(rows: list[Any], count: int) -> Iterator[tuple[int, Any]]:
    yield from enumerate(rows[:count])


def all_saved() -> Iterator[Saved]:
    """Everything in the order in which it is put back."""
    yield _PERIOD
    yield from kept.values()
    yield from _TABLE
    yield from saved_beside_commands()


def take(system: System) -> dict[str, Any]:
    """The parameters of a card as they are now, by command."""
    return {item.words: item.take(system) for item in all_saved()}


def put(system: System, image: dict[str, Any]) -> list[str]:
    """Bring parameters back; what this card does not take is left out and listed."""
    refused = []
    for item in all_saved():
        if item.words in image:
            try:
                item.put(system, image[item.words])
            except (CardError, ValueError, TypeError, LookupError) as error:
                refused.append(f"{item.words}: {error}")
    return refused


def take_stream_modes(system: System) -> list[int]:
    """Start-up modes of the serial streams, which ERASE leaves alone."""
    return [system.card.memory.I[number] for number in STREAM_MODES]


def put_stream_modes(system: System, modes: list[int]) -> None:
    """Bring the start-up modes back."""
    for number, mode in zip(STREAM_MODES, modes, strict=True):
        system.card.memory.write(number, mode)


# one axis at a time


def _per_axis(
    words: str, read: Callable[[Card, int], Any], write: Callable[[Card, int, Any], None]
) -> Saved:
    return each(words, lambda card: card.model.axes, read, write)


def _per_master(
    words: str, read: Callable[[Card, int], Any], write: Callable[[Card, int, Any], None]
) -> Saved:
    return each(words, lambda card: card.model.masters, read, write)


def _limit_mode(words: str, enables: LimitEnables) -> Saved:
    return _per_axis(words, enables.read, enables.write)


def _write_notch(card: Card, axis: int, value: list[float]) -> None:
    filters.set_notch(card, axis, *value)


def _write_axis_on(card: Card, axis: int, on: bool) -> None:
    if settings.is_axis_on(card, axis) != on:
        settings.set_axis_on(card, axis, on)


def _sources(card: Card, axis: int) -> list[int]:
    return [card.memory.I[row[axis]] for row in _SOURCE_ROWS]


def _write_sources(card: Card, axis: int, values: list[int]) -> None:
    place, index, signal, channel, velocity, other = values
    attach.axis(
        card,
        axis,
        (attach.Feedback(place), index),
        (attach.Signal(signal), channel),
        (attach.Feedback(velocity), other),
    )


_SOURCE_ROWS = (
    axes.position_source,
    axes.position_index,
    axes.signal_source,
    axes.signal_index,
    axes.velocity_source,
    axes.velocity_index,
)


def _read_move_time(card: Card, master: int) -> list[float]:
    is_on = bool(card.memory.I[mf2.word[master]] & mf2.MASTER_IN_TMOV)
    return [card.memory.S[master_rows.move_time[master]], is_on]


def _write_move_time(card: Card, master: int, value: list[float]) -> None:
    time_s, is_on = value
    time_base.set_move_time(card, master, time_s)
    time_base.switch_move_time(card, master, on=bool(is_on))


def _read_angles(card: Card, master: int) -> list[float]:
    return list(buffer.look_angles(card, master))


def _write_angles(card: Card, master: int, angles: list[float]) -> None:
    buffer.set_look_angles(card, master, *angles)


def _write_source(card: Card, master: int, text: str) -> None:
    if text != time_base.source_text(card, master):
        word = text.rstrip("0123456789")
        time_base.set_source(card, master, word, int(text.removeprefix(word) or -1))


# masters and slaves


def _take_masters(system: System) -> list[tuple[int, int]]:
    attachments = system.card.attachments
    found = ((program, attachments.master(program)) for program in _programs(system))
    return [(program, master) for program, master in found if master is not None]


def _programs(system: System) -> range:
    return range(system.card.model.programs)


def _put_masters(system: System, masters: list[tuple[int, int]]) -> None:
    attach.detach_all(system.card)
    for program, master in masters:
        attach.master(system.card, program, master)


def _take_slaves(system: System) -> list[tuple[int, int, int, str]]:
    return [
        (program, slave.number, slave.axis, slave.name)
        for program in _programs(system)
        for slave in system.card.attachments.slaves(program)
    ]


def _put_slaves(system: System, slaves: list[tuple[int, int, int, str]]) -> None:
    for program, number, axis, name in slaves:
        attach.slave(system.card, program, number, axis, name)


def _take_weights(system: System) -> list[list[float]]:
    first = [master_rows.vecdef[number] for number in range(system.card.model.masters)]
    return [list(system.card.memory.F[start : start + SLAVES]) for start in first]


def _put_weights(system: System, rows: list[list[float]]) -> None:
    for master, weights in _numbered(rows, system.card.model.masters):
        start = master_rows.vecdef[master]
        for slave, weight in _numbered(weights, SLAVES):
            if not weight >= 0.0:
                raise CardError(INVALID_ARGUMENT)
            system.card.memory.F[start + slave] = weight


# what gears, cams and tables follow


def _followed(words: str, use: int) -> Saved:
    def read(card: Card, axis: int) -> list[int]:
        return sources.connection(card, sources.axis_tap(axis, use))

    def write(card: Card, axis: int, connection: list[int]) -> None:
        kind, index = connection
        if read(card, axis) != [kind, index]:
            sources.connect(card, axis, use, kind, index)

    return _per_axis(words, read, write)


# the card as a whole


def _row(words: str, row: int, highest: Callable[[Card], int]) -> Saved:
    def put(system: System, value: int) -> None:
        if not 0 <= value <= highest(system.card):
            raise CardError(INVALID_ARGUMENT)
        system.card.memory.I[row] = value

    return Saved(words, lambda system: system.card.memory.I[row], put)


def _put_config(system: System, modules: list[str]) -> None:
    system.setup.configure(tuple(modules))


def _put_addresses(system: System, addresses: dict[str, str]) -> None:
    for name in ("MASK", "IP", "GATE"):  # the host address is checked against the mask
        system.setup.set_address(name, addresses[name])


def _canopen_numbers() -> list[int]:
    """The network with what was found on it, the ids of the nodes, all gains and offsets."""
    scales = (row[channel] for channel in range(canopen_dacs.COUNT) for row in _SCALES)
    return [*_NETWORK, *canopen_nodes.node_id, *scales]


def _take_canopen(system: System) -> dict[int, float]:
    return {number: system.card.memory.read(number) for number in _canopen_numbers()}


def _put_canopen(system: System, values: dict[int, float]) -> None:
    for number in _canopen_numbers():
        with suppress(KeyError):
            system.card.memory.write(number, values[number])


_PERIOD = Saved(
    "PERIOD",
    lambda system: system.card.clock.period_s,
    lambda system, period_s: filters.change_period(system.card, period_s),
)
_TABLE = (
    _per_axis("NOTCH", lambda card, axis: list(filters.notch_hz(card, axis)), _write_notch),
    _limit_mode("HLIM", settings.HARD_LIMITS),
    _limit_mode("SLIM", settings.SOFT_LIMITS),
    _per_axis("ATTACH AXIS #", _sources, _write_sources),
    Saved("ATTACH MASTER #", _take_masters, _put_masters),
    Saved("ATTACH SLAVE #", _take_slaves, _put_slaves),
    _per_axis("MAXVEL", settings.MAX_VELOCITY.read, settings.set_max_velocity),
    Saved("VECDEF", _take_weights, _put_weights),
    _per_master("TMOV", _read_move_time, _write_move_time),
    _per_master("LOOK", buffer.looks, lambda card, m, on: buffer.switch_look(card, m, on=on)),
    _per_master("LOOK ANG", _read_angles, _write_angles),
    _per_master("SRC", time_base.source_text, _write_source),
    _per_axis("PM ON", maintenance.is_on, lambda card, a, on: maintenance.switch(card, a, on=on)),
    _per_axis("AXIS # ON", settings.is_axis_on, _write_axis_on),
    _row("ADC MODE", kernel.adc_mode, lambda card: 1),
    _row("ADC MAX", kernel.adc_channels, lambda card: card.model.adcs),
    Saved("CONFIG", lambda system: list(system.setup.config), _put_config),
    Saved("IP", lambda system: dict(system.setup.addresses), _put_addresses),
    Saved("CANopen", _take_canopen, _put_canopen),
    _followed("GEAR SRC", source_cy.USE_GEAR),
    _followed("CAM SRC", source_cy.USE_CAM),
    _followed("BSC SRC", source_cy.USE_BALLSCREW),
    _followed("HDW SRC", source_cy.USE_WHEEL),
    _followed("JOG SRC", source_cy.USE_JOG),
)
