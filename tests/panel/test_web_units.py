"""Functions of the screens that need no browser, by the tests of `tests/panel/web`.

They run in one process of Node, which the package of the browser tests brings.
"""

import json
import os
import re
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright._impl._driver import compute_driver_executable

from openacr.configure.dialogs import DIALOGS, Dialog
from openacr.panel.commands.all import COMMANDS
from openacr.panel.forms.catalogue import FORMS
from openacr.panel.forms.form import Form
from openacr.panel.forms.values import RefusedError, save
from openacr.sysvar import Store
from openacr.sysvar.lookup import known
from openacr.sysvar.tabs import (
    AXIS,
    CONTROL,
    DISPLAY,
    FOV,
    GENERAL,
    IO,
    JOG,
    MESSAGES,
    SERVO,
    SPEEDS,
)

FOLDER = Path(__file__).parent / "web"
OPTIONS = ("--test", "--test-isolation=none", "--test-reporter=spec", "--no-warnings")

WRONG = (  # one value for each kind of refusal
    ("SERVO", SERVO.p_gain[0], "x"), ("GENERAL", GENERAL.card_number, "8"),
    ("CONTROL", CONTROL.default_units, "7"), ("CONTROL", CONTROL.acute_angle2, "-4"),
    ("AXES", AXIS.name[1], "X"), ("AXES", AXIS.name[0], "Q"), ("IO", IO.emergency_stop, "500"),
    ("DISPLAY", DISPLAY.inch_format[0], "12"), ("FOV", FOV.percents[3], "1"),
    ("MESSAGES", MESSAGES.text[0], "t" * 300), ("JOG", JOG.feedrate[0], "-1"),
    ("SPEEDS", SPEEDS.rapid_speed, "-2"),
)  # fmt: skip


def texts_of(form: Form, store: Store) -> Iterator[str]:
    """What a form shows, in English."""
    yield form.title
    for group in form.groups(store, 0 if form.is_per_axis else None):
        yield group.title
        for each in map(known, group.cells):
            yield from (
                each.name,
                each.row.doc,
                each.row.typical,
                *each.row.words.values(),
                *each.row.bits,
            )


def texts_of_rows(dialog: Dialog) -> Iterator[str]:
    """What a dialog of the wizard asks, in English."""
    for row in dialog.rows:
        yield from (row.title, row.help)


def refusals(store: Store) -> Iterator[str]:
    """Why values are refused, in English."""
    for form, cell, value in WRONG:
        with pytest.raises(RefusedError) as refused:
            save(FORMS[form], store, {str(cell): value})
        yield from refused.value.refused.values()


def test_the_functions_of_the_screens_do_what_their_tests_say() -> None:
    files = sorted(str(each) for each in FOLDER.glob("*.test.js"))
    titles = json.dumps([name for name, row in COMMANDS.items() if row.titles])
    with Store() as store:
        texts = {text for form in FORMS.values() for text in texts_of(form, store)}
        texts |= {text for each in DIALOGS for text in (each.title, *texts_of_rows(each))}
        settings = json.dumps(sorted({re.sub(r"[0-9]+(\.[0-9]+)*", "{}", each) for each in texts}))
        reasons = json.dumps(list(refusals(store)))
    given = {"TITLES": titles, "SETTINGS": settings, "REFUSALS": reasons}
    run = subprocess.run(
        [compute_driver_executable()[0], *OPTIONS, *files],
        capture_output=True, text=True, check=False, env=os.environ | given,
    )  # fmt: skip
    assert run.returncode == 0, run.stdout + run.stderr
    assert "\u2139 fail 0" in run.stdout
    assert "\u2139 skipped 0" in run.stdout
