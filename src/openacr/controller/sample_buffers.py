"""The samples of all axes recorded by the compiled loop, in buffers of fixed size."""

from collections.abc import Sequence
from typing import cast

import numpy as np

from openacr.controller.trace import Reals, Trace, build_trace
from openacr.engine.samples import Sample, set_samples
from openacr.engine.trace_cy import TRACE_AXIS, TRACE_HEAD
from openacr.map.rows import engine
from openacr.motion.card import Card
from openacr.motion.interlocks import scale_of
from openacr.views import F64

CHUNK_ROWS = 65536


class Recording:
    """The recording of a card; `view` is the buffer the loop writes to."""

    def __init__(self, card: Card) -> None:
        self._card = card
        self._full: list[Reals] = []
        self._present: Reals | None = None
        self.view: F64 = memoryview(bytearray(8)).cast("d")

    def start(self, every_tk: int, *, keep_peaks: bool, samples: Sequence[Sample]) -> None:
        """Record every `every_tk` ticks from now on; earlier samples are dropped."""
        self._full = []
        set_samples(self._card.memory, samples)
        self._set(engine.trace_peaks, int(keep_peaks))
        self._set(engine.trace_every, every_tk)
        self._set(engine.trace_wait, 1)
        self._begin_buffer()

    def stop(self) -> None:
        """Record no more; what has been recorded is dropped."""
        self._full, self._present = [], None
        self._set(engine.trace_every, 0)

    def go_on(self) -> None:
        """Keep the full buffer and continue with a new one."""
        if self._present is not None:
            self._full.append(self._present)
        self._begin_buffer()

    def trace(self) -> Trace:
        """What has been recorded so far."""
        columns = self._columns
        parts = [part.reshape(-1, columns) for part in self._full]
        if self._present is not None:
            used = self._card.memory.I[engine.trace_row]
            parts.append(self._present.reshape(-1, columns)[:used])
        samples = np.concatenate(parts) if parts else np.empty((0, columns))
        scales = [scale_of(self._card, axis) for axis in range(self._card.model.axes)]
        return build_trace(samples, scales)

    def take(self) -> Trace:
        """What has been recorded since the last call; the rows are dropped."""
        found = self.trace()
        self._full = []
        if self._present is not None:
            self._begin_buffer()
        return found

    @property
    def _columns(self) -> int:
        chosen: int = self._card.memory.I[engine.sample_count]
        return TRACE_HEAD + TRACE_AXIS * self._card.model.axes + chosen

    def _begin_buffer(self) -> None:
        self._present = np.zeros(CHUNK_ROWS * self._columns)
        self.view = cast(F64, self._present.data)
        self._set(engine.trace_row, 0)
        self._set(engine.trace_rows, CHUNK_ROWS)

    def _set(self, row: int, value: int) -> None:
        self._card.memory.I[row] = value
