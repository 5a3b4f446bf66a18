"""Global objects: encoders that count along with others, and copies of their positions."""

from __future__ import annotations

from openacr.basic.grammar import Int, ParameterName, SignedParameter
from openacr.basic.registry import ANY, command
from openacr.basic.run import Run
from openacr.basic.value_commands import check_number
from openacr.errors import CardError
from openacr.map.kinds_cy import kind_of
from openacr.map.numbers import KIND_LONG
from openacr.messages import INVALID_PARAMETER
from openacr.motion import encoders

GROUP = "Global Objects"
REF = "PG Global Objects"


@command("ENC # LOCK", group=GROUP, levels=ANY, grammar=(Int("encoder", optional=True),), ref=REF)
def enc_lock(run: Run, number: int, leader: int | None) -> None:
    """Let an encoder count what another one counts, or report which."""
    check_number(number, run.card.model.encoders)
    if leader is None:
        locked_to = encoders.leader(run.card, number)
        run.print("OFF" if locked_to is None else f"ENC{locked_to}")
    else:
        check_number(leader, run.card.model.encoders)
        encoders.lock(run.card, number, leader)


@command("ENC # UNLOCK", group=GROUP, levels=ANY, ref=REF)
def enc_unlock(run: Run, number: int) -> None:
    """Let an encoder count alone again."""
    check_number(number, run.card.model.encoders)
    encoders.unlock(run.card, number)


@command("ENC # DST", group=GROUP, levels=ANY, grammar=(ParameterName(optional=True),), ref=REF)
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


@command("ENC # DST OFF", group=GROUP, levels=ANY, ref=REF)
def enc_dst_off(run: Run, number: int) -> None:
    """Copy the position of an encoder no longer."""
    check_number(number, run.card.model.encoders)
    encoders.copy_to(run.card, number, None)
