"""Where samples of a machine come from."""

from openacr.panel.control.engineer.card_sampler import CardSampler
from openacr.panel.control.engineer.recorder import Recorder
from openacr.panel.control.engineer.sampling import Polled, Recorded, Sampling
from openacr.panel.control.machine.link import Link


class Sources:
    """The sources of one machine: those of a card in this process share its recorder."""

    def __init__(self, link: Link) -> None:
        self._link = link
        controller = link.installation.controller
        self._recorder = None if controller is None else Recorder(controller)

    def source(self, program: int | None = None) -> Sampling:
        """The engine of a card in this process; else the arrays of a program, or polls."""
        if self._recorder is not None:
            return Recorded(self._recorder)
        if program is None:
            return Polled()
        is_serial = self._link.installation.kind == "serial"
        return CardSampler(self._link.required, program, is_serial=is_serial)
