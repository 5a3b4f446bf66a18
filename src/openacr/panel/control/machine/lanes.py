"""What a picture of the history shows: what moved, ran or was on, to the tick.

The engine notes changes of flags and which setpoints moved (`Controller.log_changes`); a branch
keeps them as arrays. What is on in a lane, and for how long, is computed from these arrays, which
never change: any thread may do it.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np

from openacr.controller import Controller
from openacr.controller.changes import MOVED, Changes, Integers
from openacr.map import numbers as at
from openacr.map.rows import axes, network_slaves
from openacr.map.words import af4, candi, cando, mf1, pf, plf

MOST_CHANGES = 200_000  # of one branch, 16 bytes each; of more, the oldest are forgotten
TOGETHER, PART_CHANGES = 256, 10_000  # parts that are joined, and their changes
NEAR = 1000  # part of what is shown in which two spans are one
ALL = -1
AXES = range(len(axes.psp_cnt))
BITS = 32
BOARDS = 4  # expansion boards, an input and an output word each


class Kind(NamedTuple):
    """Lanes of one kind: their words with the mask of what is on, or all flags of the words."""

    name: str
    words: Sequence[int]
    mask: int = ALL  # ALL: a lane for each flag


def kinds(card: Controller) -> Iterator[Kind]:
    """The kinds of lanes that a card can have, with the words that it has."""
    model, world = card.model, card.world
    masters, drives = mf1.word[: model.masters], af4.word[: model.axes]
    programs = pf.word[: model.programs]
    yield Kind("master", masters, mf1.IN_MOTION)
    yield Kind("hold", masters, mf1.IN_FEEDHOLD)
    yield Kind("program", programs, pf.PROGRAM_RUNNING)
    yield Kind("pause", programs, pf.PAUSE_MODE)
    yield Kind("plc", plf.word[: model.plcs], plf.PLC_RUNNING)
    yield Kind("drive", drives, af4.DRIVE_ENABLED)
    yield Kind("kill", drives, af4.KILL_ALL_MOTION_REQUEST)
    boards = [at.XIOI_WORD + at.XIOI_WORD_STRIDE * board for board in range(BOARDS)]
    nodes = () if world.canopen is None else world.canopen.node
    node_inputs = _of_nodes(candi.word, max((node.digital_inputs for node in nodes), default=0))
    node_outputs = _of_nodes(cando.word, max((node.digital_outputs for node in nodes), default=0))
    yield Kind("input", (at.W_INPUTS, *boards, *node_inputs))
    yield Kind("output", (at.W_OUTPUTS, *(word + 1 for word in boards), *node_outputs))


def _of_nodes(words: Sequence[int], most: int) -> Iterator[int]:
    """The words of the nodes of a network, in any place of which a node has `most` bits."""
    for node in range(0, len(words), network_slaves.SENT_SIZE):
        yield from words[node : node + -(-most // BITS)]


class Place(NamedTuple):
    """Where the state of a lane is: a logged word, or MOVED, and the bits that are on.

    A lane of a flag has the number of the flag, one on the board that of its line.
    """

    kind: str
    number: int
    word: int
    mask: int
    flag: int | None  # of the card; None where it is not one


class Logged:
    """What of a card is logged: words with masks, and where the states of the lanes are."""

    def __init__(self, axis_count: int, own: Iterable[Kind]) -> None:
        chosen = list(own)
        masks: dict[int, int] = {}
        for kind in chosen:
            for word in kind.words:
                masks[word] = masks.get(word, 0) | kind.mask
        self.words = list(masks.items())
        self.setpoints = list(axes.psp_cnt[:axis_count])
        index = {word: number for number, word in enumerate(masks)}
        self.places = [Place("axis", n, MOVED, 1 << n, None) for n in range(axis_count)]
        for kind in chosen:
            for number, word in enumerate(kind.words):
                first = (word - at.FLAG_WORD_BASE) * BITS
                if kind.mask != ALL:
                    flag = first + (kind.mask & -kind.mask).bit_length() - 1
                    self.places.append(Place(kind.name, number, index[word], kind.mask, flag))
                    continue
                for bit in range(BITS):
                    line = first + bit if number else bit
                    self.places.append(Place(kind.name, line, index[word], 1 << bit, first + bit))

    @classmethod
    def of(cls, card: Controller) -> "Logged":
        """That of a card."""
        return cls(card.model.axes, kinds(card))


@dataclass(frozen=True, slots=True)
class Lane:
    """A lane of a part of the history: when it was on, in ticks, the end not included."""

    kind: str
    number: int
    flag: int | None
    spans: list[tuple[int, int]]
    on_tk: int  # in all, to the tick
    changes: int


@dataclass(slots=True)
class Course:
    """The changes of one branch, and what was on before the first of them."""

    logged: Logged
    first: int
    base: Integers  # values of the words, then of MOVED
    parts: list[Changes] = field(default_factory=list)
    loose: list[Changes] = field(default_factory=list)  # of the latest steps of the clock
    end: int = 0  # everything up to this tick is known

    def note(self, changes: Changes, tick: int) -> None:
        """What has changed up to a tick; what is known already is left out."""
        new = changes.after(self.end) if len(changes.ticks) else changes
        self.end = max(self.end, tick)
        if not len(new.ticks):
            return
        self.loose.append(new)
        loose = sum(len(each.ticks) for each in self.loose)
        if len(self.loose) >= TOGETHER or loose >= PART_CHANGES:
            self._join()

    def _join(self) -> None:
        together = Changes.joined(self.loose)
        words, values = together.words.astype(np.int32), together.values.astype(np.int32)
        self.parts.append(Changes(together.ticks, words, values))
        self.loose = []
        while sum(len(each.ticks) for each in self.parts) > MOST_CHANGES and len(self.parts) > 1:
            oldest = self.parts.pop(0)
            self.base = self.base.copy()
            self.base[oldest.words] = oldest.values  # MOVED is the last one
            self.first = int(oldest.ticks[-1])

    @property
    def changes(self) -> Changes:
        """All of them."""
        return Changes.joined([*self.parts, *self.loose])

    def until(self, tick: int) -> "Course":
        """What was known at a tick; the arrays are shared."""
        parts = [part.until(tick) for part in [*self.parts, *self.loose]]
        kept = [part for part in parts if len(part.ticks)]
        return Course(self.logged, self.first, self.base, kept, [], min(self.end, tick))

    @property
    def size_bytes(self) -> int:
        """What its changes take in memory."""
        return sum(each.size_bytes for each in [*self.parts, *self.loose])

    def copied(self) -> "Course":
        """As it is now, for another thread."""
        return replace(self, parts=list(self.parts), loose=list(self.loose))

    def lanes(
        self, first: int, last: int, hidden: frozenset[int] = frozenset(), near: int | None = None
    ) -> list[Lane]:
        """The lanes that are ever on or change on this branch, from a tick to another.

        `hidden` are programs without a lane; spans nearer to each other than `near` are one,
        of themselves a thousandth of the time.
        """
        near = (last - first) // NEAR if near is None else near
        changes = self.changes
        order = np.argsort(changes.words, kind="stable")
        words = changes.words[order]
        begin, end = max(first, self.first), min(last, self.end)
        found = []
        of_word: dict[int, tuple[Integers, Integers]] = {}
        for place in self.logged.places:
            if place.word not in of_word:
                low, high = np.searchsorted(words, [place.word, place.word + 1])
                chosen = order[low:high]
                of_word[place.word] = changes.ticks[chosen], changes.values[chosen]
            if place.kind in ("program", "pause") and place.number in hidden:
                continue
            ticks, values = of_word[place.word]
            was_on = bool(self.base[place.word] & place.mask)
            is_on = (values & place.mask) != 0
            turned = is_on != np.concatenate(([was_on], is_on[:-1]))
            edges = ticks[turned]
            if not len(edges) and (not was_on or place.kind in ("input", "output")):
                continue
            found.append(_lane(place, edges, was_on, begin, end, near))
        return found


def _lane(place: Place, edges: Integers, was_on: bool, first: int, last: int, near: int) -> Lane:
    """The lane of the ticks at which a state turned."""
    low, high = np.searchsorted(edges, [first, last], "right")
    if was_on ^ bool(low % 2):
        edges, low = np.concatenate((edges[:low], [first], edges[low:high])), low
    else:
        edges = edges[:high]
    inside = edges[low:]
    changes = int(high - low)
    if len(inside) % 2:
        inside = np.concatenate((inside, [max(last, first)]))
    starts, ends = inside[::2], inside[1::2]
    on_tk = int((ends - starts).sum())
    if len(starts):
        apart = starts[1:] - ends[:-1] > near
        starts = starts[np.concatenate(([True], apart))]
        ends = ends[np.concatenate((apart, [True]))]
    spans = [(a, b) for a, b in zip(starts.tolist(), ends.tolist(), strict=True) if b > a]
    return Lane(place.kind, place.number, place.flag, spans, on_tk, changes)


class Lanes:
    """What has happened on each branch of the history of a card."""

    def __init__(self, card: Controller) -> None:
        self._card = card
        self._courses: dict[int, Course] = {}
        self._logged = Logged.of(card)
        card.log_changes(self._logged.words, self._logged.setpoints)
        self._courses[0] = self._begun()

    def _begun(self) -> Course:
        tick = self._card.lived_tk
        base: Any = np.array([*self._card.logged(), 0], np.int64)
        return Course(self._logged, tick, base, end=tick)

    @property
    def outputs(self) -> list[int]:
        """The words of the outputs."""
        own = (each.word for each in self._logged.places if each.kind == "output")
        return [self._logged.words[index][0] for index in dict.fromkeys(own)]

    def look(self, branch: int) -> None:
        """Keep what was noted since the last look, if it is new."""
        self._courses[branch].note(self._card.take_changes(), self._card.lived_tk)

    def of(self, branch: int) -> Course:
        """What has happened on a branch, for any thread."""
        return self._courses[branch].copied()

    def fork(self, parent: int, branch: int, tick: int) -> None:
        """Another branch has begun: it shares what was before."""
        self.look(parent)
        self._courses[branch] = self._courses[parent].until(tick)

    def forget(self, branch: int) -> None:
        """Forget a branch."""
        self._courses.pop(branch, None)

    @property
    def size_bytes(self) -> int:
        """What is kept in memory; what branches share counts once."""
        parts = {
            id(part): part.size_bytes
            for course in self._courses.values()
            for part in [*course.parts, *course.loose]
        }
        return sum(parts.values())
