"""Non-volatile: programs that start by themselves."""

from openacr.basic.registry import ANY, command
from openacr.basic.run import Run


@command("PBOOT", group="Non-Volatile", levels=ANY, ref="PG Startup Programs")
def pboot(run: Run) -> None:
    """As first statement, start the program at power-up; typed, start all such programs."""
    if not run.stored:
        run.system.start_boot_programs()
