"""Orders whose answer is given later, once work that takes its time has been done."""

from collections.abc import Callable
from concurrent.futures import Future
from typing import TypeVar

from openacr.panel.control.orders import Order, failure

T = TypeVar("T")


class Later:
    """The answer of an order that is given later."""


LATER = Later()


def answer_with(order: Order, future: "Future[T]", result: Callable[[T], object]) -> None:
    """Answer an order with what a future gets, or with its failure."""

    def answer(done: "Future[T]") -> None:
        error = done.exception()
        if error is None:
            order.answer({"ok": True, "result": result(done.result())})
        else:
            order.answer({"ok": False, "error": failure(error)})

    future.add_done_callback(answer)
