"""Long steps of the Makefile show that they are alive."""

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
BEAT = re.compile(r"  \d\d:\d\d:\d\d still busy\n")

pytestmark = pytest.mark.skipif(shutil.which("make") is None, reason="make is not installed")


def test_a_long_step_prints_lines_until_it_ends(tmp_path: Path) -> None:
    ends = tmp_path / "ends"
    os.mkfifo(ends)
    rule = f"probe: ; @$(BEAT) read end <{ends}; echo done"
    command = ["make", "--silent", f"--eval={rule}", "BEAT_S=0.1", "probe"]
    with subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        for _ in range(2):
            assert BEAT.fullmatch(process.stdout.readline())
        ends.write_text("now\n", encoding="utf-8")
        rest = process.stdout.readlines()  # to the end: the lines end with the step
    assert process.returncode == 0
    assert rest[-1] == "done\n"


def planned(target: str) -> list[str]:
    """What a target would do where nothing is made yet."""
    command = ["make", "--dry-run", "--always-make", target]
    shown = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    return shown.replace("\\\n", " ").splitlines()


def test_the_demo_installs_what_it_needs_and_the_tests_install_the_rest() -> None:
    extras = re.compile(r'--editable "\.\[(.*)\]"')
    found = {target: extras.findall("\n".join(planned(target))) for target in ("demo", "test")}
    assert found["demo"] == ["panel,plot"]
    assert found["test"] == ["dev,bridge,dxf,lsp,panel,plot,sweep"]


@pytest.mark.parametrize(
    ("target", "steps"), [("demo", ["pip", "setup.py", "pip"]), ("site", ["pip", "sphinx"])]
)
def test_every_long_step_of_a_target_shows_that_it_is_alive(target: str, steps: list[str]) -> None:
    recipe = planned(target)
    alive = [line for line in recipe if "still busy" in line]
    for step, line in zip(steps, alive[-len(steps) :], strict=True):
        assert step in line.partition("&")[2]
    long = re.compile(r" -m pip .*install|build_ext|-m sphinx")
    assert [line for line in recipe if long.search(line) and "still busy" not in line] == []
