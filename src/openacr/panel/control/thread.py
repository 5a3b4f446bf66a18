"""The thread that owns a machine: it drains orders, lets the card's time pass, takes looks."""

import logging
import sys
import threading
import time
from collections import Counter, deque
from collections.abc import Callable, Hashable
from concurrent.futures import Future
from contextlib import suppress
from threading import Condition
from typing import Generic, TypeVar

from openacr.errors import OpenacrError
from openacr.mill.card.driver import LINK_ERRORS
from openacr.mill.session import MillSession
from openacr.panel.control.operator.orders import Order, PanelError, failure
from openacr.panel.control.station import Station

log = logging.getLogger(__name__)
T = TypeVar("T")
SWITCH_S = 0.0005  # how long another thread may compute before this one gets its turn
MOST_WAITING = 1000
MOST_OF_ONE = 100  # of a browser, without those that stop
MOST_STOPS = 8  # of a browser, of each kind: a finger on each key of an operator's screen
REST_S = 90.0  # longer than any wait of an ending
AGAIN_S = 10.0  # from one report of a failure to the next one of the same text
ORDERS_S = 0.005  # longest time of orders before the machine gets its step
URGENT = ("stop.hold", "stop.all", "stop.estop", "stop.drives", "jog.release", "jog.stop")

Work = Callable[[], None]


class Waiting(Generic[T]):
    """Two queues that any thread fills and one thread empties."""

    def __init__(self) -> None:
        self._ready = Condition()
        self._urgent: deque[tuple[T, Hashable]] = deque()
        self._others: deque[tuple[T, Hashable]] = deque()
        self._counts: Counter[Hashable] = Counter()  # what waits of each sender

    def __len__(self) -> int:
        return len(self._urgent) + len(self._others)

    @property
    def is_urgent(self) -> bool:
        """Whether an urgent item waits."""
        return bool(self._urgent)

    def put(
        self, item: T, *, is_urgent: bool = False, sender: Hashable = None, most: int | None = None
    ) -> bool:
        """Add an item; an urgent one is taken before all that are not.

        False, and nothing is added, where `most` of the sender wait already.
        """
        with self._ready:
            if most is not None and self._counts[sender] >= most:
                return False
            self._counts[sender] += 1
            (self._urgent if is_urgent else self._others).append((item, sender))
            self._ready.notify()
            return True

    def take(self, timeout_s: float = 0.0) -> T | None:
        """The next item, for which it waits up to `timeout_s`; None without one."""
        with self._ready:
            if timeout_s and not len(self):
                self._ready.wait(timeout_s)
            for queue in (self._urgent, self._others):
                if queue:
                    item, sender = queue.popleft()
                    self._counts[sender] -= 1
                    if not self._counts[sender]:
                        del self._counts[sender]
                    return item
        return None


