"""The configuration wizard: its dialogs, code made of answers, and answers made of code."""

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated, Any

from msgspec import Meta, to_builtins
from starlette.concurrency import run_in_threadpool

from openacr.configure import code_files, parse_answers
from openacr.configure.answers import warnings
from openacr.configure.dialogs import data
from openacr.configure.differences import differences
from openacr.configure.files import SETUP
from openacr.configure.load import checked
from openacr.configure.queries import Virtual
from openacr.configure.recovered import recovered
from openacr.configure.written import written
from openacr.controller import Controller
from openacr.errors import SourceError, UserError
from openacr.models import DEFAULT_MODEL
from openacr.panel.roles import Role
from openacr.panel.server.api import Body, Call, endpoint
from openacr.plant.describe.schema import ModelName

MOST_TEXT = 1 << 20

FIRST = {"axis": [{"number": 0, "name": "X", "units_per_rev": 5.0, "counts_per_rev": 8000}],
         "master": [{"number": 0, "axes": ["X"]}]}  # fmt: skip


class Given(Body, frozen=True):
    """Answers as the tables of configure.toml; keys that are left out are as by default."""

    answers: dict[str, Any]


class Text(Body, frozen=True):
    """The text of a file, configure.toml or set-up code, and for code the model of the card."""

    name: Annotated[str, Meta(max_length=255)]
    text: Annotated[str, Meta(max_length=MOST_TEXT)]
    model: ModelName = ModelName(DEFAULT_MODEL.name)


@endpoint("GET", "/configure")
async def configure_dialogs(call: Call) -> object:
    """The dialogs of the configuration wizard, and answers to begin with."""
    return {"dialogs": data(), "answers": FIRST}


@endpoint("POST", "/configure/code", body=Given)
async def configure_code(call: Call) -> object:
    """The code of answers, every line explained, and the file that keeps them.

    Without `files`, `errors` says where (keys and places in the tables) and what is wrong.
    """
    return await run_in_threadpool(_code, call.body.answers)


def _code(raw: dict[str, Any]) -> object:
    answers, errors = checked(raw)
    if answers is None or errors:
        return {"errors": [{"where": steps, "text": text} for steps, text in errors]}
    text = written(answers)
    files = {"configure.toml": text, **code_files(answers, text, is_explained=True)}
    return {"errors": [], "warnings": list(warnings(answers)), "files": files}


@endpoint("POST", "/configure/read", Role.SERVICE, body=Text)
async def configure_read(call: Call) -> object:
    """The answers in a file, and notes on what they cannot hold.

    Set-up code is tried on a virtual card.
    """
    body: Text = call.body
    is_toml = body.name.lower().endswith(".toml")
    return await run_in_threadpool(_answers if is_toml else _recovered, body)


def _answers(body: Text) -> object:
    return {"answers": to_builtins(parse_answers(body.text, body.name)), "notes": []}


def _recovered(body: Text) -> object:
    with TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "machine.toml").write_text(f'[card]\nmodel = "{body.model}"\n')
        (folder / SETUP).write_text(body.text, encoding="utf-8")
        try:
            controller = Controller.from_project(folder)
        except SourceError as error:
            raise UserError(str(error).replace(str(folder / SETUP), body.name)) from None
    card = Virtual(controller)
    found = recovered(card, body.model)
    return {"answers": to_builtins(found), "notes": list(differences(card, found))}
