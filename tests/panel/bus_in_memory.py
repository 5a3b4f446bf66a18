"""A bus as a panel has it, on an emulated segment in the process of the test."""

from typing import Any

from tests.fieldbus.bus_rig import OnBus

MACHINE = """
[bus]
interface = "emulated"
cycle = 2

[[axis]]
number = 0
name = "X"
counts_per_rev = 4000
drive = { mode = "exact" }

[axis.bus]
position = 0
mode = "csp"

[[axis]]
number = 1
name = "Y"
counts_per_rev = 4000
drive = { mode = "exact" }

[axis.bus]
position = 1
mode = "csp"
"""


class BusInMemory:
    """Its card lives when the test lets it; what it reports is taken each time it is asked."""

    def __init__(self, *, is_real: bool = True) -> None:
        self.rig = OnBus(MACHINE, is_real=is_real, digital=1)
        self.rig.card.advance(400)
        self.is_known = True
        self.loop: dict[str, Any] | None = None  # figures of a real-time loop

    @property
    def report(self) -> dict[str, Any] | None:
        return {**self.rig.machine.report(), "loop": self.loop} if self.is_known else None

    def reset_counters(self) -> None:
        self.rig.machine.reset_counters()

    def close(self) -> None:
        self.rig.machine.close()