class ControlThread:
    """Runs one station; everything that reaches it comes through a queue."""

    def __init__(self, station: Station, clock: Callable[[], float] = time.monotonic) -> None:
        self.station = station
        self._clock = clock
        self._orders: Waiting[Order | Work] = Waiting()
        station.link.is_awaited = lambda: self._orders.is_urgent or station.link.is_ending
        self._failure, self._failure_s = "", 0.0  # cause of the last one, and when it was said
        self._is_over = threading.Event()
        self._thread = threading.Thread(target=self._run, name="control", daemon=True)

    def start(self) -> None:
        """Start the thread; the machine is opened in it."""
        sys.setswitchinterval(SWITCH_S)
        self._thread.start()

    def now_s(self) -> float:
        """The clock that ages are counted by."""
        return self._clock()

    # --- from other threads -----------------------------------------------------------

    def put(self, order: Order) -> None:
        """Hand an order over; one that finds too many before it is refused, unless it stops.

        Of each browser a number of orders wait at most, also of those that stop.
        """
        client = order.person.client
        if order.name in URGENT:  # those that wait stop the same machine
            sender = client, order.name
            if not self._orders.put(order, is_urgent=True, sender=sender, most=MOST_STOPS):
                self._refuse(order, f"{order.name}: {MOST_STOPS} of this browser wait already")
        elif len(self._orders) >= MOST_WAITING:
            self._refuse(order, "too many commands wait: try again")
        elif not self._orders.put(order, sender=client, most=MOST_OF_ONE):
            self._refuse(order, f"{MOST_OF_ONE} commands of this browser wait already: try again")

    def _refuse(self, order: Order, text: str) -> None:
        order.answer({"ok": False, "error": failure(PanelError("busy", text))})

    def call(self, work: Callable[[Station], T]) -> "Future[T]":
        """Run a function in the control thread; its result or error is in the future."""
        future: Future[T] = Future()

        def run() -> None:
            if not future.set_running_or_notify_cancel():
                return
            try:
                future.set_result(work(self.station))
            except BaseException as error:
                future.set_exception(error)

        self._orders.put(run)
        return future

    def end_soon(self) -> None:
        """Open no card any more: what waits for the thread is answered before it ends."""
        self.station.link.is_ending = True

    def stop(self) -> None:
        """Bring the machine to rest and end the thread."""
        self.end_soon()
        self._is_over.set()
        self._orders.put(lambda: None)
        if self._thread.is_alive():
            self._thread.join(REST_S)

    # --- in the thread ----------------------------------------------------------------

    def _run(self) -> None:
        try:
            self.station.open(self._clock())
        except Exception as error:  # the steps try it again
            self._report(error)
        while not self._is_over.is_set():
            self.turn(self.station.installation.pace.idle_s)
        self.rest()

    def turn(self, idle_s: float) -> None:
        """Carry out what was ordered, then do what is due."""
        self._carry_out(idle_s)
        try:
            self.station.step(self._clock())
        except Exception as error:  # the machine must go on being watched
            self._report(error)

    def _report(self, error: Exception) -> None:
        """A step has failed: no key moves an axis, in the end nothing does, and it is said why."""
        cause = f"{type(error).__name__}: {error}"
        now_s = self._clock()
        is_new = cause != self._failure or now_s - self._failure_s >= AGAIN_S
        if is_new:
            self._failure, self._failure_s = cause, now_s
            log.error("a step of the control thread has failed", exc_info=error)
        try:
            self.station.fail(cause, is_new=is_new)
        except Exception:
            if is_new:
                log.exception("what moves the machine could not be ended")

    def _carry_out(self, idle_s: float) -> None:
        """Carry out orders that wait, for `ORDERS_S`; without any, wait for one up to `idle_s`."""
        order = self._orders.take(idle_s)
        end_s = self._clock() + ORDERS_S
        while order is not None:
            self._do(order)
            order = self._orders.take() if self._clock() < end_s else None

    def _do(self, order: Order | Work) -> None:
        try:
            if isinstance(order, Order):
                self.station.order(order, self._clock())
            else:
                order()
        except Exception:
            log.exception("an order has failed")

    def rest(self) -> None:
        """Bring the machine to rest, however the server ends."""
        station = self.station
        session = station.link.session
        try:
            station.times.wake(self._clock())
            if session is not None and session.is_set_up:
                _to_rest(session)
        except (OpenacrError, *LINK_ERRORS) as error:
            log.warning("%s", error)
        except Exception:  # what has failed is not known: the axes must not go on
            log.exception("the machine cannot be brought to rest: its power is cut")
            if session is not None and session.is_set_up:
                with suppress(Exception):
                    session.runner.cut_power()
        finally:
            station.close()
            station.jobs.close()


def _to_rest(session: MillSession) -> None:
    """Bring a machine to rest; its power is cut when that takes too long."""
    session.runner.bring_to_rest()
    end_s = session.card.now_s() + REST_S
    while session.runner.is_busy and not session.runner.is_out_of_reach:
        if session.card.now_s() > end_s:
            session.runner.cut_power()
            break
        session.step()
