"""Plans of blocks: codes found, words checked, acts in their order."""

from __future__ import annotations

import math

from msgspec import Struct, field
from msgspec.structs import replace

from openacr.cnc.canonical import AXIS_LETTERS
from openacr.cnc.codes.table import DIALECTS, Axes, Code, Dialect, Group, Limit, check_limit
from openacr.cnc.reading.blocks import Block, Word
from openacr.cnc.reading.findings import CodeError
from openacr.cnc.reading.formulas import NEAR, Number
from openacr.cnc.reading.refusals import Refusals, other_dialect

MOST_SHAPES = 4096
MOST_CODE = 1e6  # numbers of codes are far below
POLAR_AXES = "XY"
_UNKNOWN = {"G": "E203", "M": "E205"}
_MOTION_WORDS = frozenset("IJKRQPL")  # may belong to the motion or cycle that is active


class Plan(Struct):
    """The acts of a block, and its words by letter."""

    block: Block
    acts: tuple[Code, ...] = ()
    words: dict[str, Word] = field(default_factory=dict)
    numbers: dict[str, float] | None = None  # the values, where all are numbers as written
    axes: tuple[tuple[int, str], ...] = ()
    codes: tuple[Code, ...] = ()
    modal_words: tuple[str, ...] = ()  # left for the motion that is active
    is_polar: bool = False  # @ or ^ instead of X and Y
    is_computed: bool = False  # codes are formulas: planned again when their values are known

    @property
    def code_names(self) -> list[str]:
        """The G and M codes of the block as written."""
        return [code.name for code in self.codes]

    @property
    def taken(self) -> frozenset[str]:
        """Letters that codes of the block take for themselves."""
        return frozenset(letter for code in self.codes for letter in code.takes)

    @property
    def motion_code(self) -> float | None:
        """The number of the G code of motion in the block (G0 to G3), if it has one."""
        numbers = (code.number for code in self.codes if code.letter == "G" and code.number < 4)
        return next(numbers, None)

    @property
    def is_motion(self) -> bool:
        """Whether the block moves as the active motion or cycle does."""
        return any(code.letter == "MOTION" for code in self.acts)

    def column(self, letter: str) -> int:
        """The column of a word; 1 where it is absent."""
        word = self.words.get(letter)
        return word.column if word else (self.block.words[0].column if self.block.words else 1)


Shape = tuple[str | tuple[str, float], ...]


class _Known(Struct, frozen=True):
    """The plan of one shape of blocks."""

    plan: Plan
    limits: tuple[Limit, ...]


def _shape(words: list[Word]) -> Shape:
    """Letters in their order; codes with their number."""
    return tuple(
        [
            (word.letter, word.value.number)
            if word.letter in "GM" and isinstance(word.value, Number)
            else word.letter
            if word.parameter is None
            else ("#", 0.0)
            for word in words
        ]
    )


