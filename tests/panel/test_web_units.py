"""Functions of the screens that need no browser, by the tests of `tests/panel/web`.

They run in one process of Node, which the package of the browser tests brings.
"""

import json
import os
import subprocess
from pathlib import Path

from playwright._impl._driver import compute_driver_executable

from openacr.panel.commands.all import COMMANDS

FOLDER = Path(__file__).parent / "web"
OPTIONS = ("--test", "--test-isolation=none", "--test-reporter=spec", "--no-warnings")


def test_the_functions_of_the_screens_do_what_their_tests_say() -> None:
    files = sorted(str(each) for each in FOLDER.glob("*.test.js"))
    titles = json.dumps([name for name, row in COMMANDS.items() if row.titles])
    run = subprocess.run(
        [compute_driver_executable()[0], *OPTIONS, *files],
        capture_output=True, text=True, check=False, env=os.environ | {"TITLES": titles},
    )  # fmt: skip
    assert run.returncode == 0, run.stdout + run.stderr
    assert "\u2139 fail 0" in run.stdout
    assert "\u2139 skipped 0" in run.stdout
