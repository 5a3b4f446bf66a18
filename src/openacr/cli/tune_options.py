"""The options of `openacr tune`, and what they are where they are not given."""

from pathlib import Path
from typing import Annotated

import typer

AXES = 16
AMPLITUDE_CNT = 100.0
BAND_HZ = (2.0, 60.0)
SWEEP_S = 1.5
STEP_S = 0.3  # also of the trial of `apply`
PHASE_DEG = 55.0
BY_AMPLITUDE = 0.0  # a bound of four times the amplitude

Where = Annotated[
    str, typer.Argument(metavar="HOST|PROJECT", help="HOST, HOST:PORT, serial port, or project.")
]
AxisNumber = Annotated[int, typer.Argument(metavar="AXIS", min=0, max=AXES - 1, help="The axis.")]
Amplitude = Annotated[float, typer.Option(help="Amplitude of the excitation [pulses].")]
Band = Annotated[
    tuple[float, float], typer.Option(metavar="LOW HIGH", help="Frequencies of the sweep [Hz].")
]
Duration = Annotated[float, typer.Option("--time", help="Time of the excitation [s].")]
StepTime = Annotated[float, typer.Option("--time", help="Time until the step back [s].")]
MostError = Annotated[
    float, typer.Option("--max-error", help="Following error that ends it [pulses]; 0: 4 x.")
]
MostTravel = Annotated[
    float, typer.Option("--max-travel", help="Travel that ends it [pulses]; 0: 4 x amplitude.")
]
Program = Annotated[
    int | None, typer.Option(min=0, max=15, help="Empty program to use; else the highest.")
]
Bandwidth = Annotated[
    float | None, typer.Option(help="Crossover of the open loop [Hz]; else the highest allowed.")
]
Phase = Annotated[float, typer.Option(help="Phase margin [degrees].")]
NoIntegral = Annotated[bool, typer.Option("--no-integral", help="Propose no IGAIN.")]
MoveOption = Annotated[
    tuple[float, float, float] | None,
    typer.Option("--move", metavar="DIST VEL ACC", help="Predict its error [units, /s, /s2]."),
]
Picture = Annotated[Path | None, typer.Option("--plot", help="Draw a PNG or SVG picture.")]
AsJson = Annotated[bool, typer.Option("--json", help="One JSON object.")]
IsSure = Annotated[bool, typer.Option("--yes", help="Do not ask before the axis moves.")]
