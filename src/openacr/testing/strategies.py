"""Random machines for Hypothesis: worlds in which a program should still do its work.

from hypothesis import given
from openacr.testing.strategies import loads, worlds

@given(worlds("machine/machine.toml"))
def test_the_part_is_placed(world): ...
"""

from __future__ import annotations

from pathlib import Path

from hypothesis import strategies as st
from msgspec.structs import replace

from openacr.plant.describe.load import load_world
from openacr.plant.describe.schema import Axis, Load, World


def loads(usual: Load, factor: float = 3.0) -> st.SearchStrategy[Load]:
    """Loads with up to `factor` times more or less inertia and friction than a usual one."""
    scale = st.floats(1.0 / factor, factor)
    return st.builds(
        lambda inertia, viscous, coulomb: replace(
            usual,
            inertia_kgm2=usual.inertia_kgm2 * inertia,
            viscous_nms=usual.viscous_nms * viscous,
            coulomb_nm=usual.coulomb_nm * coulomb,
        ),
        scale,
        scale,
        scale,
    )


def axes(usual: Axis, factor: float = 3.0, initial_u: float = 0.0) -> st.SearchStrategy[Axis]:
    """The axis with another load, at rest up to `initial_u` units from its usual place."""
    return st.builds(
        lambda load, away: replace(usual, load=load, initial=usual.initial + away),
        loads(usual.load, factor),
        st.floats(-initial_u, initial_u),
    )


def worlds(
    machine: Path | str | World, factor: float = 3.0, initial_u: float = 0.0
) -> st.SearchStrategy[World]:
    """The machine of a file with other loads and places of rest."""
    world = machine if isinstance(machine, World) else load_world(machine)
    each = [axes(axis, factor, initial_u) for axis in world.axis]
    return st.tuples(*each).map(lambda found: replace(world, axis=tuple(found)))
