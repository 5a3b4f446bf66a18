"""Lives of a whole card: what is typed, switched and pressed at which tick.

Run as a module it prints the digests of all of them, so that another process (and build)
can live them too:  python -m tests.parity.journeys
"""

import json
import random
from collections.abc import Iterator

from openacr.controller import Controller
from openacr.plant.describe.load import parse_world
from openacr.protocol.events import ControlKey

WORLD = """
[card]
model = "ACR9000"

[[axis]]
number = 0
counts_per_rev = 4000
marker = 0.3
drive = { mode = "ideal", revs_per_s_per_volt = 25.0, lag_s = 0.001 }
home = { between = [0.1, 0.2] }
positive_limit = { at = 0.6 }

[[axis]]
number = 1
counts_per_rev = 4000
motor = { inertia_kgm2 = 2e-5, torque_nm_per_a = 0.5 }
drive = { mode = "torque", amps_per_volt = 0.3, peak_amps = 20.0, fault_input = 20 }
load = { coulomb_nm = 0.01, viscous_nms = 1e-4 }

[[axis]]
number = 3
counts_per_rev = 4000
motor = { inertia_kgm2 = 2e-5, torque_nm_per_a = 0.5, pole_pairs = 2, electrical_zero_deg = 30.0 }
drive = { mode = "phases", dacs = [3, 4], amps_per_volt = 0.3, peak_amps = 20.0 }
load = { coulomb_nm = 0.01, viscous_nms = 1e-4 }

[[analog]]
input = 1
axis = 0
volts_per_unit = 2.5

[[analog]]
input = 2
dac = 1
"""
SET_UP = (
    "SYS", "HALT ALL", "NEW ALL", "DETACH ALL", "DIM P(10)", "DIM PROG0(4000)",
    "DIM PROG1(4000)", "PROG0",
    "ATTACH MASTER0", 'ATTACH SLAVE0 AXIS0 "X"', 'ATTACH SLAVE1 AXIS1 "Y"',
    'ATTACH SLAVE2 AXIS2 "Z"',
    "PPU X4000 Y4000", "MULT X4 Y4", "PGAIN Y0.01", "DGAIN Y0.0001",
    "ACC 50 DEC 50 STP 50 VEL 5", "JOG ACC X50 Y50", "JOG DEC X50 Y50", "JOG VEL X2 Y3",
)  # fmt: skip
Step = str | ControlKey | int | tuple[int, bool]

JOURNEYS: dict[str, tuple[Step, ...]] = {
    "moves": (
        "X0.2 Y0.1", 40, "X0.3", "FOV 0.5", 190, "JRK 2000", "X0 Y0", 90, "SET 520", 110,
        "SET 521", 150,
    ),
    "curves": (
        "P8228=0.125", "SPLINE MODE 0", "X0.1", "X0.2 Y0.1", "X0.1 Y0.2", "X0 Y0.1", 90, "X0 Y0",
        "SPLINE END", 300, "NURB MODE 1", "NURB RANK 3", "X0 Y0 NW 2", "X0.2 Y0", "X0.2 Y0.2",
        "X0 Y0.3 NK -2", 200,
    ),
    "joints": (
        "PROG1", "PROGRAM", "P12361=SIN(P12360*9)", "P12617=COS(P12360)*P12616", "ENDP", "PROG0",
        "INVK PROG1", "INVK ON", "X0.2 Y0.1", 160, "JRK 2000", "X0.1", 200, "INVK OFF", "X0.1", 90,
    ),
    "together": (
        "TANG ON Z", "CIRCCW X(0,0.1) Y(0,0)", 200, "TANG OFF", "PROG2", "ATTACH MASTER2",
        'ATTACH SLAVE0 AXIS3 "A"', "ACC 50 DEC 50 STP 50 VEL 5", "SYNC ON MASTER0 MASTER2", "A1",
        30, "PROG0", "X0.2", 200,
    ),
    "jogs": (
        "JOG FWD X", 60, "JOG REV Y", 50, "JOG VEL X1", 40, "JOG OFF X Y", 50, "JOG ABS X0.1 Y0",
        120, "JOG INC X-0.05", 60,
    ),
    "homing": ("SET 16152", "JOG HOMVF X1", "JOG HOME X1", 200, 250, "MSEEK X(1,0)", 250),
    "faults": (
        "SET 16148", "HLDEC X100 Y100", "SET 8500", "DRIVE ON Y", 40, "JOG FWD X", "Y0.2", 120,
        (20, True), 60, (20, False), ControlKey.CTRL_Y, 10, "DRIVE ON Y", 40, "JOG FWD Y", 30,
        ControlKey.CTRL_X, 60,
    ),
    "programs": (
        "PROGRAM", "P0=0", "_LOOP", "X/0.01", "INH -516", "P0=P0+SQRT(2)",
        "IF (P0<9) THEN GOTO LOOP", "ENDP", "PROG1", "PROGRAM", "DIM LV(2)", "_AGAIN", "LV0=LV0+1",
        "P1=SIN(LV0)*P6916",
        "DWL 0.005", "GOTO AGAIN", "ENDP", "RUN", "PROG0", "RUN", 300, "HALT PROG1", 60,
    ),
    "encoders": (
        "ENC0 ROTARY 300", "ENC1 LIMIT 9000", "ENC5 LOCK 0", "ADC POS 0 1", "ADC NEG 0 2",
        "AXIS4 OFF", "ATTACH AXIS3 ENC3 CMT0", "CMT0 ENC3 ENC3", "CMT0 DAC3 DAC4", "CMT0 PPR 1000",
        "ENC3 MULT 4", "CMT0 ERPMR 2", "CMT0 SHIFT 167", "CMT0 MODE 1", "CMT0 ON",
        "AXIS3 JOG ACC 9000", "AXIS3 JOG VEL 3000", "AXIS3 JOG FWD", "X0.2 Y0.1", 150, "ENC5 RES 7",
        "ENC0 LIMIT 3000", "X0 Y0.2", 120, "RES X1", "ENC1 LIMIT 0", "ENC0 ROTARY 0", 60,
    ),
    "filters": (
        "LOPASS Y200", "NOTCH Y(100,50)", "FFVEL Y0.0001", "IGAIN Y0.1", "ILIMIT Y1", "SET 786",
        "X0.1 Y0.3", 250, "P12545=1000", 60, "EXC Y0.0001", 110,
    ),
}  # fmt: skip


def card() -> Controller:
    """A card with two motors, set up at program level."""
    made = Controller(world=parse_world(WORLD))
    made.send("\r")
    for line in SET_UP:
        made.send(line + "\r")
        made.advance(2)
    return made


def take(made: Controller, step: Step) -> None:
    """Live one step."""
    if isinstance(step, str):
        made.send(step + "\r")
        made.advance(1)
    elif isinstance(step, ControlKey):
        made.press(step)
    elif isinstance(step, int):
        made.advance(step)
    else:
        made.set_input(*step)


def live(name: str) -> Iterator[str]:
    """Digest of the card after every step of a journey."""
    made = card()
    for step in JOURNEYS[name]:
        take(made, step)
        yield made.digest()


def random_split(ticks: int, seed: int) -> list[int]:
    """`ticks` in pieces of random lengths."""
    pieces, source = [], random.Random(seed)
    while ticks > 0:
        pieces.append(min(ticks, source.randrange(1, 60)))
        ticks -= pieces[-1]
    return pieces


if __name__ == "__main__":
    print(json.dumps({name: list(live(name)) for name in JOURNEYS}))
