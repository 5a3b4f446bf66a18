"""Operating system: levels, attachments, configuration, aliases and reports of the card."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from msgspec import Struct

from openacr.basic.language import registry
from openacr.basic.language.aliases import Aliases, read_target
from openacr.basic.language.grammar import Form, Int, Num, Rest, Str
from openacr.basic.language.lister import Lister
from openacr.basic.language.nodes import Expr
from openacr.basic.language.number_format import double_text
from openacr.basic.language.registry import ANY, IMMEDIATE, SYS, Level
from openacr.basic.language.written import call
from openacr.basic.vm.run import Run
from openacr.errors import CardError
from openacr.lang.lexer import Token, TokenKind
from openacr.messages import (
    INVALID_ARGUMENT,
    NOT_VALID_WHILE_IN_MOTION,
    UNKNOWN_COMMAND,
)
from openacr.motion.axis import filters
from openacr.motion.interlocks import axis_moving

if TYPE_CHECKING:
    from openacr.basic.language.parser import Parser

GROUP = "Operating System"
REF = "PG Operating System"
command = partial(registry.command, group=GROUP, ref=REF)
LEVELS = "PG Communication Levels"
SHORTEST_PERIOD_S = 0.0001
LONGEST_PERIOD_S = 0.005
HELP_COLUMNS = 8


# levels of the channel


@command("SYS", levels=ANY, use=IMMEDIATE, ref=LEVELS)
def sys_(run: Run) -> None:
    """Go to the system level."""
    run.channel.go(Level.SYS)


@command("PROG", levels=ANY, use=IMMEDIATE, grammar=(Int("n", 0, 15),), ref=LEVELS)
def prog(run: Run, number: int) -> None:
    """Go to the level of program n."""
    run.channel.go(Level.PROG, number)


@command("PLC", levels=ANY, use=IMMEDIATE, grammar=(Int("n", 0, 7),), ref=LEVELS)
def plc(run: Run, number: int) -> None:
    """Go to the level of PLC n."""
    run.channel.go(Level.PLC, number)


@command("ECHO", levels=ANY, use=IMMEDIATE, grammar=(Int("n", 0, 7, optional=True),), ref="")
def echo(run: Run, mode: int | None) -> None:
    """Set or show what the channel sends: 1 echo, 2 no error reports, 4 no prompt."""
    if mode is None:
        run.print(str(run.channel.echo))
    else:
        run.channel.echo = mode


@command("MODE", levels=ANY, use=IMMEDIATE, grammar=(Int("n", 0, 3, optional=True),), ref="")
def mode_(run: Run, mode: int | None) -> None:
    """Set or show how binary data is sent on the channel: 1 control prefixing, 2 no high bits."""
    if mode is None:
        run.print(str(run.channel.mode))
    else:
        run.channel.mode = mode


@command("STREAM", levels=ANY, use=IMMEDIATE)
def stream(run: Run) -> None:
    """Print the name of the own channel."""
    run.print(run.channel.name)


# aliases


class Definition(Struct, frozen=True):
    """#DEFINE as written; without target its line is shown."""

    name: str
    target: Expr | None
    text: str


class DefinitionForm(Form):
    """`name target`: target is a parameter, flag, variable, array element or constant."""

    def starts(self, p: Parser) -> bool:
        """Whether anything is left in the block."""
        return not p.cursor.at_block_end

    def parse(self, p: Parser) -> Definition:
        """Read the name, wrong ones included, and the target."""
        name = self._name(p)
        start = p.cursor.position
        if p.cursor.at_block_end:
            return Definition(name, None, "")
        target = read_target(p)
        text = Lister(p.scope.aliases).line(p.cursor.tokens[start : p.cursor.position])
        return Definition(name, target, text)

    @staticmethod
    def _name(p: Parser) -> str:
        """Everything up to the next blank; the storage of aliases judges it."""
        first = p.cursor.advance()
        text, end = first.text, first.column + len(first.text)
        while not p.cursor.at_block_end and p.cursor.token.column == end:
            text += p.cursor.token.text
            end += len(p.cursor.advance().text)
        return text


