"""What a module of the tests prints as JSON where the core is plain Python."""

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]


def printed_by_plain_python(module: str) -> Any:
    """Run a module in a process of its own without the compiled core."""
    path = os.pathsep.join((str(ROOT / "src"), str(ROOT)))
    run = subprocess.run(
        [sys.executable, "-m", module],
        env=os.environ | {"OPENACR_PURE": "1", "PYTHONPATH": path},
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    )
    return json.loads(run.stdout)
