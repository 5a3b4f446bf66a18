"""Who is at the screens, and which one operator has control of the machine."""

from dataclasses import dataclass, replace
from itertools import count
from typing import Any

from openacr.errors import UserError
from openacr.panel.roles import Role

_numbers = count(1)


def next_client() -> int:
    """The number of a client that connects: never one of another."""
    return next(_numbers)


@dataclass(frozen=True, slots=True)
class Person:
    """A browser or script that is connected."""

    client: int
    role: Role
    address: str
    name: str = ""

    def data(self) -> dict[str, Any]:
        """The person as others see it."""
        name = self.name or f"{self.role.word} {self.client}"
        return {
            "client": self.client,
            "name": name,
            "role": self.role.word,
            "address": self.address,
        }


class ControlError(UserError):
    """Another operator has control."""

    def __init__(self, holder: Person) -> None:
        super().__init__(f"{holder.data()['name']} has control of the machine")
        self.holder = holder


class People:
    """All people connected; at most one of them has control."""

    def __init__(self) -> None:
        self._people: dict[int, Person] = {}
        self._asking: list[int] = []
        self.holder: int | None = None
        self.mode = "auto"  # the screen that the operator is on

    def join(self, person: Person) -> None:
        """Add a browser that has connected."""
        self._people[person.client] = person

    def leave(self, client: int) -> None:
        """Remove a browser that has gone; its control is free."""
        self._people.pop(client, None)
        self._asking = [one for one in self._asking if one != client]
        if self.holder == client:
            self.holder = None

    def has(self, client: int) -> bool:
        """Whether a client is connected."""
        return client in self._people

    @property
    def clients(self) -> list[int]:
        """All who are connected."""
        return list(self._people)

    def person(self, client: int | None) -> Person | None:
        """A client that is connected."""
        return None if client is None else self._people.get(client)

    def name_of(self, person: Person) -> str:
        """The name of a person, as it is now."""
        return str(self._people.get(person.client, person).data()["name"])

    def rename(self, client: int, name: str) -> None:
        """Give a client the name that others see."""
        self._people[client] = replace(self._people[client], name=name)

    def require_control(self, client: int) -> None:
        """Take control if it is free; ControlError if another operator has it."""
        if self.holder is None and client in self._people:
            self.holder = client
        if self.holder != client:
            if self.holder is None:
                raise UserError("this connection is not known: connect again")
            raise ControlError(self._people[self.holder])

    def take(self, client: int, *, force: bool) -> int | None:
        """Take control; the former holder, None if there was none.

        Without force the holder is asked, and ControlError raised.
        """
        before = self.holder
        if before is not None and before != client and not force:
            if client not in self._asking:
                self._asking.append(client)
            raise ControlError(self._people[before])
        self._asking = [one for one in self._asking if one != client]
        self.holder = client
        return before if before != client else None

    def give(self, client: int, to: int) -> None:
        """Hand control over."""
        self.require_control(client)
        receiver = self._people.get(to)
        if receiver is None:
            raise UserError(f"client {to} is not connected")
        if receiver.role < Role.OPERATE:
            raise UserError(f"{receiver.data()['name']} may only view")
        self._asking = [one for one in self._asking if one != to]
        self.holder = to

    def release(self, client: int) -> None:
        """Give control up."""
        if self.holder == client:
            self.holder = None

    def data(self) -> dict[str, Any]:
        """Who has control, who asks for it, and who is connected."""
        people = self._people
        return {
            "holder": people[self.holder].data() if self.holder in people else None,
            "asking": [people[one].data() for one in self._asking if one in people],
            "clients": [person.data() for person in people.values()],
        }
