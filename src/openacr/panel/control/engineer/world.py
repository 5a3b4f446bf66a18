"""The world around the card for the screens: its drawing, inputs, faults and devices.

A card in this process shows and changes its world; of any other card only the positions are known.
"""

import logging
from dataclasses import asdict
from pathlib import Path
from typing import Any

from msgspec import structs

from openacr.controller import Controller
from openacr.errors import UserError
from openacr.panel.control.engineer.watchers import Watchers
from openacr.panel.control.machine.installation import Installation
from openacr.plant.describe.links import Link, Subject, links_of
from openacr.plant.describe.schema import Switch
from openacr.plant.world.world_view import Source, WorldView

log = logging.getLogger(__name__)
Data = dict[str, Any]
OUT_OF_REACH = (
    "the world of this card is out of reach: inputs, faults and devices can be changed"
    " for a card in the process of the panel only"
)


class WorldPane:
    """The world of one installation, and the browsers that watch it."""

    def __init__(self, installation: Installation) -> None:
        self._installation = installation
        self.watchers: Watchers[Data] = Watchers(lambda _client, _state: None)

    @property
    def card(self) -> Controller:
        """The card in this process; UserError for any other card."""
        if self._installation.controller is None:
            raise UserError(OUT_OF_REACH)
        return self._installation.controller

    def about(self, axes: list[Data]) -> Data:
        """What there is: links, inputs, faults, devices; elsewhere the links of `axes` only."""
        if self._installation.controller is None:
            links = links_of(map(_subject, axes))
            about: Data = {"inputs": [], "faults": [], "devices": [], "why_not": OUT_OF_REACH}
            return {"links": [_link(each, []) for each in links], **about}
        view = self.card.world_view
        of_axis = {link.axis: view.switches(link.axis) for link in view.links}
        return {
            "links": [_link(each, of_axis[each.axis]) for each in view.links],
            "inputs": [_input(each) for each in view.sources],
            "faults": [asdict(each) for each in view.choices],
            "devices": _devices(view),
            "why_not": "",
        }

    def file(self, axis: int) -> Path:
        """The file with the body of an axis; UserError where it has none."""
        card = self.card
        for link in card.world_view.links:
            if link.axis == axis and link.file and card.device_folder is not None:
                return card.device_folder / link.file
        raise UserError(f"axis {axis}: machine.toml names no file with its body")

    def forced(self) -> Data:
        """The inputs that are held by hand, those that can be, and why none can."""
        if self._installation.controller is None:
            return {"why_not": OUT_OF_REACH, "inputs": [], "forced": []}
        view = self.card.world_view
        sources = {each.flag: each.what for each in view.sources if each.is_driven}
        return {
            "why_not": "",
            "inputs": list(sources),
            "forced": [
                {"input": each.flag, "on": each.is_on, "what": sources[each.flag]}
                for each in view.inputs()
                if each.is_forced
            ],
        }

    # --- watching ---------------------------------------------------------------------

    def look(self, now_s: float) -> None:
        """Tell those who watch what has changed in the world of a card in this process."""
        if self._installation.controller is not None:
            self.watchers.look(self.state, now_s)

    def state(self) -> Data:
        """The state of the world at this moment."""
        now = self.card.world_view.now()
        return {
            "positions": list(now.positions),
            "on": [each.flag for each in now.inputs if each.is_on],
            "forced": [each.flag for each in now.inputs if each.is_forced],
            "faults": [asdict(each) for each in now.faults],
            "devices": [asdict(each) for each in now.devices],
        }

    # --- changing ---------------------------------------------------------------------

    def set_input(self, who: str, number: int, state: str) -> None:
        """Switch an input on or off by hand (one that is driven keeps that), or release it."""
        if state == "released":
            self.card.release_input(number)
        else:
            self.card.set_input(number, state == "on")
        log.info("%s: input %d is %s by hand", who, number, state)

    def release_all(self, who: str) -> int:
        """Release every input that is forced; how many there were."""
        forced = [each.flag for each in self.card.world_view.inputs() if each.is_forced]
        for number in forced:
            self.set_input(who, number, "released")
        return len(forced)

    def fault(self, who: str, axis: int, kind: str, value: float) -> None:
        """Cause a fault on an axis."""
        self.card.fault(axis, kind, value)
        log.info("%s: the fault %s (%g) of axis %d begins", who, kind, value, axis)

    def mend(self, who: str, axis: int, kind: str | None) -> None:
        """End one kind of fault of an axis, or all of them."""
        self.card.mend(axis, kind)
        log.info("%s: the fault %s of axis %d ends", who, kind or "(all)", axis)

    def command(self, who: str, device: str, name: str, value: float) -> None:
        """Give a command to a device by hand."""
        self.card.command(device, name, value)
        log.info("%s: %s of %s is %g by hand", who, name, device, value)


def _subject(axis: Data) -> Subject:
    """What is drawn of an axis of the store, as the screens know it."""
    has_ends = axis["low"] is not None and axis["low"] < axis["high"]
    ends = (axis["low"], axis["high"]) if has_ends else None
    return Subject(axis["index"], axis["name"], axis["unit"], ends)


def _link(link: Link, switches: list[Switch]) -> Data:
    """A link as the browser draws it; signs of switches are cut at the ends of the rail."""
    low, high = link.low, link.high
    signs = [
        {
            "input": each.input,
            "key": each.key,
            "contact": each.contact.value,
            "low": max(low, min(high, each.low_u * link.per_unit)),
            "high": max(low, min(high, each.high_u * link.per_unit)),
        }
        for each in switches
    ]
    return {**asdict(link), "switches": signs}


def _input(source: Source) -> Data:
    return {"input": source.flag, "what": source.what, "is_driven": source.is_driven}


def _devices(view: WorldView) -> list[Data]:
    return [
        {
            "name": each.table.label,
            "kind": each.table.kind,
            "by_hand": {name: each.device.COMMANDS[name].__name__ for name in each.free},
            "sign": each.table.sign and structs.asdict(each.table.sign),
        }
        for each in view.devices
    ]
