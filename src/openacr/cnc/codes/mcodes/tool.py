"""M6: tool change."""

from __future__ import annotations

from typing import TYPE_CHECKING

from openacr.cnc.canonical import Spin, Spindle, Tool
from openacr.cnc.codes.fast import Does
from openacr.cnc.codes.table import Step
from openacr.cnc.codes.tables import ACROMILL

if TYPE_CHECKING:
    from openacr.cnc.codes.run import Run
    from openacr.cnc.program.block_context import BlockContext


@ACROMILL.mcode(6, step=Step.TOOL_CHANGE, fast=Does.TURNS)
def change_tool(run: Run, b: BlockContext) -> None:
    """Change to tool T; nothing happens when it is in the spindle already."""
    modal = run.modal
    if modal.tool == modal.tool_in_spindle:
        return
    if not run.options.is_dry:
        if modal.spin is not Spin.OFF:
            modal.spin = Spin.OFF
            run.tell(Spindle(b.source, Spin.OFF, modal.speed))
        run.tell(Tool(b.source, modal.tool))
    modal.tool_in_spindle = modal.tool
