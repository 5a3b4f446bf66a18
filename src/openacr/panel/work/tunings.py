"""Measurements of servo tuning that are kept under names: a small file each, in one folder.

The file is what a browser exports and reads again: what charts and tables show of one loop.
"""

import os
from collections.abc import Iterator
from pathlib import Path
from threading import Lock
from typing import Annotated, Any

import msgspec
from msgspec import Meta

from openacr.errors import UserError, unwritable

MOST = 40  # measurements
MOST_BYTES = 400_000  # of each
SUFFIX = ".json"
_CHANGES = Lock()  # browsers may keep at the same time

_LINE = r"^[^\x00-\x1f\x7f]*\S[^\x00-\x1f\x7f]*$"
Name = Annotated[str, Meta(max_length=60, pattern=_LINE)]
Word = Annotated[str, Meta(max_length=40)]
Numbers = Annotated[tuple[float, ...], Meta(max_length=8000)]
Figures = Annotated[dict[Word, float | None], Meta(max_length=40)]


class Part(msgspec.Struct, frozen=True, kw_only=True):
    """A part of a measurement; what is not declared is left out."""


class Curve(Part, frozen=True, kw_only=True):
    """An axis over the time."""

    time_s: Numbers
    setpoint_cnt: Numbers
    actual_cnt: Numbers


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


class Kept(Part, frozen=True, kw_only=True):
    """A file: the name of a measurement, and the measurement."""

    name: Name
    tuning: Tuning


class Tunings:
    """The folder of kept measurements, each a file with a number."""

    def __init__(self, folder: Path | None) -> None:
        self._folder = folder

    def entries(self) -> list[dict[str, Any]]:
        """What is kept, by number: name, axis, time, bytes; without files that cannot be read."""
        found = []
        for number, path in self._files():
            try:
                kept = msgspec.json.decode(path.read_bytes(), type=Kept)
            except (OSError, msgspec.MsgspecError, RecursionError):
                continue
            found.append(
                {
                    "number": number,
                    "name": kept.name,
                    "axis": kept.tuning.axis,
                    "at": kept.tuning.at,
                    "bytes": path.stat().st_size,
                }
            )
        return found

    def read(self, number: int) -> Kept:
        """A kept measurement; UserError where there is none."""
        try:
            return msgspec.json.decode(self._path(number).read_bytes(), type=Kept)
        except (OSError, msgspec.MsgspecError, RecursionError):
            raise UserError(f"measurement {number} is not kept any more") from None

    def keep(self, name: str, tuning: Tuning) -> int:
        """Keep a measurement under a name; its number.

        UserError for a name that is taken, beyond the bounds, and where there is no folder.
        """
        _require_curves(tuning)
        with _CHANGES:
            self._require_free(name)
            numbers = [number for number, _path in self._files()]
            if len(numbers) >= MOST:
                raise UserError(f"{MOST} measurements are kept, the most there can be: delete one")
            number = max(numbers, default=0) + 1
            self._write(number, Kept(name=name, tuning=tuning))
        return number

    def rename(self, number: int, name: str) -> None:
        """Give a measurement another name; UserError for one that is taken."""
        with _CHANGES:
            kept = self.read(number)
            self._require_free(name, beside=number)
            self._write(number, msgspec.structs.replace(kept, name=name))

    def delete(self, number: int) -> None:
        """Delete a measurement; UserError where there is none."""
        self.read(number)
        self._path(number).unlink(missing_ok=True)

    def _files(self) -> Iterator[tuple[int, Path]]:
        if self._folder is None or not self._folder.is_dir():
            return
        found = [
            (int(path.stem), path)
            for path in self._folder.iterdir()
            if path.suffix == SUFFIX and path.stem.isdecimal() and path.is_file()
        ]
        yield from sorted(found)

    def _path(self, number: int) -> Path:
        if self._folder is None:
            raise UserError("a store in memory keeps no measurements: name a store (--store)")
        return self._folder / f"{number}{SUFFIX}"

    def _require_free(self, name: str, *, beside: int = 0) -> None:
        for each in self.entries():
            if each["name"] == name and each["number"] != beside:
                raise UserError(f"{name}: there is a measurement of this name: choose another one")

    def _write(self, number: int, kept: Kept) -> None:
        path = self._path(number)
        data = msgspec.json.encode(kept)
        if len(data) > MOST_BYTES:
            raise UserError(
                f"{kept.name}: {len(data)} bytes: a measurement has {MOST_BYTES} at most"
            )
        partial = path.with_suffix(".partial")
        try:
            path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
            partial.write_bytes(data)
            os.replace(partial, path)
        except OSError as error:
            raise unwritable(path, error) from None
        finally:
            partial.unlink(missing_ok=True)


def folder_of(store: Path | None) -> Path | None:
    """The folder of the measurements of a store; None: it is in memory."""
    return None if store is None else store.with_name(store.name + "-tunings")


def _require_curves(tuning: Tuning) -> None:
    """Refuse curves whose times or frequencies have another length than their values."""
    bode, steps = tuning.bode, [tuning.present.step]
    steps += [tuning.trial.measured] if tuning.trial else []
    own = bode.measured.frequency_hz
    lengths = [
        *((each.time_s, (each.setpoint_cnt, each.actual_cnt)) for each in steps),
        (bode.frequency_hz, (bode.present.magnitude_db, bode.present.phase_deg)),
        (own, (bode.measured.magnitude_db, bode.measured.phase_deg, bode.measured.coherence)),
    ]
    for along, curves in lengths:
        if not along or any(len(each) != len(along) for each in curves):
            raise UserError("this is no measurement: a curve has not as many values as times")