@command(
    "#DEFINE",
    group=GROUP,
    levels=ANY,
    grammar=(DefinitionForm("name target"),),
    ref="PG Aliases",
)
def define(run: Run, item: Definition) -> None:
    """Give a parameter, flag, variable or constant a name valid in every program."""
    aliases: Aliases = run.system.aliases
    if item.target is not None:
        aliases.define(item.name, item.target, item.text)
    elif line := aliases.line(item.name):
        run.print(line)


@command("DEF", levels=ANY, ref="PG Aliases")
def def_(run: Run) -> None:
    """List all aliases."""
    for line in run.system.aliases.lines():
        run.print(line)


@command("DEF CLEAR", levels=ANY, ref="PG Aliases")
def def_clear(run: Run) -> None:
    """Remove all aliases."""
    run.system.aliases.clear()


# the card


@command("HELP", levels=ANY, use=IMMEDIATE, grammar=(Rest(),))
def help_(run: Run, asked: tuple[Token, ...] | None) -> None:
    """List all command words, or say what the commands do that begin with these words."""
    if asked:
        for line in help_about(asked):
            run.print(line)
        return
    words = help_words()
    width = max(map(len, words)) + 1
    for start in range(0, len(words), HELP_COLUMNS):
        columns = words[start : start + HELP_COLUMNS]
        run.print("".join(word.ljust(width) for word in columns).rstrip())


def help_about(asked: tuple[Token, ...]) -> list[str]:
    """One line for every command that begins with these words, and for a function of that name.

    Real cards take no words after HELP. Numbers of objects may stand among the words, as in
    ENC0 RES; `Unknown command` if nothing begins so.
    """
    words = tuple(str(token.value) for token in asked if token.kind is not TokenKind.NUMBER)
    if words[:1] == ("#",):
        words = ("#" + "".join(words[1:2]), *words[2:])
    words = tuple(word for word in words if word != registry.INDEX)
    found = [
        f"{row.name}: {row.summary}"
        for row in registry.commands()
        if any(_plain(written)[: len(words)] == words for written in (row.words, *row.synonyms))
    ]
    if len(words) == 1 and words[0] in registry.functions:
        found.append(
            f"{call(registry.functions[words[0]])}: {registry.functions[words[0]].summary}"
        )
    if not words or not found:
        raise CardError(UNKNOWN_COMMAND)
    return found


def _plain(words: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(word for word in words if word != registry.INDEX)


def help_words() -> list[str]:
    """The first word of every command; assignments have none."""
    return sorted({row.words[0] for row in registry.commands()} - {"LET"} | {"REM"})


@command("VER", levels=ANY)
def ver(run: Run) -> None:
    """Print model and firmware version."""
    run.print(run.card.model.version)


@command(
    "PERIOD",
    levels=ANY,
    grammar=(Num("seconds", optional=True),),
    units="s",
    default="0.0005",
    saved=True,
)
def period(run: Run, period_s: float | None) -> None:
    """Set or show the servo period."""
    if period_s is None:
        run.print(double_text(run.card.clock.period_s))
        return
    if not SHORTEST_PERIOD_S <= period_s <= LONGEST_PERIOD_S:
        raise CardError(INVALID_ARGUMENT)
    if any(axis_moving(run.card, axis) for axis in range(run.card.model.axes)):
        raise CardError(NOT_VALID_WHILE_IN_MOTION)
    filters.change_period(run.card, period_s)


@command("PASSWORD", levels=SYS, use=IMMEDIATE)
def password(run: Run) -> None:
    """Print whether the text of programs is protected: ON or OFF."""
    run.print("OFF" if run.system.programs.password is None else "ON")


@command("PASSWORD ON", levels=SYS, use=IMMEDIATE, grammar=(Str("text"),))
def password_on(run: Run, text: str) -> None:
    """Protect the text of programs from LIST."""
    run.system.programs.protect(text)


@command("PASSWORD OFF", levels=SYS, use=IMMEDIATE, grammar=(Str("text"),))
def password_off(run: Run, text: str) -> None:
    """Make the text of programs readable again; the password must be the one set."""
    run.system.programs.unprotect(text)
