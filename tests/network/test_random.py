"""Random lives of cards with both networks: nothing raises, and each can be lived again."""

import random
from contextlib import suppress

import pytest
from tests.network import talk
from tests.network.rig import DI, card, fault, node

from openacr.controller import Controller
from openacr.errors import UserError

PARAMETERS = (*range(32768, 32774), *range(33024, 33031), 33040, 33056, 28672, 28673, 28676, 28928)
VALUES = (0, 1, 2, 3, 4, 5, 50, 125, 1000, -1, 2**31 - 1, -(2**31), 1e30)
FLAGS = (11265, 11266, *range(10496, 10530), 11104, 11072)
LINES = (
    "DTALK AXIS0\r",
    "TPE\r",
    "\x1b",
    "CLOSE #1\r",
    'OPEN DTALK "COM2:9600" AS #1\r',
    "ESAVE\r",
)


def world(chance: random.Random) -> str:
    """Four nodes, two of which fail, and four drives, some with addresses that collide."""
    nodes = "".join(
        node(
            number, bit_rate=chance.choice([125, 1000]), digital_inputs=chance.choice([0, 7, 40]),
            digital_outputs=chance.choice([0, 9, 64]), analog_inputs=chance.choice([0, 3]),
        )
        for number in range(1, 5)
    )  # fmt: skip
    faults = (fault(kind, node=chance.randint(1, 4), at_s=2.0) for kind in ("silent", "lost"))
    motors = (talk.axis(number) for number in range(4))
    drives = (talk.talking(n, address=chance.choice([0, 1, n + 1])) for n in range(4))
    return "".join([nodes, *faults, fault("noise", rate=0.3, at_s=1.0), *motors, *drives])


def live(made: Controller, chance: random.Random) -> str:
    """Do all kinds of things; the fingerprint of the end."""
    for _ in range(60):
        deed = chance.randrange(4)
        if deed == 0:
            made.p[chance.choice(PARAMETERS)] = chance.choice(VALUES)
        elif deed == 1:
            made.bit[chance.choice(FLAGS)] = True
        elif deed == 2:
            made.send(chance.choice(LINES))
        else:
            with suppress(UserError):  # an input that does not exist
                made.set_input(chance.choice(DI) + chance.randint(0, 8), chance.random() < 0.5)
        made.advance(chance.randint(1, 300))
    return made.digest()


@pytest.mark.parametrize("seed", range(6))
def test_a_life_can_be_lived_again(seed: int) -> None:
    made = card(world(random.Random(seed)))
    made.send('PROG0\rOPEN DTALK "COM2:9600" AS #1\r')
    begin = made.snapshot()
    first = live(made, random.Random(seed))
    made.restore(begin)
    assert live(made, random.Random(seed)) == first
