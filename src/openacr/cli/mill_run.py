"""`openacr mill run`, `mdi`, `home`: part programs on a virtual or a real machine."""

import json as json_format
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from openacr.cli.mill import (
    AsJson,
    AtStore,
    Dialect,
    Dry,
    PartProgram,
    clock,
    loaded,
    opened_store,
    show_findings,
)
from openacr.cli.mill_console import Console
from openacr.cli.mill_message import show_message
from openacr.errors import UserError

if TYPE_CHECKING:
    from openacr.cnc.batch import Batch, Entry
    from openacr.cnc.canonical import Ask
    from openacr.cnc.program import Program
    from openacr.cnc.replay import Replay
    from openacr.mill.workshop import Start, Workshop
    from openacr.sysvar import Store

FAILED, INTERRUPTED = 1, 130
SHOW_EVERY = 25  # steps

ToHost = Annotated[
    str | None,
    typer.Option("--host", metavar="HOST[:PORT]|SERIAL", help="A real card; else a virtual one."),
]
AtHost = Annotated[
    str, typer.Option("--host", metavar="HOST[:PORT]|SERIAL", help="The card of the machine.")
]


def run_program(
    file: PartProgram,
    host: ToHost = None,
    store: AtStore = None,
    dialect: Dialect = None,
    is_dry: Dry = False,
    line: Annotated[int, typer.Option("--line", min=1, help="Start at this line.")] = 1,
    accepts_tool: Annotated[
        bool, typer.Option("--any-tool", help="Start at a line with another tool in the spindle.")
    ] = False,
    is_skipping: Annotated[
        bool, typer.Option("--block-skip", help="Leave blocks with a slash out.")
    ] = False,
    stops_optionally: Annotated[bool, typer.Option("--optional-stop", help="Stop at M1.")] = False,
    answers: Annotated[
        list[str] | None, typer.Option("--answer", metavar="Pn=VALUE", help="Answer to an INPUT.")
    ] = None,
    as_json: AsJson = False,
    is_quiet: Annotated[bool, typer.Option("--quiet", help="No progress, no table.")] = False,
    has_console: Annotated[
        bool,
        typer.Option(
            "--console",
            help="Take commands while it runs: stop, resume, back, forward, halt, start, block,"
            " abort, fov N.",
        ),
    ] = False,
) -> None:
    """Run a part program on the virtual machine, or on a card.

    The virtual machine stands on its reference points, runs as fast as it can and waits for
    nobody. On a card Ctrl-C is a feed hold and ends the program; stops ask on the terminal.
    """
    from openacr.mill.workshop import Start

    start = Start("", line, is_dry, is_skipping, stops_optionally, accepts_tool)
    with opened_store(store, is_written=host is not None) as cells:
        program, name = _checked(file, cells, dialect)
        with workshop(host, cells, to_stderr=as_json) as shop:
            shop.runner.course.host.answers.update(map(_answer, answers or []))
            keep = Console().attend if has_console else attend
            _run(shop, program, _with_dialect(start, name), is_quiet or as_json, keep)
            _report(shop, as_json, is_quiet)


def run_batch(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="Names of programs, one a line.")],
    host: ToHost = None,
    store: AtStore = None,
    dialect: Dialect = None,
    is_dry: Dry = False,
) -> None:
    """Run the programs of a batch file one after the other.

    All of them are checked before the first one starts; an alarm ends the batch.
    """
    from openacr.cnc.batch import read_batch

    batch = read_batch(file)
    with opened_store(store, is_written=host is not None) as cells:
        programs = {path: _checked(path, cells, dialect) for path in batch.programs}
        with workshop(host, cells) as shop:
            for each in _runs(batch, repeats=shop.runner.settings.repeats):
                program, name = programs[each.path]
                typer.echo(each.path.name)
                _run(shop, program, _single(name, is_dry=is_dry), False, attend)
                end_with_alarms(shop)


def _runs(batch: "Batch", *, repeats: bool) -> "Iterator[Entry]":
    """The runs of a batch, over and over where the store says so."""
    yield from batch.runs()
    while repeats:
        yield from batch.runs()


def _checked(path: Path, cells: "Store", dialect: str | None) -> "tuple[Program, str]":
    """A program without errors, or the end with exit code 1."""
    program, name = loaded(path, cells, dialect)
    if program.errors:
        show_findings(program.errors)
        raise typer.Exit(FAILED)
    return program, name


