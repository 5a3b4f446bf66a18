"""Run in a fresh environment by cibuildwheel: the wheel has its core, and both forms agree."""

import os
import subprocess
import sys

CODE = """
import sys
from openacr.compiled import is_compiled
from openacr.controller import Controller
from openacr.starter.supplied import example_named
card = Controller.from_project(example_named("square").folder)
card.send("PROG0\\rRUN\\r")
card.advance(2000)
print(is_compiled, card.digest())
"""


def run(pure: str) -> list[str]:
    """What the code prints, with or without the compiled core."""
    environment = {**os.environ, "OPENACR_PURE": pure}
    command = [sys.executable, "-c", CODE]
    found = subprocess.run(command, env=environment, check=True, capture_output=True, text=True)
    return found.stdout.split()


def main() -> int:
    """Compare; the exit code is 1 if the core is missing or differs."""
    compiled, pure = run("0"), run("1")
    print("compiled", *compiled, "pure", *pure)
    return int(compiled[0] != "True" or pure[0] != "False" or compiled[1] != pure[1])


if __name__ == "__main__":
    sys.exit(main())
