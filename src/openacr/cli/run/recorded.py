"""`openacr replay` of a recorded session: a virtual card in place of the one that was recorded."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from openacr.errors import SourceError
from openacr.wording import counted

if TYPE_CHECKING:
    from openacr.controller import Controller
    from openacr.io.session_replay import Difference

DIFFERS = 1


def replay_recording(path: Path, project: Path | None, *, as_json: bool) -> None:
    """Give a recorded session to a virtual card; exit code 1 if an answer differs."""
    from openacr.io.recorded_session import read_recording
    from openacr.io.session_replay import SessionReplay

    recording = read_recording(path)
    card = _card(project)
    try:
        difference = SessionReplay(card).run(recording)
    finally:
        card.close()
    if not recording.is_whole:
        typer.echo("note: the last line of the recording is cut off and was left out", err=True)
    if as_json:
        typer.echo(json.dumps(_record(difference, len(recording.entries)), indent=2))
    elif difference is None:
        typer.echo(f"{counted(len(recording.entries), 'event')}: every answer is the same")
    else:
        typer.echo(
            f"connection {difference.connection}, {difference.time_s:.4f} s: the answer to"
            f" {_shown(difference.sent)} differs"
        )
        typer.echo(f"  recorded  {_shown(difference.recorded)}")
        typer.echo(f"  replayed  {_shown(difference.replayed)}")
    if difference is not None:
        raise typer.Exit(DIFFERS)


def _card(project: Path | None) -> "Controller":
    from openacr.controller import Controller
    from openacr.plant.describe.schema import exact_world
    from openacr.project import find_project

    if project is None:
        card, refused = Controller(world=exact_world()), list[SourceError]()
    else:
        card, refused = Controller.load(find_project(project))
    if refused:
        card.close()
        raise refused[0]
    card.is_journalled = False
    return card


def _shown(data: bytes) -> str:
    """Bytes as a line of Python shows them, which also tells nothing from an empty line."""
    return repr(data)[1:] if data else "nothing"


def _record(difference: "Difference | None", events: int) -> dict[str, Any]:
    found = None
    if difference is not None:
        found = {
            "time_s": difference.time_s,
            "connection": difference.connection,
            "sent": difference.sent.decode("latin-1"),
            "recorded": difference.recorded.decode("latin-1"),
            "replayed": difference.replayed.decode("latin-1"),
        }
    return {"events": events, "difference": found}
