"""Every example does exactly what it did before, meets its expectations, on either core."""

import os
import subprocess
import sys

import pytest
from tests.examples.observe import EXAMPLES, Watch, load, observe, trace
from tests.examples.watches import ALL

from openacr.compiled import is_compiled

pytestmark = pytest.mark.evidence("reading", "events recorded from the card itself")

# Name, what is typed, ticks: long enough for motion, short enough for the slow core.
SHORT_RUNS = (
    ("gantry", "PROG 0\rRUN\rPROG 1\rRUN\r", 10_400),
    ("square", "PROG0\rRUN\r", 800),
    ("diamonds", "PROG0\rRUN\r", 800),
    ("basic_motion", "PROG0\rRUN\r", 800),
    ("homing_xyz", "PROG0\rRUN\r", 1_000),
    ("error_handler", "PROG0\rRUN\r", 2_400),
    ("plc_excess_error", "PROG0\rPGAIN X0\rX20\r", 1_000),
    ("canopen_io", "PROG0\rRUN\r", 600),
    ("brushless", "PROG0\rRUN\r", 1_600),
    ("pick_and_label", "PROG0\rRUN\r", 800),
)
_PURE = """
import sys
from openacr.compiled import is_compiled
from openacr.controller import Controller
assert not is_compiled
for folder, typed, ticks in zip(sys.argv[1::3], sys.argv[2::3], sys.argv[3::3]):
    card = Controller.from_project(folder)
    card.send(typed)
    card.advance(int(ticks))
    print(card.digest())
"""


@pytest.mark.parametrize("watch", ALL, ids=lambda watch: f"{watch.example}-{watch.golden.stem}")
def test_the_scenario_is_met_and_every_event_is_as_before(watch: Watch) -> None:
    found = observe(watch)
    assert [str(verdict) for verdict in found.verdicts if not verdict.ok] == []
    assert trace(found, watch) == watch.golden.read_text()


@pytest.mark.skipif(not is_compiled, reason="there is no compiled core to compare with")
def test_pure_python_ends_with_the_same_state_to_the_bit() -> None:
    arguments = [
        str(part) for name, typed, ticks in SHORT_RUNS for part in (EXAMPLES / name, typed, ticks)
    ]
    pure = subprocess.run(
        [sys.executable, "-c", _PURE, *arguments],
        env=os.environ | {"OPENACR_PURE": "1"},
        check=True,
        capture_output=True,
        text=True,
    )
    assert pure.stdout.split() == [_digest(*short) for short in SHORT_RUNS]


def _digest(name: str, typed: str, ticks: int) -> str:
    card = load(name)
    card.send(typed)
    card.advance(ticks)
    return card.digest()
