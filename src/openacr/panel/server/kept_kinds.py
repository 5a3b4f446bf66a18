"""What is kept under names: set-ups and references of the scope, measurements of servo tuning.

The files are what a browser exports and reads again; their forms are checked at every reading.
"""

from dataclasses import dataclass
from typing import Annotated, Any, Literal, TypeAlias

import msgspec
from msgspec import Meta, Struct

KindWord: TypeAlias = Literal["setup", "reference", "tuning"]
CHANNELS = 9  # the computed one is the last
SAMPLES = 100_000  # of a trace

Text = Annotated[str, Meta(max_length=200)]
Color = Annotated[str, Meta(pattern="^#[0-9a-fA-F]{6}$")]
Finite = Annotated[float, Meta(ge=-1e300, le=1e300)]
Above = Annotated[float, Meta(gt=0.0, le=1e9)]
Word = Annotated[str, Meta(max_length=40)]
Numbers = Annotated[tuple[float, ...], Meta(max_length=8000)]
Figures = Annotated[dict[Word, float | None], Meta(max_length=40)]


class Channel(Struct, forbid_unknown_fields=True):
    """The fields of a channel, as they are typed."""

    source: Text
    color: Color
    scale: Text
    offset: Text
    unit: Text
    format: Text


class Setup(Struct, forbid_unknown_fields=True):
    """A set-up: channels, the computed one last, and settings by their names."""

    channels: Annotated[list[Channel], Meta(min_length=1, max_length=CHANNELS)]
    settings: Annotated[dict[Text, Text], Meta(max_length=40)]


class Trace(Struct, forbid_unknown_fields=True):
    """A trace of a reference; a missing sample is null."""

    label: Text
    id: Text
    name: Text
    unit: Text
    format: Text
    color: Color
    isFlag: bool  # noqa: N815
    scale: Finite
    offset: Finite
    values: Annotated[list[Finite | None], Meta(max_length=SAMPLES)]


class Reference(Struct, forbid_unknown_fields=True):
    """Traces with s between two samples, ms of the first one and of the left edge."""

    traces: Annotated[list[Trace], Meta(min_length=1, max_length=CHANNELS)]
    period: Above
    start: Finite
    from_: Finite = msgspec.field(name="from")


class Part(Struct, frozen=True, kw_only=True):
    """A part of a measurement; what is not declared is left out."""


class Curve(Part, frozen=True, kw_only=True):
    """An axis over the time."""

    time_s: Numbers
    setpoint_cnt: Numbers
    actual_cnt: Numbers

    def __post_init__(self) -> None:
        _require_as_long(self.time_s, self.setpoint_cnt, self.actual_cnt)


class Response(Part, frozen=True, kw_only=True):
    """A frequency response; without frequencies it has those of the others."""

    magnitude_db: Numbers
    phase_deg: Numbers
    frequency_hz: Numbers = ()
    coherence: Numbers = ()


class Loop(Part, frozen=True, kw_only=True):
    """The loop with the gains that it was measured with."""

    gains: Figures
    filters: Figures | None
    margins: Annotated[dict[Word, float | bool | None], Meta(max_length=40)]
    figures: Figures
    rms_error_cnt: float | None
    step: Curve


class Bode(Part, frozen=True, kw_only=True):
    """Open loop and motor over the frequency."""

    frequency_hz: Numbers
    present: Response
    measured: Response

    def __post_init__(self) -> None:
        loop, motor = self.present, self.measured
        _require_as_long(self.frequency_hz, loop.magnitude_db, loop.phase_deg)
        _require_as_long(motor.frequency_hz, motor.magnitude_db, motor.phase_deg, motor.coherence)


class Trial(Part, frozen=True, kw_only=True):
    """A step that the axis has made with these gains."""

    figures: Figures
    measured: Curve


class Tuning(Part, frozen=True, kw_only=True):
    """A measurement: the axis by its name, when, how it was excited, and what came out."""

    axis: Word
    at: Word
    time_s: float
    amplitude_cnt: float
    band_hz: tuple[float, float]
    present: Loop
    bode: Bode
    trial: Trial | None = None


def _require_as_long(along: Numbers, *curves: Numbers) -> None:
    if not along or any(len(each) != len(along) for each in curves):
        raise ValueError("a curve has not as many values as times or frequencies")


@dataclass(frozen=True, slots=True)
class Kind:
    """A kind of kept files: its noun, its folder, how many of how many bytes, and its form."""

    noun: str
    folder: str
    most: int
    most_bytes: int  # of one
    form: type[Struct]
    says: tuple[str, ...] = ()  # fields that a list shows
    indent: int = -1  # of the text of a file; -1: one line

    def parsed(self, text: bytes) -> Struct:
        """What a file says; ValueError with what is wrong in it."""
        try:
            return msgspec.json.decode(text, type=self.form)
        except RecursionError as error:
            raise ValueError(str(error)) from None

    def text_of(self, found: Struct) -> bytes:
        """The text of a file."""
        return msgspec.json.format(msgspec.json.encode(found), indent=self.indent)

    def about(self, found: Struct) -> dict[str, Any]:
        """What a list says of one, beside its name."""
        return {each: getattr(found, each) for each in self.says}


KINDS: dict[KindWord, Kind] = {
    "setup": Kind("set-up", "scope", 64, 4 << 20, Setup, indent=1),
    "reference": Kind("reference", "scope", 64, 4 << 20, Reference),
    "tuning": Kind("measurement", "tuning", 40, 400_000, Tuning, ("axis", "at")),
}
