"""`openacr mill run`, `batch`: part programs on a virtual or a real machine."""

import json as json_format
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from openacr.cli.mill.check import (
    AsJson,
    AtStore,
    Dialect,
    Dry,
    PartProgram,
    clock,
    in_folder,
    loaded,
    opened_store,
    show_findings,
)
from openacr.cli.mill.console import COMMAND_LIST, Console
from openacr.cli.mill.shop import ToHost, end_with_alarms, place_text, workshop
from openacr.cli.mill.terminal import Attendant, require_yes
from openacr.cli.mill.trace import Every, ToTrace, require_trace, trace_file
from openacr.errors import UserError
from openacr.wording import counted

if TYPE_CHECKING:
    from openacr.cnc.interpreter.replay import Replay
    from openacr.cnc.loading.batch import Batch, Entry
    from openacr.cnc.program.program import Program
    from openacr.mill.session import MillSession, Start
    from openacr.sysvar import Store

FAILED = 1
SHOW_EVERY = 25  # steps


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
    safe_z: Annotated[
        float | None,
        typer.Option(
            "--safe-z", metavar="Z", help="Machine position of Z where the tool is clear."
        ),
    ] = None,
    is_agreed: Annotated[
        bool, typer.Option("--yes", help="Start at a line without asking.")
    ] = False,
    is_skipping: Annotated[
        bool, typer.Option("--block-skip", help="Skip blocks with a slash.")
    ] = False,
    stops_optionally: Annotated[bool, typer.Option("--optional-stop", help="Stop at M1.")] = False,
    answers: Annotated[
        list[str] | None, typer.Option("--answer", metavar="Pn=VALUE", help="Answer to an INPUT.")
    ] = None,
    as_json: AsJson = False,
    is_quiet: Annotated[
        bool, typer.Option("--quiet", help="Show no progress and no summary.")
    ] = False,
    has_console: Annotated[
        bool,
        typer.Option(
            "--console",
            help=f"Take commands while it runs: {COMMAND_LIST}.",
        ),
    ] = False,
    trace: ToTrace = None,
    every_s: Every = None,
) -> None:
    """Run a part program on the virtual machine or on a card.

    The virtual machine is at its reference points, runs as fast as it can and waits for
    no operator. On a card Ctrl-C is a feed hold and ends the program; stops ask on the terminal.
    """
    from openacr.mill.session import Start

    require_trace(trace, every_s)
    if trace is not None and host is not None:
        raise UserError(
            "--trace: only the virtual machine records the setpoints of every servo period; those"
            " of a card of `openacr serve` come from its journal (openacr replay JOURNAL --trace),"
            " on another card use SAMP"
        )
    start = Start(
        line=line,
        is_dry=is_dry,
        is_skipping=is_skipping,
        stops_optionally=stops_optionally,
        is_repeated=host is not None,  # on the virtual machine no operator would end it
        accepts_tool=accepts_tool,
        safe_z=safe_z,
    )
    with opened_store(store, is_written=host is not None) as cells:
        program, name = _checked(file, cells, dialect, as_json=as_json)
        with workshop(host, cells, to_stderr=as_json) as shop:
            shop.runner.stream.host.answers.update(map(_answer, answers or []))
            start = _with_dialect(start, name)
            terminal, replay = Attendant(), None
            if line > 1:
                replay = _rehearsed(shop, program, start, None if is_agreed else terminal)
            keep = Console(lines=terminal.lines).attend if has_console else terminal
            with _traced(shop, trace, every_s, keep) as attend:
                _run(shop, program, start, is_quiet or as_json, attend, replay)
            _report(shop, as_json, is_quiet)


def run_batch(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="Program names, one per line.")],
    host: ToHost = None,
    store: AtStore = None,
    dialect: Dialect = None,
    is_dry: Dry = False,
) -> None:
    """Run the programs of a batch file one after the other.

    All of them are checked before the first one starts; an alarm ends the batch.
    """
    from openacr.cnc.loading.batch import read_batch

    batch = read_batch(file)
    with opened_store(store, is_written=host is not None) as cells:
        programs = {path: _checked(path, cells, dialect) for path in batch.programs}
        with workshop(host, cells) as shop:
            attend = Attendant()
            for each in _runs(batch, repeats=shop.runner.settings.repeats):
                program, name = programs[each.path]
                typer.echo(each.path.name)
                _run(shop, program, _single(name, is_dry=is_dry), False, attend)
                end_with_alarms(shop)


