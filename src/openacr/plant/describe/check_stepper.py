"""Check the stepper motors of a `machine.toml` for contradictions."""

from collections.abc import Iterator
from itertools import pairwise

from openacr.plant.describe.schema import Axis, StepperDrive


def stepper_faults(axis: Axis, drive: StepperDrive) -> Iterator[tuple[tuple[str, ...], str, str]]:
    """Yield key, text and hint of every contradiction."""
    if axis.dac is not None:
        hint = "leave dac away; `output` of the drive names the stepper output"
        yield ("dac",), "a stepper drive takes pulses, no voltage", hint
    if axis.marker is not None and not axis.has_encoder:
        yield ("marker",), "there is no encoder that had a marker", "give encoder_lines"
    curve = drive.torque_nm
    for (slow, _), (fast, _) in pairwise(curve):
        if fast <= slow:
            text = f"the speeds of torque_nm go from {slow:g} to {fast:g} rev/s"
            yield ("drive", "torque_nm"), text, "give the points from slow to fast"
    if not any(torque for _, torque in curve):
        yield ("drive", "torque_nm"), "the motor has no torque at all", ""