def jog_axes(
    ways: Annotated[list[str], typer.Argument(metavar="WAY...", help="X0.5 Y-1")],
    host: AtHost,
    store: AtStore = None,
) -> None:
    """Move axes of a card by hand: X0.5 Y-1."""
    from openacr.mill.jogging import ways as ways_of

    with opened_store(store, is_written=host is not None) as cells, workshop(host, cells) as shop:
        names = [axis.name for axis in shop.runner.settings.axes]
        shop.jog(ways_of(ways, names), attend)
        typer.echo(_place_text(shop, shop.runner.course.host.position()))


def run_blocks(
    blocks: Annotated[
        list[str] | None,
        typer.Argument(metavar="[BLOCK]...", help='"G0 X1" "M3 S500"; without any they are read.'),
    ] = None,
    host: ToHost = None,
    store: AtStore = None,
    dialect: Dialect = None,
    save: Annotated[
        Path | None, typer.Option("--save", metavar="FILE", help="Keep the blocks as a program.")
    ] = None,
) -> None:
    """MDI: run single blocks on the virtual machine, or on a card.

    Blocks are those of the command line, or lines of the terminal until an empty one.
    """
    from openacr.cli.output import require_writable, write_whole

    if save is not None:
        require_writable(save)
    with opened_store(store, is_written=host is not None) as cells, workshop(host, cells) as shop:
        try:
            for place in shop.run_blocks(blocks or _typed(), dialect or "acromill", attend):
                typer.echo(_place_text(shop, place))
        finally:
            if save is not None:
                text = "".join(f"{block}\n" for block in shop.typed)
                write_whole(save, lambda partial: _fill(partial, text))
        end_with_alarms(shop)


def _fill(partial: Path, text: str) -> None:
    partial.write_text(text)


def _typed() -> "Iterator[str]":
    """Lines of the terminal, or of what is piped in."""
    if sys.stdin.isatty():
        while line := typer.prompt("MDI", default="", show_default=False):
            yield line
    else:
        yield from filter(None, map(str.strip, sys.stdin))


def home_axes(
    host: AtHost,
    axes: Annotated[
        str, typer.Option("--axes", help="Names of the axes, e.g. XYZ; else all with a priority.")
    ] = "",
    store: AtStore = None,
) -> None:
    """Find the reference points of axes on a card."""
    with opened_store(store, is_written=host is not None) as cells, workshop(host, cells) as shop:
        homed = shop.home(axes, _telling(attend))
        typer.echo(f"homed: {' '.join(homed) or 'no axis has a priority'}")
        end_with_alarms(shop)


def _telling(attend: "Callable[[Workshop], None]") -> "Callable[[Workshop], None]":
    """Attend, and say each time what is waited for now."""
    shown = ""

    def watch(shop: "Workshop") -> None:
        nonlocal shown
        if shop.runner.reason and shop.runner.reason != shown:
            shown = shop.runner.reason
            typer.echo(shown, err=True)
        attend(shop)

    return watch


# --- running ------------------------------------------------------------------------------


@contextmanager
def workshop(host: str | None, cells: "Store", *, to_stderr: bool = False) -> "Iterator[Workshop]":
    """The machine of a command; it comes to rest however the command ends."""
    from openacr.cli.signals import terminations_as_interrupts
    from openacr.client import ConnectionLostError
    from openacr.mill.workshop import Workshop

    def say(text: str) -> None:
        typer.echo(text, err=to_stderr)

    try:
        shop = Workshop.real(host, cells, say) if host is not None else Workshop.virtual(cells, say)
        shop.show_message = partial(show_message, to_stderr=to_stderr)
    except ConnectionLostError as lost:
        raise UserError(f"alarm 1: NO CARD FOUND ({lost})") from None
    try:
        with terminations_as_interrupts():
            yield shop
    except KeyboardInterrupt:
        _break_off(shop)
        place = _place_text(shop, shop.runner.course.host.position())
        typer.echo(f"interrupted: the machine is at rest at {place}", err=True)
        raise typer.Exit(INTERRUPTED) from None
    finally:
        _break_off(shop)
        shop.close()


def _single(dialect: str, *, is_dry: bool) -> "Start":
    from openacr.mill.workshop import Start

    return Start(dialect, is_dry=is_dry, is_repeated=False)


def _with_dialect(start: "Start", name: str) -> "Start":
    from dataclasses import replace

    return replace(start, dialect=name)


