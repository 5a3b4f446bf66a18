"""When the networks want the slow side: the same answers compiled and as plain Python."""

from collections.abc import Callable

import pytest
from tests.network.rig import DI, PANEL, RESET, START, running

from openacr.compiled import counterpart, is_compiled
from openacr.controller import Controller
from openacr.map.rows import networks, system
from openacr.network.wake_cy import networks_due

SLOW_PHASE = system.slow_phase
BUILDS = [networks_due, *([counterpart(networks_due)] if is_compiled else [])]


def quiet() -> Controller:
    """A running network with nothing to do in a tick between two slow scans."""
    made = running(PANEL)
    made.memory.I[SLOW_PHASE] = 1
    return made


def due(build: Callable[..., bool], made: Controller, after_tk: int = 0) -> bool:
    return bool(build(made.memory.F, made.memory.I, made.tick + after_tk))


@pytest.mark.parametrize("build", BUILDS, ids=["plain", "compiled"][: len(BUILDS)])
def test_only_what_is_due_wakes(build: Callable[..., bool]) -> None:
    made = quiet()
    assert not due(build, made)
    wait_tk = int(made.memory.F[networks.due_tk]) - made.tick
    assert [due(build, made, wait_tk + n) for n in (-1, 0, 1)] == [False, True, True]


@pytest.mark.parametrize("build", BUILDS, ids=["plain", "compiled"][: len(BUILDS)])
def test_a_changed_input_wakes_until_it_is_sent(build: Callable[..., bool]) -> None:
    made = quiet()
    made.set_input(DI[0] + 9, True)
    assert due(build, made)
    made.networks.attend()
    assert not due(build, made)


@pytest.mark.parametrize("build", BUILDS, ids=["plain", "compiled"][: len(BUILDS)])
@pytest.mark.parametrize(
    "flag", [START, RESET, *range(10496, 10501), 10496 + 15 * 32, 11040, 11104, 11232]
)
def test_request_flags_wake_in_the_slow_scan(build: Callable[..., bool], flag: int) -> None:
    made = quiet()
    made.bit[flag] = True
    assert not due(build, made)
    made.memory.I[SLOW_PHASE] = 0
    assert due(build, made)
    made.bit[flag] = False
    made.bit[10505] = True  # a selection asks for nothing
    assert not due(build, made)
