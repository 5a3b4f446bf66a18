"""Select the values that a trace records in addition to the axes."""

from collections.abc import Sequence
from dataclasses import dataclass

from openacr.engine.watches import Watched, parameter_place
from openacr.map.memory import Memory, flag_place
from openacr.map.rows import engine, trace_values

SAMPLES = trace_values.COUNT


@dataclass(frozen=True, slots=True)
class Sample:
    """A number of the map, or whether masked bits of a word are set (1.0 or 0.0)."""

    place: Watched
    row: int
    mask: int = -1


def sample_of_flag(number: int) -> Sample:
    """The sample that records a flag."""
    row, mask = flag_place(number)
    return Sample(Watched.WORD, row, mask)


def sample_of_parameter(memory: Memory, number: int) -> Sample | None:
    """The sample that records a parameter; None if the card has no such number.

    A user variable (P0 to P4095) records 0 until it is dimensioned.
    """
    found = parameter_place(memory, number)
    return None if found is None else Sample(*found)


def set_samples(memory: Memory, samples: Sequence[Sample]) -> None:
    """Record these samples, at most SAMPLES, in every row of a trace from now on."""
    if len(samples) > SAMPLES:
        raise ValueError(f"{len(samples)} values cannot be recorded at once, at most {SAMPLES}")
    for index, sample in enumerate(samples):
        memory.I[trace_values.kind[index]] = sample.place.value
        memory.I[trace_values.row[index]] = sample.row
        memory.I[trace_values.mask[index]] = sample.mask
    memory.I[engine.sample_count] = len(samples)
