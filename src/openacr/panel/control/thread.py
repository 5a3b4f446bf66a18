"""The thread that owns a machine: it drains orders, lets the card's time pass, takes looks."""

import logging
import sys
import threading
import time
from collections.abc import Callable
from concurrent.futures import Future
from queue import Empty, Queue
from typing import TYPE_CHECKING, TypeVar

from openacr.errors import OpenacrError
from openacr.mill.card.driver import LINK_ERRORS
from openacr.panel.control.orders import Order, PanelError, failure

if TYPE_CHECKING:
    from openacr.panel.control.desk import Desk

log = logging.getLogger(__name__)
T = TypeVar("T")
SWITCH_S = 0.0005  # how long another thread may compute before this one gets its turn
MOST_WAITING = 1000
REST_S = 90.0  # longer than any wait of an ending
URGENT = ("stop.", "jog.release", "jog.stop")

Work = Callable[[], None]


class ControlThread:
    """Runs one desk; everything that reaches it comes through a queue."""

    def __init__(self, desk: "Desk", clock: Callable[[], float] = time.monotonic) -> None:
        self.desk = desk
        self._clock = clock
        self._orders: Queue[Order | Work] = Queue()
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
        """Hand an order over; one that finds too many before it is refused, unless it stops."""
        if self._orders.qsize() >= MOST_WAITING and not order.name.startswith(URGENT):
            busy = PanelError("busy", "too many commands wait: try again")
            order.answer({"ok": False, "error": failure(busy)})
            return
        self._orders.put(order)

    def call(self, work: Callable[["Desk"], T]) -> "Future[T]":
        """Run a function in the control thread; its result or error is in the future."""
        future: Future[T] = Future()

        def run() -> None:
            if not future.set_running_or_notify_cancel():
                return
            try:
                future.set_result(work(self.desk))
            except BaseException as error:
                future.set_exception(error)

        self._orders.put(run)
        return future

    def stop(self) -> None:
        """Bring the machine to rest and end the thread."""
        self._is_over.set()
        self._orders.put(lambda: None)
        if self._thread.is_alive():
            self._thread.join(REST_S)

    # --- in the thread ----------------------------------------------------------------

    def _run(self) -> None:
        self.desk.open(self._clock())
        while not self._is_over.is_set():
            self.turn(self.desk.bench.pace.idle_s)
        self.rest()

    def turn(self, idle_s: float) -> None:
        """Carry out what was ordered, then do what is due."""
        self._drain(idle_s)
        try:
            self.desk.step(self._clock())
        except Exception:  # the machine must go on being watched
            log.exception("a step of the control thread has failed")

    def _drain(self, idle_s: float) -> None:
        """Carry out the orders that wait; without any, wait for one as long as nothing is due."""
        try:
            order = self._orders.get(timeout=idle_s) if idle_s else self._orders.get_nowait()
        except Empty:
            return
        while True:
            self._do(order)
            try:
                order = self._orders.get_nowait()
            except Empty:
                return

    def _do(self, order: Order | Work) -> None:
        try:
            if isinstance(order, Order):
                self.desk.order(order, self._clock())
            else:
                order()
        except Exception:
            log.exception("an order has failed")

    def rest(self) -> None:
        """Bring the machine to rest, however the server ends."""
        desk = self.desk
        shop = desk.shop
        try:
            if shop is not None:
                shop.runner.bring_to_rest()
                end_s = shop.card.now_s() + REST_S
                while shop.runner.is_busy and not shop.runner.is_out_of_reach:
                    if shop.card.now_s() > end_s:
                        shop.runner.cut_power()
                        break
                    shop.step()
        except (OpenacrError, *LINK_ERRORS) as error:
            log.warning("%s", error)
        finally:
            desk.close()
            desk.jobs.close()
