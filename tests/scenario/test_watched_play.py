"""A scenario played by what the engine watches comes out as one looked at in every tick."""

from collections.abc import Sequence
from contextlib import redirect_stdout
from dataclasses import dataclass
from io import StringIO
from pathlib import Path
from typing import Any

from hypothesis import given
from hypothesis import strategies as st
from tests.search import search

from openacr.cli.run.controlled import ControlledMachine
from openacr.cli.run.session import Options, Session
from openacr.controller import Controller
from openacr.project import Project, SourceFile
from openacr.scenario import Condition, Scenario, Verdict
from openacr.scenario.course import Until
from openacr.scenario.schema import Action, Drag, Expectation, Key, State

LIMIT_S = 0.6

# Two programs: one moves, prints and dwells, the other follows an input and counts; it also
# uses statements that need Python, jogs and, on request, restarts the card.
SETUP = """
SYS
DIM P(20)
DIM PROG0(5000)
DIM PROG1(5000)
PROG0
ATTACH MASTER0
ATTACH SLAVE0 AXIS0 "X"
ATTACH SLAVE1 AXIS1 "Y"
PPU X1000 Y500
PGAIN X0.002 Y0.002
FFVEL X0.00001 Y0.00001
DRIVE ON X Y
ACC 200 DEC 200 STP 200 VEL 20
PROGRAM
_AGAIN
X1 Y-1
PRINT "OUT"; P1
P1 = P1 + 0.5
X0 Y0
INH -516
SET 33
DWL 0.02
CLR 33
GOTO AGAIN
ENDP
PROG1
PROGRAM
_LOOK
INH 3
P2 = P2 + 1
PRINT "SEEN"
IF (P2 > 3) THEN P3 = 1 / 0
CLR 40
INH -3
SET 40
GOTO LOOK
ENDP
SYS
"""

bits = st.sampled_from([3, 4, 33, 40, 516, 768, 775, 800, 1024])
numbers = st.sampled_from([-2.0, -0.5, 0.0, 0.25, 0.5, 1.0, 2.0, 700.0])
times = st.integers(0, 500).map(lambda ms: ms / 1000)
texts = st.sampled_from(["OUT", "SEEN", "OUT 0.5", "P00>", "RUN", "Error", "2"])
typed = "PROG0\rRUN\r|PROG1\rRUN\r|PROG0\rHALT\r|PROG1\rLRUN\r|PROG0\rLIST\r|PROG0\rJOG ABS X0.5\r"
lines = st.sampled_from(
    [*typed.split("|"), "?P1\r", "SYS\rCLR 33\r", "SYS\rDIM P(30)\r", "REBOOT\r"]
)


@st.composite
def conditions(draw: st.DrawFn) -> Condition:
    """Anything that can be waited for."""
    kind = draw(st.sampled_from(["bit", "becomes", "axis", "parameter", "printed", "program"]))
    if kind == "bit":
        return Condition(bit=draw(bits), is_=draw(st.booleans()))
    if kind == "becomes":
        return Condition(bit=draw(bits), becomes=draw(st.booleans()))
    if kind == "printed":
        return Condition(printed=draw(texts))
    if kind == "program":
        return Condition(program=draw(st.integers(0, 2)), state=draw(st.sampled_from(State)))
    subject: dict[str, Any] = (
        {"axis": draw(st.integers(0, 1))}
        if kind == "axis"
        else {"parameter": draw(st.sampled_from([1, 2, 25, 3000, 6916, 8192, 12290, 12310, 7]))}
    )
    above, below = draw(st.sampled_from([(True, False), (False, True), (True, True)]))
    low, high = draw(numbers), draw(numbers)
    return Condition(**subject, above=low if above else None, below=high if below else None)


@st.composite
def moments(draw: st.DrawFn, names: Sequence[str]) -> dict[str, Any]:
    """When something is done or expected."""
    kind = draw(st.sampled_from(["time", "when", "after", "both"]))
    if kind == "time":
        return {"time_s": draw(times)}
    after = draw(st.sampled_from(["start", *names])) if kind in ("after", "both") else None
    when = draw(conditions()) if kind in ("when", "both") else None
    return {"after": after, "when": when, "delay_s": draw(st.sampled_from([0.0, 0.0, 0.003]))}


@st.composite
def actions(draw: st.DrawFn, names: Sequence[str], name: str) -> Action:
    """Something an operator does, and the name of that moment."""
    deed: dict[str, Any] = draw(
        st.one_of(
            st.sampled_from([{"set": (3,)}, {"clear": (3,)}, {"press": (3,), "press_s": 0.01}]),
            st.builds(lambda text: {"send": text}, lines),
            st.builds(lambda key: {"key": key}, st.sampled_from(Key)),
            st.just({"drag": Drag(0, 0.3, 0.01)}),
        )
    )
    return Action(**draw(moments(names)), **deed, checkpoint=name)


@st.composite
def expectations(draw: st.DrawFn, names: Sequence[str]) -> Expectation:
    """Something that tells one tick from another."""
    subject: dict[str, Any] = draw(
        st.sampled_from([{"axis": 0, "position": 0.5}, {"parameter": 6916, "is_": 100.0}])
    )
    return Expectation(**draw(moments(names)), **subject)


@st.composite
def scenarios(draw: st.DrawFn) -> Scenario:
    """A scenario with a few actions that start things, and some that wait for them."""
    names = [f"c{n}" for n in range(draw(st.integers(1, 6)))]
    at = [draw(actions(names[:index], name)) for index, name in enumerate(names)]
    starts = [Action(time_s=0.0, send="PROG0\rRUN\r"), Action(time_s=0.01, send="PROG1\rRUN\r")]
    expect = draw(st.lists(expectations(names), min_size=1, max_size=4))
    return Scenario(at=(*draw(st.permutations(starts)), *at), expect=tuple(expect))


class Patient(ControlledMachine):
    """Cannot watch: the run looks at every tick."""

    def watch(self, conditions: Sequence[Condition]) -> bool:
        super().watch(())
        return False


@dataclass(frozen=True)
class Outcome:
    """Everything that can come out of a run."""

    verdicts: list[Verdict]
    checkpoints: dict[str, int]
    said: str
    digest: str
    tick: int


def play(scenario: Scenario, until: Until | None, kind: type[ControlledMachine]) -> Outcome:
    source = SourceFile(Path("two.8k"), SETUP.encode())
    controller, refused = Controller.load(Project(Path("two.8k"), source))
    assert not refused
    machine = kind(controller)
    session = Session(Options(Path("two.8k"), LIMIT_S, until, is_quiet=True), machine, scenario)
    with redirect_stdout(StringIO()):
        session._prepare()
        session._live()
    played = session._play
    return Outcome(
        played.verdicts,
        played.checkpoints,
        played._printed,
        machine.digest(),
        machine.clock.lived_tk,
    )


@search(40)
@given(scenarios(), st.sampled_from([None, None, Until(), Until(33), Until(516, False)]))
def test_a_watched_scenario_comes_out_as_one_looked_at_in_every_tick(
    scenario: Scenario, until: Until | None
) -> None:
    assert play(scenario, until, ControlledMachine) == play(scenario, until, Patient)
