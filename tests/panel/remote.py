"""A station on a card at the end of a link, for tests in real time."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from tests.waiting import until

from openacr.panel.commands.all import carry_out
from openacr.panel.control.machine.installation import Installation
from openacr.panel.control.operator.orders import Order
from openacr.panel.control.operator.people import Person
from openacr.panel.control.station import Station
from openacr.panel.control.thread import ControlThread
from openacr.panel.machine import opened
from openacr.panel.roles import Role

ME = Person(1, Role.SERVICE, "127.0.0.1")


class Remote:
    """The station of a card at the end of a link, in its control thread."""

    def __init__(
        self, address: str, folder: Path, *, is_agreed: bool = True, is_awaited: bool = True
    ) -> None:
        (folder / "programs").mkdir(exist_ok=True)
        self.installation = Installation.at(
            address, opened(folder / "sysvar.db"), folder / "programs"
        )
        self.installation.is_agreed = is_agreed
        self.station = Station(self.installation, carry_out)
        self.events: list[dict[str, Any]] = []
        self.station.screens.send = self.events.append
        self.control = ControlThread(self.station)
        self.control.start()
        joined = self.control.call(lambda station: station.join(ME))
        if is_awaited:
            joined.result(60.0)

    def call(self, work: Callable[[Station], Any]) -> Any:
        return self.control.call(work).result(60.0)

    def send(self, name: str, **args: Any) -> dict[str, Any]:
        answers: list[dict[str, Any]] = []
        self.control.put(Order(ME, name, args, self.control.now_s(), answers.append))
        until(lambda: bool(answers), about=name)
        return answers[0]

    def link(self) -> str:
        found = [event["link"] for event in self.events if event["event"] == "state"]
        return str(found[-1]) if found else ""

    def close(self) -> None:
        self.control.stop()
        self.installation.close()
