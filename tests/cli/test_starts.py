"""What commands import before they do anything: the user waits for it each time."""

import gc
import os
import subprocess
import sys
from pathlib import Path

import pytest

from openacr.cli.imports import imports

# Each class written by `dataclasses` is compiled when its module is imported.
COUNTED = """
import dataclasses, sys
made, process = [], dataclasses._process_class
def counted(cls, *options):
    made.append(cls.__module__)
    return process(cls, *options)
dataclasses._process_class = counted
from openacr.cli.main import main
try:
    main(sys.argv[1:])
finally:
    print(sum(name.startswith("openacr") for name in made), file=sys.stderr)
"""

SAID_FIRST = """
import sys
from openacr.cli.main import main
class Terminal:
    encoding = "utf-8"
    def write(self, text):
        heavy = ("numpy", "openacr.controller", "openacr.mill", "openacr.panel.")
        found = [name for name in sys.modules if name.startswith(heavy)]
        sys.stdout.write(text.strip() + str(found))
        sys.stdout.flush()
        raise SystemExit
    def flush(self): pass
sys.stderr = Terminal()
main(["panel", "--no-browser", "--port", "0"])
"""


def _dataclasses_of(folder: Path, *arguments: str) -> int:
    """How many dataclasses of our own a command makes."""
    environment = {**os.environ, "OPENACR_STORE": str(folder / "sysvar.db")}
    command = [sys.executable, "-c", COUNTED, *arguments]
    done = subprocess.run(command, capture_output=True, text=True, check=True, env=environment)
    return int(done.stderr.splitlines()[-1])


def test_the_check_of_a_part_program_makes_hardly_any_dataclass(tmp_path: Path) -> None:
    program = tmp_path / "SHORT.NC"
    program.write_text("G0 X1\nM2\n")
    assert _dataclasses_of(tmp_path, "mill", "check", str(program)) <= 10


def test_the_panel_says_that_it_starts_before_it_imports_the_machine() -> None:
    command = [sys.executable, "-c", SAID_FIRST]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert done.stdout == "starting the panel ...[]"


def test_what_a_long_command_imports_is_left_out_of_later_collections() -> None:
    frozen = gc.get_freeze_count()
    try:
        with imports():
            assert not gc.isenabled()
            kept: list[list[int]] = [[] for _ in range(100)]
        assert gc.isenabled()
        assert gc.get_freeze_count() >= frozen + len(kept)
        with pytest.raises(ImportError), imports():
            raise ImportError
        assert gc.isenabled()
    finally:
        gc.unfreeze()


# What is registered first is called last.
FROZEN = """
import atexit, gc, sys
atexit.register(lambda: print(gc.get_freeze_count(), len(gc.get_objects()), file=sys.stderr))
from openacr.cli.main import main
main(sys.argv[1:])
"""


def test_the_end_of_a_command_looks_for_no_garbage() -> None:
    command = [sys.executable, "-c", FROZEN, "packet", "--help"]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    kept, searched = map(int, done.stderr.split())
    assert kept > 10_000 > 100 * searched


COLLECTED = """
import gc, sys
runs = []
gc.callbacks.append(lambda *_: runs.append(1) if "openacr.cli.main" in sys.modules else None)
from openacr.cli.main import main
try:
    main(sys.argv[1:])
finally:
    print(len(runs), file=sys.stderr)
"""


def test_what_a_command_imports_is_not_searched_for_garbage(tmp_path: Path) -> None:
    program = tmp_path / "SHORT.NC"
    program.write_text("G0 X1\nM2\n")
    environment = {**os.environ, "OPENACR_STORE": str(tmp_path / "sysvar.db")}
    command = [sys.executable, "-c", COLLECTED, "mill", "check", str(program)]
    done = subprocess.run(command, capture_output=True, text=True, check=True, env=environment)
    assert done.stderr.splitlines()[-1] == "0"


def test_the_check_of_a_part_program_loads_no_digests() -> None:
    command = "import sys, openacr.mill.plan.estimate.checking; print('hashlib' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", command], capture_output=True, check=True)
    assert done.stdout.strip() == b"False"
