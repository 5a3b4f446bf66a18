"""`openacr mill stop` on a served card, over TCP and a serial line: it stops what others move."""

from pathlib import Path

import pytest
from tests.mill.live import Plant, serial_line
from tests.waiting import until

from openacr.client import Card

LINK_TIMEOUT = 250_126
LOOP = ("PROGRAM", "_again", "X3", "X0", "GOTO again", "ENDP")
SETUP = (
    "ATTACH MASTER0", 'ATTACH SLAVE0 AXIS0 "X"', "PPU X1000", "DRIVE ON X",
    "ACC 20 DEC 20 STP 20 VEL 1", *LOOP,
)  # fmt: skip


def begin(card: Card) -> None:
    for line in SETUP:
        card.command(line, program=0)
    card.run(0)


@pytest.mark.parametrize("is_serial", [False, True])
def test_a_program_of_another_host_stops_over_each_link(tmp_path: Path, is_serial: bool) -> None:
    with serial_line() as (near, far):
        plant = Plant(tmp_path, *(("--serial", far) if is_serial else ()))
        try:
            plant.wire({LINK_TIMEOUT: 60.0})
            begin(plant.card)
            until(lambda: plant.is_moving)
            stop = plant.mill("stop", host=near if is_serial else "")
            assert stop.ended() == 0
            assert "stopped: PROG0 halted" in stop.text
            assert not plant.is_moving
            place = plant.places()
            plant.card.pause(0.5)
            assert plant.places() == place
        finally:
            plant.close()
