"""The journals that served cards have left on this machine."""

import os
import time
from pathlib import Path

VARIABLE = "OPENACR_JOURNALS"


def ring_root() -> Path:
    """The folder for the journals of cards without one of their own: OPENACR_JOURNALS or ours."""
    named = os.environ.get(VARIABLE)
    if named:
        return Path(named).expanduser()
    import platformdirs

    return platformdirs.user_state_path("openacr") / "journals"


def listing() -> str:
    """The journals there, the latest last, with the time of their last record."""
    from openacr.controller.ring import journals

    root = ring_root()
    found = [path for folder in root.glob("*") if folder.is_dir() for path in journals(folder)]
    if not found:
        return f"no journals in {root}; name one: openacr replay JOURNAL"
    lines = [_line(path) for path in sorted(found, key=lambda path: path.stat().st_mtime)]
    return "\n".join(["journals of `openacr serve`, the latest last:", *lines])


def _line(path: Path) -> str:
    written = time.strftime("%Y-%m-%d %H:%M:%S", time.localtime(path.stat().st_mtime))
    return f"  {written}  {path}"
