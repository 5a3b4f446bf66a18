"""All files of a configuration by their names in a project."""

from openacr.configure.answers import Answers
from openacr.configure.explained import explained
from openacr.configure.setup_code import FIRST_PLC, WATCH_PROGRAM, setup_code
from openacr.configure.watch_code import data_code, plc_codes, watch_code

DATA_PROGRAM = 15
SETUP = "setup.8k"


def code_files(answers: Answers, source: str, *, is_explained: bool = False) -> dict[str, str]:
    """The controller files made of the answers, whose text is `source`.

    With `is_explained` every line of the set-up file has a remark that says what it does.
    """
    plcs = [] if answers.card.watches_limits else plc_codes(answers)
    setup = setup_code(answers, len(plcs))
    files = {SETUP: explained(setup) if is_explained else setup}
    for place, rungs in enumerate(plcs):
        files[f"plc{FIRST_PLC + place}.8k"] = iter(rungs)
    if plcs:
        files[f"prog{WATCH_PROGRAM}.8k"] = watch_code(answers, source)
    else:
        files[f"prog{DATA_PROGRAM}.8k"] = data_code(source)
    return {name: "\n".join(lines).rstrip() + "\n" for name, lines in files.items()}
