"""Random PLCs against an interpreter of a few lines, and compiled against plain Python."""

from dataclasses import dataclass, field

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.plc.rack import Rack, numbered

from openacr import compiled
from openacr.errors import CardError
from openacr.plc import scan_cy as scan
from openacr.plc.compile import compile_plc
from openacr.plc.scan_cy import plc_step

# Inputs, outputs, flags at the ends of words, and what timers, counters and latches write.
Instruction = tuple[str, object]
FLAGS = (0, 1, 2, 31, 32, 33, 63, 128, 8191, "TIM0", "CNT0", "KR0", "TIM1")
_flags = st.sampled_from(FLAGS)
_logic = st.one_of(
    st.tuples(
        st.sampled_from(["LD", "LD NOT", "AND", "AND NOT", "OR", "OR NOT", "OUT", "OUT NOT"]),
        _flags,
    ),
    st.tuples(st.sampled_from(["SET", "CLR"]), _flags),
)
_blocks = st.sampled_from([("AND LD", None), ("OR LD", None), ("NOT", None)])
_objects = st.sampled_from(
    [("TIM", "0 2"), ("TIM", "1 1"), ("CNT", "0 3"), ("CNT", "1"), ("KR", "0"), ("KR", "1")]
)
programs = st.lists(st.one_of(_logic, _logic, _logic, _blocks, _objects), max_size=40).map(
    lambda steps: [("LD", 0), *steps]
)
inputs = st.lists(st.integers(0, 7), min_size=1, max_size=12)


def texts(program: list[Instruction]) -> list[str]:
    return [f"{name} {'' if operand is None else operand}" for name, operand in program]


def is_sound(program: list[Instruction]) -> bool:
    try:
        compile_plc(numbered(*texts(program)))
    except CardError:
        return False
    return True


@dataclass
class Model:
    """A PLC by the book: a list as stack, flags in a dictionary.

    Timers hold preload and count, counters the clock of the tick before as well.
    """

    flags: dict[object, bool] = field(default_factory=dict)
    timers: dict[int, list[float]] = field(default_factory=lambda: {0: [0, 0], 1: [0, 0]})
    counters: dict[int, list[int]] = field(default_factory=lambda: {0: [0, 0, 0], 1: [0, 0, 0]})
    seen: dict[tuple[int, str], set[bool]] = field(default_factory=dict)

    def get(self, name: object) -> bool:
        return self.flags.get(name, False)

    def load(self, program: list[Instruction]) -> None:
        for name, operand in program:
            number, _, preload = str(operand).partition(" ")
            if preload and name == "TIM":
                self.timers[int(number)][0] = int(preload)
            elif preload:
                self.counters[int(number)][0] = int(preload)

    def objects(self) -> None:
        for n, timer in self.timers.items():
            if not self.get(("tim", n)):
                timer[1], self.flags[f"TIM{n}"] = timer[0], False
                continue
            timer[1] -= 0.5
            if timer[1] <= 0:
                self.flags[f"TIM{n}"] = True
        for n, counter in self.counters.items():
            clock = self.get(("clock", n))
            if self.get(("zero", n)):
                counter[1], self.flags[f"CNT{n}"] = counter[0], False
            elif clock and not counter[2] and not self.get(f"CNT{n}"):
                counter[1] = max(0, (counter[1] or counter[0]) - 1)
                self.flags[f"CNT{n}"] = counter[1] == 0
            counter[2] = clock
        for n in (0, 1):
            if self.get(("reset", n)):
                self.flags[f"KR{n}"] = False
            elif self.get(("set", n)):
                self.flags[f"KR{n}"] = True

    def note(self, place: int, which: str, state: bool) -> None:
        self.seen.setdefault((place, which), set()).add(state)

    def scan(self, program: list[Instruction]) -> None:
        r, stack, rung = False, list[bool](), True
        for place, (name, operand) in enumerate(program):
            value = self.get(operand) != name.endswith("NOT")
            self.note(
                place, "last", value if name.split()[0] in CONTACTS and operand is not None else r
            )
            if name in ("CNT", "KR"):
                self.note(place, "first", stack[-1])
            match name.removesuffix(" NOT"):
                case "LD":
                    stack = [] if rung else [*stack, r]
                    r, rung = value, False
                    continue
                case "AND":
                    r = r and value
                case "OR":
                    r = r or value
                case "AND LD":
                    r = stack.pop() and r
                case "OR LD":
                    r = stack.pop() or r
                case "NOT":
                    r = not r
                case "OUT":
                    self.flags[operand] = r != name.endswith("NOT")
                case "SET" | "CLR" if r:
                    self.flags[operand] = name == "SET"
                case "TIM":
                    self.flags["tim", int(str(operand).split()[0])] = r
                case "CNT":
                    n = int(str(operand).split()[0])
                    self.flags["clock", n], self.flags["zero", n] = stack.pop(), r
                case "KR":
                    n = int(str(operand))
                    self.flags["set", n], self.flags["reset", n] = stack.pop(), r
            rung = name.split()[0] in ("OUT", "SET", "CLR", "TIM", "CNT", "KR")


CONTACTS = ("LD", "AND", "OR")
SEEN = {
    ("last", True): scan.SEEN_ON,
    ("last", False): scan.SEEN_OFF,
    ("first", True): scan.FIRST_SEEN_ON,
    ("first", False): scan.FIRST_SEEN_OFF,
}
NUMBERS = {"TIM0": 1552, "CNT0": 1556, "KR0": 1564, "TIM1": 1584}


@settings(max_examples=200, deadline=None)
@given(programs.filter(is_sound), inputs, st.booleans())
def test_every_sound_plc_does_what_the_book_says_and_notes_what_it_has_seen(
    program: list[Instruction], journal: list[int], noted: bool
) -> None:
    rack, model = Rack().program(*texts(program)), Model()
    rack.plcs.note(0, noted)
    model.load(program)
    for states in journal:
        for bit in range(3):
            rack.put(bool(states >> bit & 1), bit)
            model.flags[bit] = bool(states >> bit & 1)
        rack.step()
        model.objects()
        model.scan(program)
        for name in FLAGS:
            assert rack.on(NUMBERS.get(str(name), name)) == model.get(name), name  # type: ignore[arg-type]
    expected = [0] * len(program)
    for (place, which), states_seen in model.seen.items():
        expected[place] |= noted * sum(SEEN[which, state] for state in states_seen)
    assert rack.plcs.seen(0) == expected


@pytest.mark.skipif(not compiled.is_compiled, reason="needs the compiled core")
@settings(max_examples=60, deadline=None)
@given(st.lists(programs.filter(is_sound), min_size=1, max_size=3), inputs)
def test_interpreted_and_compiled_scans_give_the_same_bits(
    plcs: list[list[Instruction]], journal: list[int]
) -> None:
    racks = [Rack(plc_step), Rack(compiled.counterpart(plc_step))]
    for rack in racks:
        for number, program in enumerate(plcs):
            rack.program(*texts(program), plc=3 * number)
        rack.plcs.note(3, True)
        for states in journal:
            for bit in range(3):
                rack.put(bool(states >> bit & 1), bit)
            rack.step()
    assert racks[0].memory.snapshot() == racks[1].memory.snapshot()
