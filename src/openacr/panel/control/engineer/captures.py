"""Captures of the scope on one machine: where their samples come from, how they begin and end."""

from collections.abc import Callable, Iterator, Sequence
from typing import Any

from openacr.errors import OpenacrError
from openacr.map import Flag, Parameter
from openacr.mill.card.driver import LINK_ERRORS
from openacr.mill.session import MillSession
from openacr.panel.control.engineer.card_sampler import CardSampler
from openacr.panel.control.engineer.sampling import Sampling, source_of
from openacr.panel.control.engineer.scope import Capture, Samples, Scope, Trigger
from openacr.panel.control.machine.link import Link
from openacr.panel.control.operator.orders import PanelError
from openacr.panel.control.operator.people import People


class Captures:
    """The capture under way and its source."""

    def __init__(
        self, link: Link, scope: Scope, people: People, say: Callable[[str], None]
    ) -> None:
        self._link, self._scope, self._people, self._say = link, scope, people, say
        self.sampling = source_of(link.installation)

    def source(self, program: int | None) -> Sampling:
        """What will sample: the arrays of a program of a card over a link, if one is given."""
        installation = self._link.installation
        if program is None or installation.is_virtual:
            return source_of(installation)
        is_serial = installation.kind == "serial"
        return CardSampler(self._link.required, program, is_serial=is_serial)

    def require_free(self, client: int) -> None:
        """PanelError while the scope samples for another client that is connected."""
        capture = self._scope.running
        owner = None if capture is None else self._people.person(capture.owner)
        if owner is not None and owner.client != client:
            who = f"{owner.data()['name']} ({owner.address})"
            raise PanelError(
                "taken", f"the scope samples for {who}: wait until it stops, or take it"
            )

    def arm(
        self,
        sampling: Sampling,
        channels: Sequence[Parameter | Flag],
        period_s: float,
        samples: int,
        trigger: Trigger | None,
        owner: int | None = None,
    ) -> Capture:
        """Begin a capture, in place of the one under way."""
        self.stop()
        self.sampling = sampling
        capture = self._scope.arm(channels, period_s, samples, trigger, owner)
        try:
            sampling.begin(self._scope)
        except OpenacrError:
            self.stop()
            raise
        return capture

    def stop(self) -> None:
        """End the capture; its last samples are sent with the next snapshot."""
        self.sampling.collect(self._scope)
        self._scope.stop()
        self.sampling.end()

    def step(self, session: MillSession, now_s: float) -> None:
        """Read what is due; a refusal of the card ends the capture."""
        try:
            self.sampling.step(session, self._scope, now_s)
        except LINK_ERRORS:
            raise
        except OpenacrError as error:
            self.stop()
            self._say(f"the scope has ended: {error}")

    def data(self) -> dict[str, Any]:
        """The capture and who has begun it; its samples are frames."""
        capture = self._scope.capture
        if capture is None:
            return {"running": False}
        owner = self._people.person(capture.owner)
        return {**capture.data(), "owner": None if owner is None else owner.data()["name"]}

    def samples(self) -> Iterator[Samples]:
        """The samples that were not sent yet."""
        self.sampling.collect(self._scope)
        while (samples := self._scope.take()) is not None:
            yield samples
