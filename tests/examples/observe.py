"""Watch an example: play its operator tick by tick and write down what happens."""

from dataclasses import dataclass, field
from pathlib import Path

from openacr.controller import Controller
from openacr.project import find_project
from openacr.scenario import Play, Verdict, load_scenario
from openacr.scenario.played import CardWorld, PlayedCard

EXAMPLES = Path(__file__).parents[2] / "examples"


@dataclass(frozen=True, slots=True)
class Event:
    """Flags that changed or a text that was printed, and where the axes were then."""

    time_s: float
    flags: frozenset[int] = frozenset()  # those that are set now
    risen: frozenset[int] = frozenset()
    fallen: frozenset[int] = frozenset()
    commanded_u: tuple[float, ...] = ()
    text: str = ""


@dataclass(slots=True)
class Observation:
    """A whole run: its events, its verdicts and the card as it is at the end."""

    card: Controller
    events: list[Event] = field(default_factory=list)
    verdicts: list[Verdict] = field(default_factory=list)

    def rises(self, flag: int) -> list[Event]:
        """The events at which a flag went on."""
        return [event for event in self.events if flag in event.risen]

    def falls(self, flag: int) -> list[Event]:
        """The events at which a flag went off."""
        return [event for event in self.events if flag in event.fallen]

    def spans_s(self, flag: int) -> list[float]:
        """How long a flag was on, each time it went on and off again."""
        pairs = zip(self.rises(flag), self.falls(flag), strict=False)
        return [fall.time_s - rise.time_s for rise, fall in pairs]

    @property
    def printed(self) -> str:
        """Everything that was printed."""
        return "".join(event.text for event in self.events)


@dataclass(frozen=True, slots=True)
class Watch:
    """What to look at in an example."""

    example: str
    flags: tuple[int, ...]
    axes: int
    scenario: str = "scenario.toml"
    expected: str = "trace.txt"

    @property
    def project(self) -> Path:
        """The folder of the example."""
        return EXAMPLES / self.example

    @property
    def golden(self) -> Path:
        """The text this example is compared with."""
        return Path(__file__).parent / self.example / "expected" / self.expected


def load(example: str) -> Controller:
    """The card of an example with all its files loaded."""
    return Controller.from_project(EXAMPLES / example)


def observe(watch: Watch) -> Observation:
    """Play the whole scenario of an example."""
    controller, refused = Controller.load(find_project(watch.project))
    assert not refused, [str(error) for error in refused]
    machine = PlayedCard(controller)
    scenario = load_scenario(watch.project / watch.scenario)
    play, world = Play(scenario, machine.clock.period_s), CardWorld(machine)
    found = Observation(controller)

    def hear(text: str) -> None:
        play.heard(text)
        found.events.append(Event(controller.time_s, text=text))

    machine.listen(hear, hear)
    before = frozenset[int]()
    for _ in range(round((scenario.duration_s or 0.0) / machine.clock.period_s)):
        play.step(world)
        machine.advance(1)
        now = frozenset(flag for flag in watch.flags if controller.bit[flag])
        if now != before:
            places = tuple(controller.axis(axis).commanded_u for axis in range(watch.axes))
            risen, fallen = now - before, before - now
            found.events.append(Event(controller.time_s, now, risen, fallen, places))
            before = now
    play.finish(world)
    found.verdicts = play.verdicts
    return found


def trace(found: Observation, watch: Watch) -> str:
    """The events of a run as text: ticks of time, thousandths of a unit, printed lines."""
    lines = [
        _printed(event) if event.text else _changed(event)
        for event in found.events
        if event.risen or event.fallen or event.text.strip()
    ]
    final = " ".join(
        f"{found.card.axis(axis).commanded_u:.3f}/{found.card.axis(axis).actual_u:.3f}"
        for axis in range(watch.axes)
    )
    return "\n".join([*lines, f"end {found.card.time_s:.4f}  {final}", ""]).replace(
        "-0.000", "0.000"
    )


def _printed(event: Event) -> str:
    return f"{event.time_s:9.4f}  {event.text.strip()!r}"


def _changed(event: Event) -> str:
    changes = [f"+{flag}" for flag in sorted(event.risen)]
    changes += [f"-{flag}" for flag in sorted(event.fallen)]
    places = " ".join(f"{place:.3f}" for place in event.commanded_u)
    return f"{event.time_s:9.4f}  {' '.join(changes):28}  {places}"
