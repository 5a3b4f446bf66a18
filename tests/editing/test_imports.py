"""What an engine imports for the files it is given."""

import subprocess
import sys

import pytest

CODE = """
import sys
from pathlib import Path
from openacr.editing.engine import Engine
from openacr.editing.document import Place
engine, path = Engine(), Path("{name}")
engine.open(path, "{text}")
engine.describe(path, Place(0, 0))
engine.findings(path)
engine.close(path)
heavy = {heavy}
print([name for name in sys.modules if name.startswith(heavy)])
"""


@pytest.mark.parametrize(
    ("name", "text", "heavy"),
    [
        ("a.8k", "SYS", ("openacr.cnc", "openacr.mill", "openacr.sysvar")),
        ("a.nc", "M2", ("openacr.source_check", "openacr.basic.commands")),
    ],
)
def test_a_file_imports_its_own_language_alone(
    name: str, text: str, heavy: tuple[str, ...]
) -> None:
    code = CODE.format(name=name, text=text, heavy=heavy)
    ran = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    assert ran.stdout == "[]\n"
