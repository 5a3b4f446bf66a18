"""Cases of the manuals: dialogues, programs, packets and what a card must answer, as text files.

    from pathlib import Path
    from openacr.conform import read, report, run

    for case in read(Path("conformance/programmers-guide/12-parameters-and-bits.txt")):
        difference = run(case)
        if difference:
            print(report(case, difference))

How a file is written: docs/conformance.md.
"""

from openacr.conform.form import Case, Claim, DifferenceError
from openacr.conform.read import files, read
from openacr.conform.run import report, run

__all__ = ["Case", "Claim", "DifferenceError", "files", "read", "report", "run"]
