"""Captures of the scope on one machine: where their samples come from, how they begin and end.

A card in this process is sampled for several clients at once, each with channels of its own. A
card at the end of a link has one capture, since it has one sampler and one link.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

from openacr.errors import OpenacrError, UserError
from openacr.map import Flag, Parameter
from openacr.mill.card.driver import LINK_ERRORS
from openacr.mill.session import MillSession
from openacr.panel.control.engineer.sampling import Sampling
from openacr.panel.control.engineer.scope import Capture, Samples, Scope, Trigger
from openacr.panel.control.engineer.sources import Sources
from openacr.panel.control.machine.link import Link
from openacr.panel.control.operator.orders import PanelError
from openacr.panel.control.operator.people import People

MOST = 4  # captures at once
AWAY_S = 60.0  # how long a capture waits for a client whose connection was cut
SHARED = 0  # every client, where there is one capture


@dataclass(slots=True)
class Own:
    """The scope of one client, and what samples for it."""

    sampling: Sampling
    scope: Scope = field(default_factory=Scope)
    left_s: float | None = None  # when its client was seen to have gone

    def stop(self) -> None:
        """End the capture; its last samples are sent with the next snapshot."""
        self.sampling.collect(self.scope)
        self.scope.stop()
        self.sampling.end()


class Captures:
    """The captures by client."""

    def __init__(
        self, link: Link, sources: Sources, people: People, say: Callable[[str], None]
    ) -> None:
        self._sources, self._people, self._say = sources, people, say
        self.is_shared = not link.installation.is_virtual
        self._all: dict[int, Own] = {}
        self._number = 0  # of the latest capture

    def of(self, client: int) -> Own:
        """The scope of a client; of a card at the end of a link there is one for all."""
        return self._all.setdefault(self._key(client), Own(self._sources.source()))

    def _key(self, client: int) -> int:
        return SHARED if self.is_shared else client

    def require_free(self, client: int) -> None:
        """PanelError while the one scope samples for another client that is connected."""
        own = self._all.get(self._key(client))
        capture = None if own is None else own.scope.running
        owner = None if capture is None else self._people.person(capture.owner)
        if owner is not None and owner.client != client:
            who = f"{owner.data()['name']} ({owner.address})"
            raise PanelError(
                "taken", f"the scope samples for {who}: wait until it stops, or take it"
            )

    def period_s(self, wanted_s: float, program: int | None) -> float:
        """The time between two samples that is nearest to a wanted one."""
        return self._sources.source(program).period_s(wanted_s)

    def arm(
        self,
        client: int,
        channels: Sequence[Parameter | Flag],
        period_s: float,
        samples: int,
        trigger: Trigger | None = None,
        program: int | None = None,
    ) -> Capture:
        """Begin a capture, in place of the client's own; UserError where too many are under way."""
        self._make_room(client)
        own = self.of(client)
        own.stop()
        own.sampling = self._sources.source(program)
        capture = own.scope.arm(channels, period_s, samples, trigger, client)
        self._number += 1
        capture.number = self._number
        try:
            own.sampling.begin(own.scope)
        except OpenacrError:
            own.stop()
            raise
        return capture

    def _make_room(self, client: int) -> None:
        """End what has no client any more, where there is no room for one more."""
        others = {key: own for key, own in self._all.items() if key != self._key(client)}
        for key, own in others.items():
            if own.scope.running is None and not self._people.has(key):
                del self._all[key]
        running = {key: own for key, own in others.items() if own.scope.running is not None}
        for key in [each for each in running if not self._people.has(each)]:
            if len(running) >= MOST:
                running.pop(key).stop()
                del self._all[key]
        if len(running) >= MOST:
            raise UserError(
                f"the scope samples for {MOST} clients already: one of them has to stop"
            )

    def resume(self, client: int, number: int) -> Capture:
        """A client that was connected before takes its capture up again; UserError without it."""
        for key, own in self._all.items():
            capture = own.scope.capture
            if capture is None or capture.number != number:
                continue
            if capture.owner != client and self._people.has(capture.owner or SHARED):
                break
            capture.owner = client
            self._all[self._key(client)] = self._all.pop(key)
            return capture
        raise UserError(f"capture {number} is not there any more: START begins another one")

    def stop(self, client: int | None = None) -> None:
        """End the capture of a client, or all of them."""
        for key, own in self._all.items():
            if client is None or key == self._key(client):
                own.stop()

    def step(self, session: MillSession, now_s: float) -> None:
        """Read what is due; a refusal of the card ends the capture."""
        for key, own in self._all.items():
            if key == SHARED or self._people.has(key):
                own.left_s = None
            elif own.left_s is None:
                own.left_s = now_s
            elif now_s > own.left_s + AWAY_S and own.scope.running is not None:
                own.stop()
            try:
                own.sampling.step(session, own.scope, now_s)
            except LINK_ERRORS:
                raise
            except OpenacrError as error:
                own.stop()
                self._say(f"the scope has ended: {error}")

    def data(self, client: int) -> dict[str, Any]:
        """The capture of a client and who has begun it; its samples are frames."""
        own = self._all.get(self._key(client))
        if own is None or own.scope.capture is None:
            return {"running": False}
        owner = self._people.person(own.scope.capture.owner)
        return {
            **own.scope.capture.data(),
            "owner": None if owner is None else owner.data()["name"],
        }

    def samples(self) -> Iterator[tuple[int | None, Samples]]:
        """The samples that were not sent yet, and to which client; None: to all."""
        for key, own in self._all.items():
            own.sampling.collect(own.scope)
            while (samples := own.scope.take()) is not None:
                yield None if self.is_shared else key, samples
