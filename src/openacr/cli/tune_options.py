"""The options of `openacr tune`, and what they are where they are not given."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from openacr.cli.live.online import BAUD, SILENCE_S, Baud, Silence

if TYPE_CHECKING:
    from openacr.tuning.excitation import Excitation
    from openacr.tuning.propose import Wish

AXES = 16
AMPLITUDE_CNT = 100.0
BAND_HZ = (2.0, 60.0)
STEP_S = 0.3  # also of the trial of `apply`
PHASE_DEG = 55.0
BY_AMPLITUDE = 0.0  # a bound of four times the amplitude

Where = Annotated[
    str, typer.Argument(metavar="HOST|PROJECT", help="HOST, HOST:PORT, serial port, or project.")
]
AxisName = Annotated[str, typer.Argument(metavar="AXIS", help="Number of the axis, or its name.")]
Amplitude = Annotated[float, typer.Option(help="Amplitude of the excitation [pulses].")]
Band = Annotated[
    tuple[float, float], typer.Option(metavar="LOW HIGH", help="Frequencies of the sweep [Hz].")
]
Duration = Annotated[
    float | None,
    typer.Option("--time", help="Time of the excitation [s]; else 1.5, or what a program holds."),
]
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
Kept = Annotated[Path, typer.Option(help="New file for the former gains.")]
Picture = Annotated[Path | None, typer.Option("--plot", help="Draw a PNG or SVG picture.")]
AsJson = Annotated[bool, typer.Option("--json", help="One JSON object.")]
IsSure = Annotated[bool, typer.Option("--yes", help="Do not ask before the axis moves.")]


@dataclass(frozen=True, kw_only=True)
class MovedAxis:
    """An axis that is excited, and the bounds that end it."""

    target: Where
    axis: AxisName
    amplitude: Amplitude = AMPLITUDE_CNT
    max_error: MostError = BY_AMPLITUDE
    max_travel: MostTravel = BY_AMPLITUDE
    program: Program = None


@dataclass(frozen=True, kw_only=True)
class Connected:
    """The last options: how the card is reached, and whether the axis may move at once."""

    is_sure: IsSure = False
    baud: Baud = BAUD
    silence: Silence = SILENCE_S


@dataclass(frozen=True, kw_only=True)
class Reported:
    """What is made of the result."""

    plot: Picture = None
    as_json: AsJson = False


@dataclass(frozen=True, kw_only=True)
class SweptAxis(MovedAxis):
    """An axis that is excited by a sine sweep."""

    band: Band = BAND_HZ
    duration: Duration = None

    def excitation(self) -> "Excitation":
        """The sweep with the bounds that end it; UserError for one that is refused."""
        from openacr.tuning.excitation import Excitation

        sweep = Excitation(
            "sine",
            self.amplitude,
            *self.band,
            error_cnt=self.max_error,
            travel_cnt=self.max_travel,
            is_shortened=self.duration is None,
        )
        if self.duration is not None:
            sweep = replace(sweep, duration_s=self.duration)
        return sweep.checked()


@dataclass(frozen=True, kw_only=True)
class WantedGains(SweptAxis):
    """An axis for which gains are proposed, and what they are to keep."""

    bandwidth: Bandwidth = None
    phase: Phase = PHASE_DEG
    no_integral: NoIntegral = False

    def wish(self) -> "Wish":
        """What the gains are to keep."""
        from openacr.tuning.propose import Wish

        return Wish(self.bandwidth, self.phase, not self.no_integral)


@dataclass(frozen=True, kw_only=True)
class MeasureOptions(Connected, Reported, SweptAxis):
    """`openacr tune measure`."""


@dataclass(frozen=True, kw_only=True)
class ProposeOptions(Connected, Reported, WantedGains):
    """`openacr tune propose`."""

    move: MoveOption = None


@dataclass(frozen=True, kw_only=True)
class ApplyOptions(Connected, WantedGains):
    """`openacr tune apply`."""

    keep: Kept = Path("gains.json")


@dataclass(frozen=True, kw_only=True)
class StepOptions(Connected, Reported, MovedAxis):
    """`openacr tune step`."""

    duration: StepTime = STEP_S

    def excitation(self) -> "Excitation":
        """The step with the bounds that end it; UserError for one that is refused."""
        from openacr.tuning.excitation import Excitation

        return Excitation(
            "step",
            self.amplitude,
            duration_s=self.duration,
            error_cnt=self.max_error,
            travel_cnt=self.max_travel,
        ).checked()
