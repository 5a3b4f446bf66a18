"""Play a scenario against a running card, by its tick and nothing else.

`Play.step` is called with the card at rest between two ticks. It performs what is due,
actions before expectations, each in the order of the file. `Play.next_tick` says how far
the card may run at most before the next call; a change that may decide one of
`Play.conditions` must be followed by a call in the tick in which it occurs.
"""

from collections.abc import Iterator
from dataclasses import dataclass

from openacr.scenario.judge import Verdict, condition_text, judge, never
from openacr.scenario.rules import END, START
from openacr.scenario.schema import Action, Condition, Expectation, Scenario
from openacr.scenario.world import Surroundings, World


@dataclass(slots=True, eq=False)
class _Pending:
    """One entry that has not been performed yet, and its progress."""

    item: Action | Expectation
    due_tk: int | None = None
    is_watched: bool = False
    was_false: bool = False
    is_repeated: bool = False
    heard_from: int = 0


@dataclass(slots=True)
class _Pull:
    """A load that is being moved by hand, a little in every tick."""

    axis: int
    by_u: float
    end_tk: int


class Play:
    """A scenario being played in a run."""

    def __init__(self, scenario: Scenario, period_s: float) -> None:
        self._period_s = period_s
        items: list[Action | Expectation] = [*scenario.at, *_timed(scenario)]
        self._pending = [_Pending(item) for item in items]
        self._at_end = [item for item in scenario.expect if _belongs_to_end(item)]
        self._releases: list[tuple[int, int]] = []
        self._pulls: list[_Pull] = []
        self._printed = ""
        self.checkpoints: dict[str, int] = {START: 0}
        self.verdicts: list[Verdict] = []
        for pending in self._pending:
            self._prepare(pending)

    @property
    def failures(self) -> list[Verdict]:
        """The expectations that were not met."""
        return [verdict for verdict in self.verdicts if not verdict.ok]

    @property
    def unjudged(self) -> list[str]:
        """Expectations that the run ended before: their moments."""
        waiting = [p.item for p in self._pending if isinstance(p.item, Expectation)]
        return [item.name or _moment_text(item) for item in (*waiting, *self._at_end)]

    @property
    def idle_actions(self) -> list[str]:
        """Actions whose moment has not occurred."""
        waiting = (
            p.item for p in self._pending if isinstance(p.item, Action) and not p.is_repeated
        )
        return [_moment_text(action) for action in waiting]

    def heard(self, text: str) -> None:
        """Record text printed by the card."""
        self._printed += text

    @property
    def conditions(self) -> tuple[Condition, ...]:
        """The conditions currently waited for."""
        whens = (p.item.when for p in self._pending if p.is_watched)
        return tuple(when for when in whens if when is not None)

    def next_tick(self, now_tk: int) -> int | None:
        """The tick of the next call if nothing happens earlier; None when no time is known."""
        if self._pulls:
            return now_tk + 1
        known = [p.due_tk for p in self._pending if p.due_tk is not None]
        known += [tick for tick, _ in self._releases]
        return max(now_tk + 1, min(known)) if known else None

    def step(self, world: World) -> None:
        """Do everything that is due now; one checkpoint may make others due at once."""
        for release in [r for r in self._releases if r[0] <= world.tick]:
            self._releases.remove(release)
            world.surroundings.release_input(release[1])
        self._pull(world)
        while any(self._look(pending, world) for pending in self._pending):
            pass  # evaluated from the start again, to keep the order of the file

    def finish(self, world: World) -> None:
        """End the run: judge expectations of the end and those that never occurred."""
        self.checkpoints[END] = world.tick
        for pending in self._pending:
            if isinstance(pending.item, Expectation):
                self.verdicts.append(never(pending.item, _moment_text(pending.item)))
        self._pending = [p for p in self._pending if isinstance(p.item, Action)]
        for item in self._at_end:
            self._judge(item, world)
        self._at_end = []

    def _pull(self, world: World) -> None:
        for pull in self._pulls:
            world.surroundings.drag(pull.axis, pull.by_u)
        self._pulls = [pull for pull in self._pulls if pull.end_tk > world.tick]

    def _ticks(self, seconds: float) -> int:
        return round(seconds / self._period_s)

    def _prepare(self, pending: _Pending) -> None:
        """Set a timed entry to its tick; start to watch one that waits for nothing else."""
        item = pending.item
        if item.time_s is not None:
            pending.due_tk = self._ticks(item.time_s)
        elif item.after is None or item.after in self.checkpoints:
            self._arm(pending, self.checkpoints.get(item.after or START, 0))

    def _arm(self, pending: _Pending, tick: int) -> None:
        pending.heard_from = len(self._printed)
        if pending.item.when is None:
            pending.due_tk = tick + self._ticks(pending.item.delay_s)
        else:
            pending.is_watched = True

    def _look(self, pending: _Pending, world: World) -> bool:
        """Perform one entry if its moment is now; True when it was."""
        if pending.is_watched and self._has_come(pending, world):
            due_tk = world.tick + self._ticks(pending.item.delay_s)
            if isinstance(pending.item, Action) and pending.item.every:
                self._repeat(pending, due_tk)
                return False
            pending.is_watched = False
            pending.due_tk = due_tk
        if pending.due_tk is None or pending.due_tk > world.tick:
            return False
        self._pending.remove(pending)
        if isinstance(pending.item, Action):
            self._act(pending.item, world)
        else:
            self._judge(pending.item, world)
        return True

    def _repeat(self, pending: _Pending, due_tk: int) -> None:
        """Enter one occurrence of a repeated action beside it, and wait for the next."""
        self._pending.insert(self._pending.index(pending) + 1, _Pending(pending.item, due_tk))
        pending.heard_from, pending.was_false = len(self._printed), False
        pending.is_repeated = True

    def _has_come(self, pending: _Pending, world: World) -> bool:
        condition = pending.item.when
        if condition is None:
            return True
        holds = self._holds(condition, world, self._printed[pending.heard_from :])
        is_again = pending.is_repeated and condition.printed is None
        if condition.becomes is None and not is_again:
            return holds
        came = holds and pending.was_false
        pending.was_false = pending.was_false or not holds
        return came

    def _holds(self, condition: Condition, world: World, printed: str) -> bool:
        if condition.bit is not None:
            wanted = condition.is_ if condition.becomes is None else condition.becomes
            return world.bit(condition.bit) is (wanted is not False)
        if condition.printed is not None:
            return condition.printed in printed
        if condition.program is not None:
            return world.program_state(condition.program) is condition.state
        if condition.axis is not None:
            value = world.position_u(condition.axis)
        else:
            value = world.read(condition.parameter or 0)
        above = condition.above is None or value > condition.above
        return above and (condition.below is None or value < condition.below)

    def _act(self, action: Action, world: World) -> None:
        _switch_inputs(action, world.surroundings)
        release = world.tick + max(1, self._ticks(action.press_s))
        self._releases += [(release, bit) for bit in action.press]
        if action.send is not None or action.key is not None:
            text = action.key.character if action.key else (action.send or "")
            world.type_text(text, action.stream)
        if action.drag is not None:
            ticks = max(1, self._ticks(action.drag.over_s))
            pull = _Pull(action.drag.axis, action.drag.by / ticks, world.tick + ticks - 1)
            world.surroundings.drag(pull.axis, pull.by_u)
            if pull.end_tk > world.tick:
                self._pulls.append(pull)
        _change_machine(action, world.surroundings)
        if action.checkpoint is not None:
            self._reach(action.checkpoint, world.tick)

    def _reach(self, checkpoint: str, tick: int) -> None:
        self.checkpoints[checkpoint] = tick
        for pending in self._pending:
            if pending.item.after == checkpoint:
                self._arm(pending, tick)

    def _judge(self, item: Expectation, world: World) -> None:
        self.verdicts.append(judge(item, world, self._printed, self.checkpoints, self._period_s))


def _belongs_to_end(item: Expectation) -> bool:
    return item.time_s is None and item.when is None and item.after is None


def _timed(scenario: Scenario) -> Iterator[Expectation]:
    return (item for item in scenario.expect if not _belongs_to_end(item))


def _moment_text(item: Action | Expectation) -> str:
    if item.time_s is not None:
        return f"at {item.time_s:g} s"
    parts = [f"after {item.after}"] if item.after else []
    parts += [f"when {condition_text(item.when)}"] if item.when else []
    return ", ".join(parts)


def _switch_inputs(action: Action, machine: Surroundings) -> None:
    for bit in (*action.set, *action.press):
        machine.set_input(bit, True)
    for bit in action.clear:
        machine.set_input(bit, False)
    for bit in action.release:
        machine.release_input(bit)


def _change_machine(action: Action, machine: Surroundings) -> None:
    if action.analog is not None:
        machine.set_analog(action.analog.input, action.analog.value)
    if (fault := action.fault) is not None:
        machine.fault(fault.axis, fault.kind.value, fault.value)
    if (mend := action.mend) is not None:
        machine.mend(mend.axis, None if mend.kind is None else mend.kind.value)
    if (command := action.command) is not None:
        machine.command(command.device, command.name, float(command.value))
