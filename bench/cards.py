"""Cards for the figures."""

from pathlib import Path

from openacr.controller import Controller
from openacr.models import ACR9040
from openacr.plant.describe import schema

ROOT = Path(__file__).parents[1]
GANTRY = ROOT / "examples" / "gantry"
NAMES = "XYZABCUVWDEGHKLM"
SETTLE_S = 0.1


def gantry() -> Controller:
    """The gantry with both programs running."""
    card = Controller.from_project(GANTRY)
    card.send("PROG0\rRUN\rPROG1\rRUN\r")
    return card


def many_axes(count: int = 16, speed: float = 100.0) -> Controller:
    """A card with that many modelled axes, at P00 of one master, drives on."""
    default = schema.default_world(ACR9040)
    axes = tuple(
        schema.Axis(
            number=number, drive=default.axis[0].drive, encoder_lines=default.axis[0].encoder_lines
        )
        for number in range(count)
    )
    card = Controller(ACR9040, world=schema.World(card=default.card, axis=axes))
    lines = ["PROG0", "ATTACH MASTER0"]
    lines += [f'ATTACH SLAVE{n} AXIS{n} "{name}"' for n, name in enumerate(NAMES[:count])]
    names = NAMES[:count]
    lines += ["PPU " + "".join(f" {name}1000" for name in names)]
    lines += [f"ACC 1000 DEC 1000 STP 1000 VEL {speed:g}", "DRIVE ON " + " ".join(names)]
    for kind, value in (("VEL", speed), ("ACC", 1000), ("DEC", 1000)):
        lines.append(f"JOG {kind} " + " ".join(f"{name}{value:g}" for name in names))
    type_lines(card, *lines)
    card.advance(seconds=SETTLE_S)
    return card


def type_lines(card: Controller, *lines: str) -> None:
    """Type lines that the card must accept."""
    for line in lines:
        answer = card.send(line + "\r")
        if answer.count("\r\n") != 1:
            raise RuntimeError(answer)


def move_all(card: Controller, count: int = 16, to: float = 1e6) -> None:
    """Start one coordinated move of all axes that lasts longer than any measurement."""
    type_lines(card, " ".join(f"{name}{to:g}" for name in NAMES[:count]))


def jog_all(card: Controller, first: int, behind: int) -> None:
    """Jog some axes for ever."""
    type_lines(card, "JOG FWD " + " ".join(NAMES[first:behind]))
