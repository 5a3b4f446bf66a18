"""All files of a configuration by their names in a project."""

from openacr.configure.answers import Answers
from openacr.configure.setup_code import WATCH_PROGRAM, setup_code
from openacr.configure.watch_code import data_code, plc_codes, watch_code

DATA_PROGRAM = 15
FIRST_PLC = 5
SETUP = "setup.8k"


def code_files(answers: Answers, source: str) -> dict[str, str]:
    """The controller files made of the answers, whose text is `source`."""
    plcs = [] if answers.card.watches_limits else plc_codes(answers)
    files = {SETUP: setup_code(answers, len(plcs))}
    for place, rungs in enumerate(plcs):
        files[f"plc{FIRST_PLC + place}.8k"] = iter(rungs)
    if plcs:
        files[f"prog{WATCH_PROGRAM}.8k"] = watch_code(answers, source)
    else:
        files[f"prog{DATA_PROGRAM}.8k"] = data_code(source)
    return {name: "\n".join(lines).rstrip() + "\n" for name, lines in files.items()}
