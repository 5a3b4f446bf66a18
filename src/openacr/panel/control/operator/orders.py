"""Orders of operators on their way to the control thread, and their answers, at once or later."""

from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass, field
from typing import Any, TypeVar

from openacr.client import ConnectionLostError
from openacr.client.errors import ChangedError
from openacr.errors import OpenacrError, SourceError
from openacr.mill.card.driver import LINK_ERRORS
from openacr.panel.control.operator.people import ControlError, Person
from openacr.panel.roles import Role

Answer = Callable[[dict[str, Any]], None]
T = TypeVar("T")


class PanelError(OpenacrError):
    """A command that is not carried out; `code` is for the browser, the text for the operator."""

    def __init__(self, code: str, text: str, **more: Any) -> None:
        super().__init__(text)
        self.code = code
        self.more = more


class RoleError(PanelError):
    """The role is too low."""

    def __init__(self, needs: Role) -> None:
        super().__init__("role", f"this needs the role {needs.word}", needs=needs.word)


@dataclass(frozen=True, slots=True)
class Order:
    """A command of one client, or a keep-alive (without a name)."""

    person: Person
    name: str
    args: dict[str, Any] = field(default_factory=dict)
    received_s: float = 0.0
    answer: Answer = lambda _answer: None


def failure(error: BaseException) -> dict[str, Any]:
    """An error as the browser gets it: code, text, and what helps to react."""
    if isinstance(error, PanelError):
        return {"code": error.code, "text": str(error), **error.more}
    if isinstance(error, ControlError):
        return {"code": "control", "text": str(error), "holder": error.holder.data()}
    if isinstance(error, (*LINK_ERRORS, ConnectionLostError)):
        return {"code": "lost", "text": f"the card does not answer: {error}"}
    if isinstance(error, ChangedError):
        return {"code": "conflict", "text": str(error)}
    if isinstance(error, SourceError):
        return {"code": "refused", "text": str(error), "line": error.line}
    if isinstance(error, OpenacrError):
        return {"code": "refused", "text": str(error)}
    return {"code": "internal", "text": f"the server has failed: {type(error).__name__}"}


class Later:
    """The answer of an order that is given once work that takes its time has been done."""


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