class BlockPlanner:
    """Makes plans by the tables of a dialect, for a machine with these axes."""

    def __init__(self, dialect: Dialect, axes: dict[str, int], custom: Code | None = None) -> None:
        self._dialect = dialect
        self._refusals = dialect.grammar.refusals
        self._order = {step: place for place, step in enumerate(dialect.order)}
        self.axes = axes
        self._custom = custom
        self._motion = dialect.table.letters["MOTION"]
        self._macro = dialect.table.letters.get("MACRO")
        self._known: dict[Shape, _Known] = {}
        self.customs: set[int] = set()  # numbers of M codes made by the user
        self.replaced: dict[tuple[str, float], Code] = {}  # codes with another meaning here

    def plan(self, block: Block) -> Plan:
        """The plan of a block; CodeError where it makes no sense.

        Blocks of the same letters and codes have the same plan but for their values: it is
        made once.
        """
        if not block.words:
            return Plan(block)
        if self._has_formulas(block):
            return Plan(block, is_computed=True)
        shape = _shape(block.words)
        known = self._known.get(shape)
        if known is None:
            codes, words = self._sorted(block)
            plan = self._planned(block, codes, words)
            if not any(code.takes_all for code in plan.codes):
                self._remember(shape, plan)
            return plan
        words = {word.letter: word for word in block.words if word.letter not in "GM"}
        for limit in known.limits:
            _check_written(limit, words)
        plan = known.plan
        return Plan(
            block, plan.acts, words, _numbers(words), plan.axes, plan.codes, plan.modal_words,
            plan.is_polar,
        )  # fmt: skip

    def _has_formulas(self, block: Block) -> bool:
        """Whether a code is a formula; G and M among the arguments of G65 and G66 are not codes."""
        for word in block.words:
            if word.letter in "GM":
                if not isinstance(word.value, Number):
                    return True
                code = self._dialect.table.gcodes.get(word.value.number)
                if word.letter == "G" and code is not None and code.takes_all:
                    return False
        return False

    def _remember(self, shape: Shape, plan: Plan) -> None:
        if len(self._known) >= MOST_SHAPES:
            self._known.clear()
        limits = tuple(limit for code in plan.acts for limit in code.limits)
        self._known[shape] = _Known(plan, limits)

    # --- codes and words --------------------------------------------------------------

    def _sorted(self, block: Block) -> tuple[list[tuple[Code, Word]], dict[str, Word]]:
        """The codes, and the other words by letter; after G65 and G66 all are arguments."""
        codes: list[tuple[Code, Word]] = []
        words: dict[str, Word] = {}
        is_call = False
        for word in block.words:
            if word.letter in "GM" and not is_call:
                code = self._code(word)
                codes.append((code, word))
                is_call = code.takes_all and code.letter == "G"
                if is_call and len(codes) > 1:
                    raise CodeError("E201", word.column, code.name, "it stands alone")
            elif word.letter in words and (not is_call or word.letter in "PL"):
                raise CodeError("E202", word.column, word.letter)
            else:
                words[word.letter] = word
        return codes, words

    def _code(self, word: Word) -> Code:
        number = word.value.number if isinstance(word.value, Number) else math.nan
        if not abs(number) < MOST_CODE:
            raise CodeError("E204", word.column)
        table = self._dialect.table
        rows = table.gcodes if word.letter == "G" else table.mcodes
        tenths = round(number * 10)
        if abs(number * 10 - tenths) > NEAR or (word.letter == "M" and tenths % 10):
            raise CodeError("E204", word.column)
        code = self.replaced.get((word.letter, tenths / 10)) or rows.get(tenths / 10)
        if code is not None:
            return code
        if word.letter == "M" and self._custom and tenths // 10 in self.customs:
            own = replace(self._custom, letter="M", number=tenths / 10, words="")
            return replace(own, axes=Axes.DATA, takes_all=True)
        name = f"{word.letter}{tenths / 10:g}"
        known = self._refusals.of_code(name) or self._known_to(word, tenths)
        raise CodeError(_UNKNOWN[word.letter], word.column, name, known)

    def _known_to(self, word: Word, tenths: int) -> str:
        """Which other dialects have a code."""
        for other in DIALECTS.values():
            rows = other.table.gcodes if word.letter == "G" else other.table.mcodes
            if other is not self._dialect and tenths / 10 in rows:
                return other_dialect(other.name)
        return ""

    # --- the plan ---------------------------------------------------------------------

    def _planned(
        self, block: Block, codes: list[tuple[Code, Word]], words: dict[str, Word]
    ) -> Plan:
        _check_groups(codes)
        taker = _taker(codes)
        own = [code for code, _ in codes]
        self._check_barred(own, words)
        is_polar = self._check_polar(words, taker)
        if any(code.takes_all for code in own):
            acts, left = list(own), list[str]()
        else:
            acts, left = self._with_letters(own, words, taker)
        if taker is None and (left or is_polar or _moves(own, words)):
            acts.append(self._motion)
        if self._macro and ((acts and acts[-1] is self._motion) or _probes(own)):
            acts.append(self._macro)
        _check_limits(codes, acts, words, self._refusals)
        acts.sort(key=self._place)
        axes = tuple((self.axes.get(a, -1), a) for a in AXIS_LETTERS if a in words)
        return Plan(
            block, tuple(acts), words, _numbers(words), axes, tuple(own), tuple(left), is_polar
        )

    def _check_polar(self, words: dict[str, Word], taker: Code | None) -> bool:
        """Whether a block has polar words; CodeError where they have no meaning."""
        polar = [words[letter] for letter in self._dialect.grammar.polar if letter in words]
        if not polar:
            return False
        column = min(word.column for word in polar)
        if any(letter in words for letter in POLAR_AXES):
            raise CodeError("E236", column, hint="@ and ^ take the place of X and Y")
        if taker is not None and not taker.is_polar:
            raise CodeError("E236", column, hint=f"not with {taker.name}")
        for letter in POLAR_AXES:
            if letter not in self.axes:
                raise CodeError("E207", column, letter)
        return True

    def _place(self, code: Code) -> tuple[int, bool]:
        """When a code acts: G0 to G3 choose the motion before anything moves."""
        return self._order[code.step], code.group is not Group.MOTION

    def _with_letters(
        self, own: list[Code], words: dict[str, Word], taker: Code | None
    ) -> tuple[list[Code], list[str]]:
        """The codes with the letters that act by themselves, and the words that are left."""
        taken = {letter for code in own for letter in code.takes}
        used = {letter for code in own for letter in code.words}
        acts, left = list(own), []
        for letter, word in words.items():
            act = self._letter(letter, word)
            if letter in self._dialect.grammar.polar:
                continue
            if letter in AXIS_LETTERS:
                self._check_axis(letter, word)
            elif act is not None and letter not in taken:
                acts.append(act)
            elif letter not in used:
                self._check_left(word, own, taker)
                left.append(letter)
        return acts, left

    def _letter(self, letter: str, word: Word) -> Code | None:
        letters = self._dialect.table.letters
        if word.parameter is not None and "T#" in letters:
            return letters["T#"]
        return letters.get(letter)

    def _check_axis(self, letter: str, word: Word) -> None:
        if letter not in self.axes:
            raise CodeError("E207", word.column, letter)

    def _check_left(self, word: Word, own: list[Code], taker: Code | None) -> None:
        """A word that no code of the block uses: only the motion that is active can."""
        if word.letter not in _MOTION_WORDS or taker is not None:
            raise self._meaningless(word, own)

    def _check_barred(self, own: list[Code], words: dict[str, Word]) -> None:
        if any(code.axes is Axes.BARRED for code in own):
            for letter in AXIS_LETTERS:
                if letter in words:
                    raise self._meaningless(words[letter], own)

    def _meaningless(self, word: Word, own: list[Code]) -> CodeError:
        hint = self._refusals.of_word(word.letter, [code.name for code in own])
        return CodeError("E206", word.column, word.letter, hint)


