"""Write the expected traces of the examples again: `python -m tests.examples.regenerate [name]`.

Read the difference before you commit it: it is what users of the examples will see.
"""

import sys

from tests.examples.observe import observe, trace
from tests.examples.watches import ALL


def regenerate(names: list[str]) -> None:
    """Write the traces of the named examples, or of all."""
    for watch in ALL:
        if not names or watch.example in names:
            watch.golden.parent.mkdir(parents=True, exist_ok=True)
            watch.golden.write_text(trace(observe(watch), watch))


if __name__ == "__main__":
    regenerate(sys.argv[1:])
