"""G50, G51, G68, G69: scaling and rotation."""

from __future__ import annotations

from typing import TYPE_CHECKING

from openacr.cnc.canonical import AXES
from openacr.cnc.codes.gcodes.work import length_of
from openacr.cnc.codes.table import Axes, Group, Step
from openacr.cnc.codes.tables import ACROMILL
from openacr.cnc.geometry.coordinates import Rotation, Scale

if TYPE_CHECKING:
    from openacr.cnc.codes.run import Run
    from openacr.cnc.program.block_context import BlockContext

gcode = ACROMILL.gcode
_FACTORS = "IJK"


@gcode(50, step=Step.SCALE, group=Group.SCALE)
def no_scale(run: Run, b: BlockContext) -> None:
    """Scaling off."""
    run.offset_path.refuse(b, "E311")
    run.path.coordinates.chosen_scale = None
    run.path.refresh()


@gcode(51, step=Step.SCALE, group=Group.SCALE, takes="PIJK", axes=Axes.DATA)
def scale(run: Run, b: BlockContext) -> None:
    """Scale about a centre: P for all axes, or I, J, K for X, Y, Z; negative mirrors."""
    run.offset_path.refuse(b, "E311")
    separate = [letter for letter in _FACTORS if letter in b.words]
    if "P" in b.words and separate:
        raise b.fault("E206", separate[0], separate[0], "P or I J K")
    if "P" not in b.words and not separate:
        raise b.fault("E206", "", "factor missing", "P or I J K")
    factors = [b.get("P", 1.0)] * AXES
    for axis, letter in enumerate(_FACTORS):
        if letter in b.words:
            factors[axis] = b.words[letter]
    if 0.0 in factors:
        raise b.fault("E244", "P" if "P" in b.words else separate[0])
    run.path.coordinates.chosen_scale = Scale(centre_of(run, b), tuple(factors))
    run.path.refresh()


def centre_of(run: Run, b: BlockContext) -> tuple[float, ...]:
    """The axis words as a point; missing ones are where the program is."""
    centre = list(run.path.program)
    for axis, letter, value in b.axes:
        centre[axis] = length_of(run, letter, value)
    return tuple(centre)


@gcode(68, step=Step.ROTATION, group=Group.ROTATION, takes="R", axes=Axes.DATA)
def rotate(run: Run, b: BlockContext) -> None:
    """Rotate the plane by R degrees about a centre, + counter-clockwise."""
    run.offset_path.refuse(b, "E311")
    if "R" not in b.words:
        raise b.fault("E206", "", "R missing")
    plane = run.modal.plane_axes
    for axis, letter, _ in b.axes:
        if axis not in (plane.first, plane.second):
            raise b.fault("E234", letter, letter)
    centre = centre_of(run, b)
    turn = Rotation(plane, (centre[plane.first], centre[plane.second]), b.words["R"])
    run.path.coordinates.chosen_rotation = turn
    run.path.refresh()


@gcode(69, step=Step.ROTATION, group=Group.ROTATION)
def no_rotation(run: Run, b: BlockContext) -> None:
    """Rotation off."""
    run.offset_path.refuse(b, "E311")
    run.path.coordinates.chosen_rotation = None
    run.path.refresh()
