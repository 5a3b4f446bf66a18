"""Global objects: encoders that count along with others, wrap, filter, and copies of positions."""

from __future__ import annotations

from functools import partial

from openacr.basic.commands.global_objects import encoder_count
from openacr.basic.commands.value_commands import check_number
from openacr.basic.language import registry
from openacr.basic.language.grammar import Int, ParameterName, SignedParameter
from openacr.basic.language.registry import ANY
from openacr.basic.memory.saving import each, kept
from openacr.basic.vm.run import Run
from openacr.errors import CardError
from openacr.map.kinds_cy import kind_of
from openacr.map.numbers import KIND_LONG
from openacr.messages import INVALID_PARAMETER
from openacr.motion.axis import encoders

GROUP = "Global Objects"
REF = "PG Global Objects"
command = partial(registry.command, group=GROUP, ref=REF)

_LENGTH = (Int("length", optional=True),)
_FREQUENCY = (Int("frequency", optional=True),)


@command("ENC # LOCK", levels=ANY, grammar=(Int("encoder", optional=True),))
def enc_lock(run: Run, number: int, leader: int | None) -> None:
    """Let an encoder count what another one counts, or report which."""
    check_number(number, run.card.model.encoders)
    if leader is None:
        locked_to = encoders.leader(run.card, number)
        run.print("OFF" if locked_to is None else f"ENC{locked_to}")
    else:
        check_number(leader, run.card.model.encoders)
        encoders.lock(run.card, number, leader)


@command("ENC # UNLOCK", levels=ANY)
def enc_unlock(run: Run, number: int) -> None:
    """Let an encoder count alone again."""
    check_number(number, run.card.model.encoders)
    encoders.unlock(run.card, number)


@command("ENC # DST", levels=ANY, grammar=(ParameterName(optional=True),))
def enc_dst(run: Run, number: int, parameter: SignedParameter | None) -> None:
    """Copy the position of an encoder to a LONG parameter in every servo period."""
    check_number(number, run.card.model.encoders)
    if parameter is None:
        found = encoders.destination(run.card, number)
        run.print("OFF" if found is None else f"P{found}")
    elif kind_of(run.card.memory.I, parameter.number) != KIND_LONG:
        raise CardError(INVALID_PARAMETER)
    else:
        encoders.copy_to(run.card, number, parameter.number)


@command("ENC # DST OFF", levels=ANY)
def enc_dst_off(run: Run, number: int) -> None:
    """Copy the position of an encoder no longer."""
    check_number(number, run.card.model.encoders)
    encoders.copy_to(run.card, number, None)


@command("ENC # ROTARY", levels=ANY, grammar=_LENGTH, units="pulses", default="0", saved=True)
def enc_rotary(run: Run, number: int, length: int | None) -> None:
    """Wrap the position of an encoder into 0 to length - 1, or not (0); followers go on."""
    check_number(number, encoder_count(run.card))
    if length is None:
        run.print(str(encoders.turn_length(run.card, number)))
    else:
        encoders.set_turn_length(run.card, number, length)


kept["ENC # ROTARY"] = each(
    "ENC # ROTARY", encoder_count, encoders.turn_length, encoders.set_turn_length
)


@command("ENC # LIMIT", levels=ANY, grammar=_FREQUENCY, units="Hz", default="0", saved=True)
def enc_limit(run: Run, number: int, frequency: int | None) -> None:
    """Count no edges of an encoder that come quicker than this, or all (0)."""
    check_number(number, encoder_count(run.card))
    if frequency is None:
        run.print(str(encoders.edge_limit(run.card, number)))
    else:
        encoders.set_edge_limit(run.card, number, frequency)


kept["ENC # LIMIT"] = each(
    "ENC # LIMIT", encoder_count, encoders.edge_limit, encoders.set_edge_limit
)
