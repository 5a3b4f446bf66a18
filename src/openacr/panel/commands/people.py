"""Commands of operators among each other: control, names."""

from collections.abc import Callable
from typing import Annotated

from msgspec import Meta

from openacr.errors import UserError
from openacr.io.server import is_loopback
from openacr.panel.commands.registry import command
from openacr.panel.control.interlocks import Interlocks
from openacr.panel.control.machine.link import Link
from openacr.panel.control.operator.hand_motion import HandMotion
from openacr.panel.control.operator.people import People, Person
from openacr.panel.control.operator.presses import End
from openacr.panel.helps import Page
from openacr.panel.roles import Role

Name = Annotated[str, Meta(max_length=40, pattern=r"^[^\x00-\x1f]*$")]


@command(
    "control.take",
    needs_control=False,
    en="TAKE CONTROL",
    de="ÜBERNEHMEN",
    page=Page(
        "control",
        "Control",
        "One operator at a time has control of the machine. Others see everything and may stop it."
        " Control can be handed over or taken.",
        de=(
            "Bedienung",
            "Zu jeder Zeit bedient einer die Maschine. Andere sehen alles und dürfen sie"
            " anhalten. Die Bedienung kann übergeben oder übernommen werden.",
        ),
    ),
)
def take(
    client: int, people: People, hand_motion: HandMotion, *, force: bool = False
) -> dict[str, object]:
    """Take control of the machine."""
    before = people.take(client, force=force)
    if before is not None:
        hand_motion.presses.end_all(End.CONTROL, "another operator has taken control")
    return {"holder": people.data()["holder"]}


@command("control.give", needs_control=False)
def give(person: Person, people: People, hand_motion: HandMotion, *, client: int) -> None:
    """Hand control over to another operator."""
    people.give(person.client, client)
    hand_motion.presses.end_all(End.CONTROL, "control was handed over")


@command("control.release", needs_control=False, en="GIVE UP CONTROL", de="ABGEBEN")
def release(client: int, people: People, hand_motion: HandMotion) -> None:
    """Give control up."""
    if people.holder == client:
        hand_motion.presses.end_all(End.CONTROL, "control was given up")
    people.release(client)


@command("name", Role.VIEW, needs_control=False)
def name(client: int, people: People, *, name: Name) -> None:
    """Choose the name that others see."""
    people.rename(client, name.strip())


@command(
    "app.end",
    page=Page(
        "exit",
        "EXIT",
        "LEAVE leaves the screens and gives up control; END, at the computer of the controller,"
        " ends the controller program. What moves is brought to rest first, unless another operator"
        " has control.",
        de=(
            "ENDE",
            "VERLASSEN verlässt die Bildschirme und gibt die Bedienung ab; BEENDEN, am"
            " Computer der Steuerung, beendet das Steuerungsprogramm. Was sich bewegt,"
            " wird vorher angehalten, außer ein anderer bedient.",
        ),
    ),
)
def end(person: Person, link: Link, interlocks: Interlocks, on_end: Callable[[], None]) -> None:
    """EXIT: end the controller program; at rest, and from its own computer only."""
    if not is_loopback(person.address):
        raise UserError("the controller program is ended at its own computer")
    if link.session is not None and interlocks.is_moved:
        raise UserError("the machine is working: stop it first")
    on_end()
