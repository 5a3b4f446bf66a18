"""`openacr status`: lights, drives, encoders and limits of a card at one glance."""

import json
from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated

import typer
from msgspec import Struct, to_builtins

from openacr.cli.live.monitor import axes_on
from openacr.cli.live.online import BAUD, SILENCE_S, Baud, Silence, Target, connected
from openacr.cli.live.silence import why_silent
from openacr.map import numbers as at
from openacr.map.rows import canopen as canopen_rows

if TYPE_CHECKING:
    from openacr.client import Card

BUS_STATE = canopen_rows.bus_state
SIDES = (("positive", 0), ("negative", 1))


class Limit(Struct, frozen=True):
    """A limit switch: its input, and what the card makes of it."""

    side: str
    input: int
    is_on: bool
    is_active: bool
    is_enabled: bool
    is_latched: bool


class AxisStatus(Struct, frozen=True):
    """What is to be known of an axis that does not move."""

    axis: int
    light: str
    is_enabled: bool
    is_killed: bool
    encoder_fault: bool
    encoder_lost: bool
    limits: tuple[Limit, ...]
    no_output: str  # why, empty while nothing cuts the output


class Status(Struct, frozen=True):
    """All of it."""

    power: str
    canopen: str
    motion_enable: str
    axes: tuple[AxisStatus, ...]


def status(
    target: Target,
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON object.")] = False,
    baud: Baud = BAUD,
    silence: Silence = SILENCE_S,
) -> None:
    """Show lights, drives, encoders and limit switches of a card.

    For each limit the raw input stands beside its enable bit: an input that toggles without
    effect belongs to a limit that is not enabled. Axes are those that are on.
    """
    with connected(target, baud, silence) as card:
        found = read_status(card)
    if as_json:
        typer.echo(json.dumps(to_builtins(found)))
        return
    for line in _lines(found):
        typer.echo(line)


def read_status(card: "Card") -> Status:
    """Ask the card."""
    from openacr.client.lights import bus_light, power_light

    words = card.read_many([at.P_DIAGNOSTICS, at.W_MISC_CONTROL_1, BUS_STATE])
    diagnostics, control, bus = map(int, words)
    enable = _flags(card, "card", "MISCCTL1")
    is_open, is_latched = enable["Motion Enable Input Open"], enable["Motion Enable Input Latched"]
    return Status(
        power_light(is_there=True, diagnostics=diagnostics, misc_control=control),
        bus_light(bus, is_installed=_flags(card, "network", "CAN")["CANopen Controller Installed"]),
        "open" if is_open else "latched" if is_latched else "closed",
        tuple(_axis(card, axis) for axis in axes_on(card)),
    )


def _flags(card: "Card", panel: str, thing: str) -> dict[str, bool]:
    """The flags of an object, by the rows of its status panel."""
    from openacr.client.panels import flags_of, panel_named

    numbers = flags_of(panel_named(panel), thing)
    return dict(zip(numbers, card.read_bits(list(numbers.values())), strict=True))


def _axis(card: "Card", axis: int) -> AxisStatus:
    from openacr.client.lights import axis_light

    flags = _flags(card, "axes", f"AXIS{axis}")
    encoder = _flags(card, "encoders", f"ENC{_encoder(card, axis)}")
    first = int(card.command(f"AXIS{axis} HLBIT")[0])
    inputs = card.read_bits([first, first + 1])
    is_faulty = flags["Drive Fault Input"] or flags["Drive Fault"]
    is_enabled = flags["Drive Enabled"]
    return AxisStatus(
        axis,
        axis_light(is_faulty=is_faulty, is_enabled=is_enabled),
        is_enabled,
        flags["Kill All Motion Request"],
        encoder["Encoder Signal Fault"],
        encoder["Encoder Signal Lost"],
        tuple(_limit(flags, first, side, name, inputs[side]) for name, side in SIDES),
        why_silent(card, axis),
    )


def _limit(flags: dict[str, bool], first: int, side: int, name: str, is_on: bool) -> Limit:
    limit = f"{name.capitalize()} Hardware Limit"
    return Limit(
        name,
        first + side,
        is_on,
        flags[f"{name.capitalize()} Limit Input"],
        flags[f"{limit} Enable"],
        flags[f"{limit} Encountered"],
    )


def _encoder(card: "Card", axis: int) -> int:
    """The encoder attached as position feedback of an axis; without one, the axis number."""
    words = next(
        (line.split() for line in card.command("ATTACH") if line.startswith(f"ATTACH AXIS{axis} ")),
        ["", "", ""],
    )
    feedback = words[2]
    return int(feedback[3:]) if feedback.startswith("ENC") else axis


def _lines(found: Status) -> Iterator[str]:
    yield f"power light     {found.power}"
    yield f"CANopen light   {found.canopen}"
    yield f"motion enable   {found.motion_enable}"
    for axis in found.axes:
        marks = (
            ("enabled", axis.is_enabled), ("killed", axis.is_killed),
            ("encoder fault", axis.encoder_fault), ("encoder lost", axis.encoder_lost),
            (f"no output: {axis.no_output}", axis.no_output),
        )  # fmt: skip
        said = [name for name, is_so in marks if is_so]
        yield f"axis {axis.axis}: light {axis.light}" + "".join(f", {mark}" for mark in said)
        for limit in axis.limits:
            yield (
                f"  {limit.side} limit  input {limit.input} {_on(limit.is_on)}"
                f"  active {_on(limit.is_active)}  enabled {_on(limit.is_enabled)}"
                f"  latched {_on(limit.is_latched)}"
            )


def _on(is_on: bool) -> str:
    return "1" if is_on else "0"
