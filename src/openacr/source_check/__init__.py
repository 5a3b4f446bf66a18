"""Controller files read as a card would read them, without a card: every line, every error.

    from pathlib import Path
    from openacr.source_check import check, check_text

    for fault in check(Path("examples/gantry")):
        print(fault)
    check_text("10 X 5\\n", Path("examples/gantry/prog0.8k"))  # as an editor holds it, unsaved

`openacr check` prints what `check` finds.
"""

from openacr.source_check.checking import check, check_text, read
from openacr.source_check.faults import Fault
from openacr.source_check.hints import meant
from openacr.source_check.listing import ladders, listed, listing
from openacr.source_check.source import Reader

__all__ = [
    "Fault",
    "Reader",
    "check",
    "check_text",
    "ladders",
    "listed",
    "listing",
    "meant",
    "read",
]
