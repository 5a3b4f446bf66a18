"""Soft limits on the card: a second barrier in case the host sends an axis beyond its limits.

The host checks every move and jog before sending it. The card (SLM) stops what passes that check
one pulse beyond the limit, so that a move exactly to the limit does not meet it. As on the
host, the limits act only on homed axes, and not while the maintenance key is turned.
"""

from collections.abc import Iterable, Iterator

from openacr.client import Card
from openacr.client.values import number_text
from openacr.map.words import af5
from openacr.mill.card.driver import CardState, flag_of
from openacr.mill.card.machine_io import MachineIo
from openacr.mill.config.settings import Settings
from openacr.mill.config.tabs import AxisSettings

MARGIN_CNT = 1.0
ENABLES = (af5.POSITIVE_SOFTWARE_LIMIT_ENABLE, af5.NEGATIVE_SOFTWARE_LIMIT_ENABLE)
ENABLED = ENABLES[0] | ENABLES[1]


def lines(axis: AxisSettings, dec_ups2: float) -> Iterator[str]:
    """Commands that set the limits of one axis and their stop ramp, without enabling them."""
    word = f"AXIS{axis.index}"
    yield f"{word} SLIM 0"
    if axis.soft_limits is None:
        return
    margin_u = MARGIN_CNT / abs(axis.pulses_per_unit)
    high, low = axis.soft_limits
    yield f"{word} SLM ({number_text(high + margin_u)},{number_text(low - margin_u)})"
    yield f"{word} SLDEC {number_text(dec_ups2)}"


def update(io: MachineIo, sample: CardState) -> None:
    """Enable the limits of homed axes that have limits, unless the maintenance key is turned."""
    settings, is_turned = io.settings, io.is_key_turned(sample)
    for axis, word in zip(settings.axes, sample.limits, strict=True):
        is_limited = axis.soft_limits is not None and settings.is_homed(axis.index)
        required = ENABLED if is_limited and not is_turned else 0
        if word & ENABLED != required:
            _switch(io, axis.index, bool(required))


def disable(io: MachineIo, axis: int) -> None:
    """Disable the limits of an axis at once: its position is no longer valid."""
    _switch(io, axis, False)


def _switch(io: MachineIo, axis: int, on: bool) -> None:
    for mask in ENABLES:
        io.machine.set_flag(flag_of(af5.word[axis], mask), on)


def found(card: Card, settings: Settings) -> list[str]:
    """Read the present limits as the commands that restore them."""
    program = settings.master
    return [
        f"AXIS{axis.index} {word} {_value(card, f'AXIS{axis.index} {word}', program)}"
        for axis in settings.axes
        for word in ("SLM", "SLDEC", "SLIM")
    ]


def _value(card: Card, query: str, program: int) -> str:
    text = card.command(query, program=program)[0].strip()
    return f"({text})" if "," in text else text


def restore(card: Card, settings: Settings, found_lines: Iterable[str]) -> None:
    """Restore the limits found before the set-up."""
    for line in found_lines:
        card.command(line, program=settings.master)