def _moves(own: list[Code], words: dict[str, Word]) -> bool:
    """Whether there are words that make the active motion move."""
    if any(letter in AXIS_LETTERS for letter in words):
        return True
    return any(
        letter in words for code in own if code.group is Group.MOTION for letter in code.words
    )


def _probes(own: list[Code]) -> bool:
    return any(code.axes is Axes.MOVE and code.group is None for code in own)


def _check_groups(codes: list[tuple[Code, Word]]) -> None:
    seen: set[Group] = set()
    for code, word in codes:
        if code.group is None:
            continue
        if code.group in seen:
            raise CodeError("E201", word.column, code.name)
        seen.add(code.group)


def _taker(codes: list[tuple[Code, Word]]) -> Code | None:
    """The one code that takes the axis words for itself."""
    found: Code | None = None
    for code, word in codes:
        if code.axes in (Axes.DATA, Axes.MOVE):
            if found is not None and not (code.letter == "M" and found.letter == "M"):
                raise CodeError("E201", word.column, code.name, "both take the axis words")
            found = code
    return found


def _check_limits(
    codes: list[tuple[Code, Word]], acts: list[Code], words: dict[str, Word], refusals: Refusals
) -> None:
    places = dict(codes)
    for code in acts:
        for limit in code.limits:
            word = words.get(limit.letter)
            if word is None:
                if limit.is_needed:
                    column = places[code].column if code in places else 1
                    reasons = (refusals.of_word(letter, [code.name]) for letter in words)
                    hint = next(filter(None, reasons), limit.reach)
                    raise CodeError(limit.error, column, f"{limit.letter} is missing", hint)
            else:
                _check_written(limit, words)


def _check_written(limit: Limit, words: dict[str, Word]) -> None:
    """A value that is written as a number is checked at once."""
    word = words.get(limit.letter)
    if word is not None and isinstance(word.value, Number):
        check_limit(limit, word.value.number, word.column)


def _numbers(words: dict[str, Word]) -> dict[str, float] | None:
    found = {}
    for letter, word in words.items():
        if not isinstance(word.value, Number):
            return None
        found[letter] = word.value.number
    return found