def _runs(batch: "Batch", *, repeats: bool) -> "Iterator[Entry]":
    """The runs of a batch, repeated if the store enables Repeat Forever."""
    yield from batch.runs()
    while repeats:
        yield from batch.runs()


def _checked(
    path: Path, cells: "Store", dialect: str | None, *, as_json: bool = False
) -> "tuple[Program, str]":
    """Load a program; exit with code 1 if it has errors."""
    program, name = loaded(path, cells, dialect)
    if program.errors:
        findings = in_folder(program.errors, path)
        show_findings(findings)
        if as_json:
            errors = [finding.data() for finding in findings]
            typer.echo(json_format.dumps({"dialect": name, "errors": errors}, indent=1))
        raise typer.Exit(FAILED)
    return program, name


# --- running ------------------------------------------------------------------------------


def _single(dialect: str, *, is_dry: bool) -> "Start":
    from openacr.mill.session import Start

    return Start(dialect=dialect, is_dry=is_dry, is_repeated=False)


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
    shop: "MillSession",
    program: "Program",
    start: "Start",
    is_quiet: bool,
    keep: "Callable[[MillSession], None]",
    replay: "Replay | None" = None,
) -> None:
    from openacr.cli.live.online import progress_bar

    shop.start(program, start, replay)
    with progress_bar(Path(program.main.text.name).name) as show:
        count = 0
        while shop.runner.is_busy:
            shop.step()
            keep(shop)
            count += 1
            source = shop.runner.source
            if not is_quiet and source is not None and count % SHOW_EVERY == 0:
                show(source.line, program.line_cnt)


@contextmanager
def _traced(
    shop: "MillSession",
    path: Path | None,
    every_s: float | None,
    keep: "Callable[[MillSession], None]",
) -> "Iterator[Callable[[MillSession], None]]":
    """The function called after every step: `keep`, and the trace if one is requested."""
    if path is None or shop.virtual_card is None:
        yield keep
        return
    from openacr.mill.run.tracing import RunTrace

    with trace_file(path, [axis.name for axis in shop.runner.settings.axes]) as write:
        record = RunTrace(shop.virtual_card, shop.runner, every_s, write)

        def attend(shop: "MillSession") -> None:
            record.note()
            keep(shop)

        yield attend


def _rehearsed(
    shop: "MillSession", program: "Program", start: "Start", terminal: Attendant | None
) -> "Replay":
    """Rehearse the lines before a start line, show differences, and ask on a real machine."""
    from openacr.cnc.interpreter.replay import number

    replay = shop.rehearse(program, start)
    for warning in replay.warnings:
        typer.echo(f"warning: {warning}", err=True)
    for each in replay.differences:
        now, then = each.shown(each.present), each.shown(each.wanted)
        typer.echo(f"{each.name}: now {now}, at the line {then}", err=True)
    if replay.needs_tool and not start.accepts_tool:
        raise UserError("another tool is in the spindle; --any-tool starts anyway")
    if terminal is not None and not shop.is_virtual:
        level = number(replay.safe_level())
        text = f"line {start.line}: Z to {level}, across, then down at feed: start?"
        require_yes(shop, terminal, text, "no operator at a terminal to confirm; use --yes")
    return replay


# --- reports ------------------------------------------------------------------------------


def _report(shop: "MillSession", as_json: bool, is_quiet: bool) -> None:
    runner = shop.runner
    place = runner.stream.host.position()
    if as_json:
        record: dict[str, Any] = {
            "time_s": round(runner.run_s, 3),
            "moves": runner.stream.moves,
            "passes": runner.passes,
            "unit": shop.cells_unit,
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
            f"{clock(runner.run_s)}  ({runner.run_s:.2f} s, {counted(runner.stream.moves, 'move')})"
            f"  {place_text(shop, place)}"
        )
    end_with_alarms(shop, is_shown=not as_json)
