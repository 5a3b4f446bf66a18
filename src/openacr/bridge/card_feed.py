"""A feed that reads a card with the client: beside any other host, without its CNC side."""

import logging
import threading
import time
from concurrent.futures import Future
from queue import Empty, Full, Queue

from openacr.bridge.moment import MM_PER_INCH, AxisName, Moment
from openacr.bridge.settings import Length, OnCard
from openacr.client import Card, Options, RefusedError
from openacr.errors import OpenacrError
from openacr.map.rows import axes as axis_rows
from openacr.map.rows import masters
from openacr.map.words import mf1

log = logging.getLogger(__name__)
ROTARY = frozenset("ABC")
RETRY_S = 2.0  # between two attempts to reach the card
SILENCE_S = 2.0  # longest wait for an answer
END_S = 2.0 * SILENCE_S
MASTER = 0
MOST_WRITES = 1000  # that wait for the card
ROWS = (
    axis_rows.current_position,
    axis_rows.actual_position,
    axis_rows.following_error,
    axis_rows.ppu,
)
MASTER_ROWS = (mf1.word[MASTER], masters.vector_velocity[MASTER])


class CardFeed:
    """One card, read in a thread of its own; after a loss it is tried again."""

    def __init__(self, target: str, settings: OnCard) -> None:
        self._target = target
        self._axes = tuple(AxisName(name, name in ROTARY) for name in settings.axes)
        self._mm_per_unit = MM_PER_INCH if settings.unit is Length.INCH else 1.0
        self._moment = Moment(lost=f"{target} is being opened")
        self._writes: Queue[tuple[Future[None], int, float, bool]] = Queue(MOST_WRITES)
        self._is_over = threading.Event()
        self._numbers: list[int] = []
        self._chosen: list[int] = []
        self._thread = threading.Thread(target=self._run, name="bridge feed", daemon=True)
        self._every_s = 0.1

    @property
    def axes(self) -> tuple[AxisName, ...]:
        """The axes named in the bridge file: AXIS0 is the first of them."""
        return self._axes

    def start(self, parameters: list[int], rate_hz: float) -> None:
        """Begin to read."""
        axes = range(len(self._axes))
        of_axes = [row[axis] for row in ROWS for axis in axes]
        self._numbers = [*of_axes, *MASTER_ROWS, *parameters]
        self._chosen, self._every_s = parameters, 1.0 / rate_hz
        self._thread.start()

    def newest(self) -> Moment:
        """The newest reading."""
        return self._moment

    def write(self, number: int, value: float, *, is_flag: bool) -> "Future[None]":
        """Have the thread set a parameter or flag; refused while too many wait."""
        done: Future[None] = Future()
        try:
            self._writes.put_nowait((done, number, value, is_flag))
        except Full:
            done.set_exception(OpenacrError("too many values wait to be written: try again"))
        return done

    def stop(self) -> None:
        """End the thread; what waits to be written is refused."""
        self._is_over.set()
        if self._thread.is_alive():
            self._thread.join(END_S)
        self._refuse("the bridge ends")

    # --- in the thread ----------------------------------------------------------------

    def _run(self) -> None:
        options = Options(timeout_s=SILENCE_S, deadline_s=SILENCE_S, reconnect_s=0.0)
        while not self._is_over.is_set():
            try:
                with Card.open(self._target, options) as card:
                    log.info("%s: connected", self._target)
                    self._read_on(card)
            except OpenacrError as error:
                self._lose(str(error))
            except Exception as error:  # the thread must outlive what it has not foreseen
                log.exception("reading %s has failed", self._target)
                self._lose(f"{type(error).__name__}: {error}")
            self._is_over.wait(RETRY_S)

    def _lose(self, why: str) -> None:
        if self._moment.lost != why:
            log.warning("%s; it is tried again", why)
        self._moment = Moment(lost=why)
        self._refuse(why)

    def _refuse(self, why: str) -> None:
        while True:
            try:
                done, *_ = self._writes.get_nowait()
            except Empty:
                return
            if done.set_running_or_notify_cancel():
                done.set_exception(OpenacrError(why))

    def _read_on(self, card: Card) -> None:
        """Read until the end of the bridge; ClientError where the card is lost."""
        due_s = time.monotonic()
        while not self._is_over.is_set():
            self._moment = self._read(card)
            due_s = max(due_s + self._every_s, time.monotonic())
            self._write_until(card, due_s)

    def _read(self, card: Card) -> Moment:
        values = [float(value) for value in card.read_many(self._numbers)]
        count = len(self._axes)
        parts = [values[k * count : (k + 1) * count] for k in range(len(ROWS))]
        current, actual, following = (
            tuple(v / ppu if ppu else v for v, ppu in zip(part, parts[3], strict=True))
            for part in parts[:3]
        )
        word, speed_ups = values[len(ROWS) * count :][:2]
        return Moment(
            mm_per_unit=self._mm_per_unit,
            commanded=current,
            actual=actual,
            following=following,
            speed_ups=speed_ups,
            is_moving=bool(int(word) & mf1.IN_MOTION),
            watched=dict(zip(self._chosen, values[len(values) - len(self._chosen) :], strict=True)),
        )

    def _write_until(self, card: Card, due_s: float) -> None:
        """Wait for the next reading; what is to be written meanwhile is written at once."""
        while (left_s := due_s - time.monotonic()) > 0 and not self._is_over.is_set():
            try:
                done, number, value, is_flag = self._writes.get(timeout=min(left_s, 0.1))
            except Empty:
                continue
            if not done.set_running_or_notify_cancel():
                continue
            _carry_out(card, done, number, value, is_flag=is_flag)


def _carry_out(
    card: Card, done: "Future[None]", number: int, value: float, *, is_flag: bool
) -> None:
    """Set a parameter or flag; what the card refuses is for the caller, a lost card for all."""
    try:
        if is_flag:
            card.write_bit(number, bool(value))
        else:
            card.write(number, value)
    except RefusedError as error:
        done.set_exception(error)
    except BaseException as error:
        done.set_exception(error)
        raise
    else:
        done.set_result(None)
