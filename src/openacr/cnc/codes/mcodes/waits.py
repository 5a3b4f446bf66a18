"""M100 to M299: waits for software relays."""

from __future__ import annotations

from typing import TYPE_CHECKING

from openacr.cnc.canonical import Say, WaitBit
from openacr.cnc.codes.table import Step
from openacr.cnc.codes.tables import ACROMILL
from openacr.cnc.occupied import FIRST_RELAY, RELAYS

if TYPE_CHECKING:
    from openacr.cnc.codes.run import Run
    from openacr.cnc.program.block_context import BlockContext

FIRST_ON, FIRST_OFF = 100, 200


@ACROMILL.mcode(*range(FIRST_ON, FIRST_OFF + RELAYS), step=Step.SWITCHES)
def wait_for_relay(run: Run, b: BlockContext) -> None:
    """M1xx waits until relay xx is on, M2xx until it is off."""
    relay, is_on = int(b.number) % RELAYS, b.number < FIRST_OFF
    name = f"M{b.number:g}"
    if run.options.is_dry:
        run.tell(Say(b.source, f"{name}: wait left out"))
        return
    state = "on" if is_on else "off"
    run.tell(WaitBit(b.source, FIRST_RELAY + relay, is_on, f"{name}: relay {relay} {state}"))
