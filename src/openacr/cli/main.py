"""The command `openacr`: one lazy entry per sub-command, one place for errors.

A sub-command is imported when it is used, so that `openacr --help` and tab completion
answer at once.
"""

import atexit
import gc
import os
import sys
from collections.abc import Mapping, Sequence
from importlib import import_module
from pathlib import Path
from typing import Annotated, Any, TextIO

import typer
from typer.core import TyperCommand, TyperGroup

from openacr.cli.commands import COMMANDS, Entry, Family
from openacr.cli.conversions import quick
from openacr.cli.refusals import failed_json, parts_of
from openacr.errors import OpenacrError, UserError
from openacr.lang.characters import shown

BAD_INPUT = 2
INTERRUPTED = 130


HELP_OPTIONS = ["-h", "--help"]
HELP = {"help_option_names": HELP_OPTIONS}


class SubCommand(TyperCommand):
    """Sub-command; with --json, input errors are also reported as an object on stdout."""

    def get_params(self, ctx: Any) -> list[Any]:
        """The parameters, converted without pydantic where that is possible."""
        return quick(super().get_params(ctx))

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Parse the words; the error hints at a file whose name begins with a minus."""
        try:
            return self._parsed(ctx, list(args))
        except Exception as error:
            said = getattr(error, "format_message", None)  # of words that are wrong or missing
            if said is not None and "--json" in args and self._has_json:
                typer.echo(failed_json([UserError(said())]))
            raise

    @property
    def _has_json(self) -> bool:
        return any("--json" in each.opts for each in self.params)

    def _parsed(self, ctx: Any, words: list[str]) -> list[str]:
        while True:
            try:
                return super().parse_args(ctx, list(words))
            except Exception as error:  # of click, or of the copy of it that typer brings
                place = _refused_word(words, getattr(error, "option_name", ""))
                if place is None:
                    raise
                if not Path(words[place]).exists():
                    hint = f"{error.message} (a file of this name is written ./{words[place]})"  # type: ignore[attr-defined]
                    raise typer.BadParameter(hint, ctx) from None
                words[place] = f"./{words[place]}"

    def invoke(self, ctx: Any) -> Any:
        """Run it."""
        try:
            return super().invoke(ctx)
        except OpenacrError as error:
            if any("--json" in each.opts and ctx.params.get(each.name) for each in self.params):
                typer.echo(failed_json(parts_of(error)))
            raise


def _refused_word(words: Sequence[str], option: str) -> int | None:
    """The word that may be a file name such as `-part.nc`; None for a mistyped option."""
    if not option:
        return None
    before = list(words[: words.index("--")] if "--" in words else words)
    for place, word in enumerate(before):
        if word.startswith("-") and len(word) > 2 and option[1:] in word:
            return None if option.startswith("--") and not Path(word).exists() else place
    return None


class LazyGroup(TyperGroup):
    """Sub-commands by name, imported when they are used."""

    table: Mapping[str, Entry | Family] = {}
    default = ""  # the sub-command without any word

    def __init__(self, **attributes: Any) -> None:
        super().__init__(**attributes)
        names: dict[str, Any] = dict.fromkeys(self.table)
        self.commands.update(names)  # for suggestions after a typing error

    def get_params(self, ctx: Any) -> list[Any]:
        """The parameters, converted without pydantic where that is possible."""
        return quick(super().get_params(ctx))

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Parse the words; without the name of a sub-command the default one is meant."""
        is_named = bool(args) and (not args[0].startswith("-") or args[0] in HELP_OPTIONS)
        return super().parse_args(
            ctx, args if is_named or not self.default else [self.default, *args]
        )

    def list_commands(self, ctx: Any) -> list[str]:
        """Name the sub-commands in the order of their table."""
        return list(self.table)

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """Import a sub-command, or make the group of a family."""
        entry = self.table.get(cmd_name)
        if entry is None:
            return None
        if isinstance(entry, Family):
            return _group(cmd_name, entry)
        settings = {**HELP, "ignore_unknown_options": entry.takes_dashes}
        single = typer.Typer(add_completion=False, rich_markup_mode=None, context_settings=settings)
        module = import_module(f"openacr.cli.{entry.module}")
        single.command(cmd_name, cls=SubCommand)(getattr(module, entry.function))
        return typer.main.get_command(single)

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """List the sub-commands without importing them."""
        with formatter.section("Commands"):
            formatter.write_dl([(name, entry.summary) for name, entry in self.table.items()])


def _group(name: str, family: Family) -> Any:
    """The click group of a family."""
    members = type("Members", (LazyGroup,), {"table": family.entries, "default": family.default})
    single = typer.Typer(
        cls=members,
        no_args_is_help=True,
        add_completion=False,  # that of the whole command completes families, too
        rich_markup_mode=None,
        context_settings=HELP,
    )
    single.callback(help=family.summary)(_nothing)
    made = typer.main.get_command(single)
    made.name = name
    return made


def _nothing() -> None:
    """Do nothing: a family only groups sub-commands."""


class Commands(LazyGroup):
    """Group of all sub-commands; reports a user's errors in one line with exit code 2."""

    table = COMMANDS

    def invoke(self, ctx: Any) -> Any:
        """Run a sub-command; report a user's error in one line."""
        try:
            return super().invoke(ctx)
        except OpenacrError as error:
            for each in parts_of(error):
                typer.echo(f"error: {shown(str(each))}", err=True)
            raise typer.Exit(BAD_INPUT) from None


app = typer.Typer(
    cls=Commands,
    no_args_is_help=True,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings=HELP,
)


def _show_version(is_wanted: bool) -> None:
    if is_wanted:
        from importlib.metadata import version

        typer.echo(f"openacr {version('openacr')}")
        raise typer.Exit


@app.callback()
def openacr(
    is_version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_show_version, is_eager=True, help="Show the version and exit."
        ),
    ] = False,
) -> None:
    """A software ACR motion controller: run, serve, check and debug AcroBASIC projects."""


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line; Ctrl-C ends it without a trace."""
    atexit.register(gc.freeze)  # the memory goes with the process: its end searches no garbage
    _open_closed_streams()
    for stream in (sys.stdout, sys.stderr):
        # Program output may hold characters that the terminal cannot show.
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")
    try:
        app(arguments, prog_name="openacr")
    except KeyboardInterrupt:
        sys.exit(INTERRUPTED)
    except OSError as error:  # files are dealt with where they are opened
        _silence(sys.stdout)
        print(f"error: output cannot be written: {error.strerror}", file=sys.stderr)
        sys.exit(BAD_INPUT)


def _open_closed_streams() -> None:
    """Connect standard streams that were closed at the start (`>&-`) to the null device.

    Python gives None for them; and the next file that is opened would get their descriptor.
    """
    for descriptor, name in enumerate(("stdin", "stdout", "stderr")):
        if getattr(sys, name) is None:
            mode = "r" if descriptor == 0 else "w"
            setattr(sys, name, open(_at(descriptor), mode))  # for the life of the process


def _at(descriptor: int) -> int:
    """The null device at this descriptor."""
    found = os.open(os.devnull, os.O_RDWR)
    if found != descriptor:
        os.dup2(found, descriptor)
        os.close(found)
    return descriptor


def _silence(stream: TextIO) -> None:
    """Discard the rest of the output: flushing it at exit would fail again."""
    with open(os.devnull, "w") as nowhere:
        os.dup2(nowhere.fileno(), stream.fileno())


if __name__ == "__main__":
    main()