def _answer(text: str) -> tuple[int, float]:
    name, _, value = text.partition("=")
    try:
        return int(name.strip().lstrip("Pp#")), float(value)
    except ValueError:
        raise UserError(f"--answer {text}: write it as P200=1.5") from None


def _run(
    shop: "Workshop",
    program: "Program",
    start: "Start",
    is_quiet: bool,
    keep: "Callable[[Workshop], None]",
) -> None:
    from openacr.cli.online import progress_bar

    replay = shop.start(program, start)
    if replay is not None:
        _show_replay(replay, start)
    with progress_bar(Path(program.main.text.name).name) as show:
        count = 0
        while shop.runner.is_busy:
            shop.step()
            keep(shop)
            count += 1
            source = shop.runner.source
            if not is_quiet and source is not None and count % SHOW_EVERY == 0:
                show(source.line, program.line_cnt)


def _show_replay(replay: "Replay", start: "Start") -> None:
    for warning in replay.warnings:
        typer.echo(f"warning: {warning}", err=True)
    for each in replay.differences:
        typer.echo(f"{each.name}: now {each.present}, at the line {each.wanted}", err=True)
    if replay.needs_tool and not start.accepts_tool:
        raise UserError("another tool is in the spindle; --any-tool starts all the same")


def attend(shop: "Workshop") -> None:
    """Where the machine waits for somebody: nobody on a virtual one, the terminal else."""
    from openacr.mill.states import State

    if shop.is_virtual:
        shop.carry_on()
    elif shop.runner.state is State.HOLD:
        _ask(shop)
    elif shop.runner.asking is not None:
        _answer_to(shop, shop.runner.asking)


def _ask(shop: "Workshop") -> None:
    if not sys.stdin.isatty():
        shop.runner.abort()
        raise UserError(f"{shop.runner.reason}: nobody is at the terminal to go on")
    if typer.confirm(f"{shop.runner.reason}: go on?", default=True):
        shop.runner.start()
    else:
        shop.runner.abort()


def _answer_to(shop: "Workshop", ask: "Ask") -> None:
    if not sys.stdin.isatty():
        shop.runner.abort()
        raise UserError(f"nobody is at the terminal to answer {ask.text!r}; use --answer")
    shop.runner.course.host.answers[ask.parameter] = typer.prompt(ask.text, type=float)


def _break_off(shop: "Workshop") -> None:
    """However the command ends, the machine does not go on moving by itself."""
    from openacr.client import ConnectionLostError

    with suppress(ConnectionLostError):
        shop.runner.break_off()
        while shop.runner.is_busy:
            shop.step()


# --- reports ------------------------------------------------------------------------------


def _report(shop: "Workshop", as_json: bool, is_quiet: bool) -> None:
    runner = shop.runner
    place = runner.course.host.position()
    if as_json:
        record: dict[str, Any] = {
            "time_s": round(runner.run_s, 3),
            "moves": runner.course.moves,
            "passes": runner.passes,
            "end": {axis.name: place[axis.index] for axis in runner.settings.axes},
            "alarms": [
                {"code": alarm.kind.code, "text": alarm.text, "at_s": alarm.at_s}
                for alarm in runner.alarms.active
            ],
            "messages": [
                {
                    "number": each.message.number,
                    "text": each.message.shown,
                    "at_s": each.at_s,
                    "until_s": each.until_s,
                }
                for each in shop.messages.history
            ],
        }
        typer.echo(json_format.dumps(record, indent=1))
    elif not is_quiet:
        typer.echo(
            f"{clock(runner.run_s)}  ({runner.run_s:.2f} s, {runner.course.moves} moves)"
            f"  {_place_text(shop, place)}"
        )
    end_with_alarms(shop, is_shown=not as_json)


def _place_text(shop: "Workshop", place: tuple[float, ...]) -> str:
    from openacr.mill.readout import Readout

    axes = [axis.index for axis in shop.runner.settings.axes]
    return Readout(shop.cells).line(axes, place)


def end_with_alarms(shop: "Workshop", *, is_shown: bool = True) -> None:
    """Say what went wrong; exit code 1 when anything did."""
    active = shop.runner.alarms.active
    block = shop.block
    for alarm in active if is_shown else ():
        where = f" (line {block[0]}: {block[1]})" if block else ""
        typer.secho(f"alarm {alarm.kind.code}: {alarm.text}{where}", fg=typer.colors.RED, err=True)
    if shop.runner.alarms.bars_start:
        raise typer.Exit(FAILED)
