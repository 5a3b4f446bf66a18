"""O-words: subroutines and structures of the rs274ngc dialect.

    O100 sub ... O100 return [1] ... O100 endsub [1]      O100 call [arg] [arg]
    O1 while [..] ... O1 endwhile        O1 do ... O1 while [..]
    O1 if [..] ... O1 elseif [..] ... O1 else ... O1 endif
    O1 repeat [n] ... O1 endrepeat       O1 break, O1 continue

The words with one name form one structure, in the order in which they stand.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from openacr.cnc.codes.active import Context
from openacr.cnc.codes.ngc.contexts import restored
from openacr.cnc.program.flow import Frame, Level
from openacr.cnc.program.labels import Part, Place
from openacr.cnc.program.program import Node, OPlace, Program
from openacr.cnc.reading.blocks import OWord
from openacr.cnc.reading.findings import CodeError
from openacr.cnc.reading.formulas import LOCALS, Formula

if TYPE_CHECKING:
    from openacr.cnc.canonical import Entry
    from openacr.cnc.codes.run import Run

Act = Callable[[Node], "Iterator[Entry] | None"]
KINDS = frozenset(
    "SUB ENDSUB CALL RETURN WHILE ENDWHILE DO IF ELSEIF ELSE ENDIF REPEAT ENDREPEAT BREAK"
    " CONTINUE".split()
)
NEEDS_VALUE = frozenset({"WHILE", "IF", "ELSEIF", "REPEAT"})
ENDS = {"WHILE": ("ENDWHILE",), "REPEAT": ("ENDREPEAT",), "SUB": ("ENDSUB",), "DO": ("WHILE",)}
BRANCHES = ("ELSEIF", "ELSE", "ENDIF")
LOOP_ENDS = ("ENDWHILE", "ENDREPEAT", "WHILE")
PLAIN = (["WHILE", "ENDWHILE"], ["IF", "ENDIF"], ["IF", "ELSE", "ENDIF"])
SUB, PROGRAM = "SUB", "PROGRAM"  # `O100 sub`, and a program O100 that M99 ends
STARTS = (SUB, PROGRAM)
VALUE, RETURNED = "_VALUE", "_VALUE_RETURNED"


def note(program: Program, word: OWord, place: Place) -> None:
    """Keep where an O-word stands; an error where it makes no sense."""
    if word.kind not in KINDS or (word.kind in NEEDS_VALUE and len(word.values) != 1):
        raise CodeError("E108", word.column, word.kind)
    places = program.o_words.setdefault(word.name, [])
    if word.kind == SUB and any(one.kind == SUB and one.place.part is place.part for one in places):
        raise CodeError("E221", word.column, f"O{word.name}")
    places.append(OPlace(word.kind, place))


def note_title(program: Program, number: int, place: Place) -> None:
    """`O100` alone: a program that M98 calls and M99 ends."""
    program.o_words.setdefault(str(number), []).append(OPlace(PROGRAM, place))


def missing(program: Program) -> list[str]:
    """Names that are called and stand nowhere."""
    return [
        name
        for name, words in program.o_words.items()
        if any(one.kind == "CALL" for one in words) and not any(one.kind in STARTS for one in words)
    ]


class OWords:
    """The structures of one program."""

    def __init__(self, run: Run) -> None:
        self._run = run
        self._left: dict[tuple[int, str], int] = {}  # passes left of REPEAT, by call and name
        self._depth = 0
        self.context: Context | None = None  # the modal state this call keeps

    def reset(self) -> None:
        """A program starts: no loop is in progress."""
        self._left.clear()
        self._depth = 0
        self.context = None

    def act(self, word: OWord, node: Node) -> Act:
        """A word as a function of its line."""
        if word.kind not in KINDS:
            raise CodeError("E108", word.column, word.kind)
        if word.kind in NEEDS_VALUE and len(word.values) != 1:
            raise CodeError("E108", word.column, f"{word.kind} [..]")
        values = [Formula(value, self._run.parameters) for value in word.values]
        work = getattr(self, f"_{word.kind.lower()}")

        def do(node: Node) -> Iterator[Entry] | None:
            result: Iterator[Entry] | None = work(word, node, values)
            return result

        return do

    def is_plain(self, word: OWord, part: Part) -> bool:
        """Whether the words of a structure jump to where their lines alone decide.

        That are WHILE and IF with ELSE, each once, with nothing else of that name.
        """
        named = self._run.program.o_words.get(word.name, [])
        kinds = [one.kind for one in named if one.place.part is part]
        return word.number is None and kinds in PLAIN

    # --- places -----------------------------------------------------------------------

    def _words(self, word: OWord, node: Node) -> list[OPlace]:
        """The words of a structure, all of which stand in one file."""
        words = self._run.program.o_words.get(word.name, [])
        return [one for one in words if one.place.part is node.part]

    def _next(self, word: OWord, node: Node, kinds: tuple[str, ...]) -> OPlace:
        """The next word of the structure of one of these kinds."""
        for other in self._words(word, node):
            if other.place.line > node.line and other.kind in kinds:
                return other
        raise CodeError("E108", word.column, f"O{word.name} {kinds[-1].lower()} missing")

    def _last(self, word: OWord, node: Node, kinds: tuple[str, ...]) -> OPlace | None:
        """The word of the structure before this line, if it is one of these kinds."""
        before = [one for one in self._words(word, node) if one.place.line < node.line]
        found = [one for one in before if one.kind in kinds]
        return found[-1] if found else None

    @property
    def left(self) -> dict[tuple[int, str], int]:
        """Passes left of the loops in progress, by call and name: a copy."""
        return dict(self._left)

    def _go_to(self, target: OPlace) -> None:
        self._run.flow.go_place(target.place)

    def _loop(self) -> None:
        """One more pass begins."""
        if self._run.flow.jumped is not None:
            self._run.flow.jumped()

    def _go_past(self, target: OPlace) -> None:
        at = self._run.flow.at(target.place)
        if at is not None:
            self._run.flow.pass_by(at)

    # --- loops and branches -------------------------------------------------------------

    def _while(self, word: OWord, node: Node, values: list[Formula]) -> None:
        before = self._last(word, node, ("DO", "WHILE", "ENDWHILE"))
        is_on = values[0].now() != 0.0
        if before is not None and before.kind == "DO":
            if is_on:
                self._loop()
                self._go_past(before)
        elif not is_on:
            self._go_past(self._next(word, node, ENDS["WHILE"]))

    def _endwhile(self, word: OWord, node: Node, values: list[Formula]) -> None:
        self._back(word, node, "WHILE")

    def _back(self, word: OWord, node: Node, kind: str) -> None:
        start = self._last(word, node, (kind,))
        if start is None:
            raise CodeError("E108", word.column, f"O{word.name} {kind.lower()} missing")
        self._loop()
        self._go_to(start)

    def _do(self, word: OWord, node: Node, values: list[Formula]) -> None:
        self._next(word, node, ENDS["DO"])

    def _if(self, word: OWord, node: Node, values: list[Formula]) -> None:
        at = node
        is_on = values[0].now() != 0.0
        while not is_on:
            branch = self._next(word, at, BRANCHES)
            self._go_past(branch)
            following = self._run.flow.at(branch.place)
            if branch.kind != "ELSEIF" or following is None:
                return
            at = following
            is_on = self._condition(at)

    def _condition(self, node: Node) -> bool:
        """The condition of an ELSEIF line."""
        from openacr.cnc.reading.parser import parse

        statement = parse(node.raw, self._run.dialect.grammar).statement
        if not isinstance(statement, OWord) or not statement.values:
            raise CodeError("E108", 1, "ELSEIF [..]")
        return Formula(statement.values[0], self._run.parameters).now() != 0.0

    def _elseif(self, word: OWord, node: Node, values: list[Formula]) -> None:
        """Reached after a branch that was executed."""
        self._go_past(self._next(word, node, ("ENDIF",)))

    _else = _elseif

    def _endif(self, word: OWord, node: Node, values: list[Formula]) -> None:
        pass

    def _repeat(self, word: OWord, node: Node, values: list[Formula]) -> None:
        key = (self._depth, word.name)
        left = self._left.get(key)
        left = round(values[0].now()) if left is None else left
        if left <= 0:
            self._left.pop(key, None)
            self._go_past(self._next(word, node, ENDS["REPEAT"]))
        else:
            self._left[key] = left - 1

    def _endrepeat(self, word: OWord, node: Node, values: list[Formula]) -> None:
        self._back(word, node, "REPEAT")

    def _break(self, word: OWord, node: Node, values: list[Formula]) -> None:
        self._left.pop((self._depth, word.name), None)
        self._go_past(self._next(word, node, LOOP_ENDS))

    def _continue(self, word: OWord, node: Node, values: list[Formula]) -> None:
        self._go_to(self._next(word, node, LOOP_ENDS))

    # --- subroutines --------------------------------------------------------------------

    def _sub(self, word: OWord, node: Node, values: list[Formula]) -> None:
        """Reached without a call: the text of the subroutine is passed over."""
        self._go_past(self._next(word, node, ENDS["SUB"]))

    def _call(self, word: OWord, node: Node, values: list[Formula]) -> Iterator[Entry]:
        arguments = [value.now() for value in values]
        if word.number is None:
            return self.call(word.name, word.column, arguments)
        number = round(Formula(word.number, self._run.parameters).now())
        return self.call(str(number), word.column, arguments)

    def call(self, name: str, column: int, arguments: list[float]) -> Iterator[Entry]:
        """Run the subroutine of a name."""
        run = self._run
        here = run.execution.node
        starts = [one for one in run.program.o_words.get(name, []) if one.kind in STARTS]
        starts.sort(key=lambda one: here is None or one.place.part is not here.part)  # own file
        start = run.flow.at(starts[0].place) if starts else None
        if start is None:
            raise CodeError("E220", column, f"O{name}")
        first_line = run.flow.next_after(start)
        if first_line is None:
            raise CodeError("E108", column, f"O{name} endsub missing")
        values = [0.0] * (LOCALS + 1)
        values[1 : len(arguments) + 1] = arguments
        kept, run.parameters.names = run.parameters.names, {}
        run.parameters.global_names[RETURNED] = 0.0
        self._depth += 1
        outer, self.context = self.context, None
        yield from run.execution.call(Frame(Level.MACRO), first_line, values[: LOCALS + 1])
        context, self.context = self.context, outer
        if context is not None and context.is_automatic and here is not None:
            restored(run, context, here.source, column)
        self._left = {key: left for key, left in self._left.items() if key[0] < self._depth}
        self._depth -= 1
        run.parameters.names = kept

    def _endsub(self, word: OWord, node: Node, values: list[Formula]) -> None:
        if values:
            names = self._run.parameters.global_names
            names[VALUE], names[RETURNED] = values[0].now(), 1.0
        self._run.flow.go_back(word.column)

    _return = _endsub
