"""The paths of programs that browsers show: computed in another process, kept while they hold."""

import asyncio
import hashlib
import struct
from collections import OrderedDict
from dataclasses import dataclass
from pathlib import Path

from openacr.errors import UserError
from openacr.mill.plan.pictures.blank import SIZES
from openacr.panel.control.machine.installation import Installation
from openacr.panel.control.operator.loaded import version_of
from openacr.panel.control.thread import ControlThread
from openacr.panel.forms.catalogue import STARTS
from openacr.panel.work.paths import MARK, Found, read_file
from openacr.panel.work.processes import process
from openacr.sysvar import Store
from openacr.sysvar.schema import CARD_VARIABLES
from openacr.sysvar.tabs import CELLS, COMPATIBILITY, CONTROL, DISPLAY, GENERAL, SPEEDS
from openacr.workers.background import result_of

KEPT = 6
# Cells a path depends on: P parameters, zeros, offsets, radii, the codes that programs begin
# with, how arcs and colours are drawn, and the sizes of the blank.
CELLS_READ = (
    *range(CARD_VARIABLES.stop, CELLS.user_variables[0]),
    *range(CELLS.floating_zero_active, CELLS.work_system_in_use),
    *CELLS.d_radius,
    *CELLS.d_wear,
    *CELLS.h_length,
    *CELLS.h_wear,
    *STARTS,
    GENERAL.cmp_rad,
    GENERAL.run_setup_feedrate,
    SPEEDS.cut_speed,
    SPEEDS.chord_tolerance,
    SPEEDS.max_machine_speed,
    CONTROL.default_units,
    CONTROL.ij_inversion,
    CONTROL.power_up_incremental_or_absolute,
    CONTROL.path_color,
    *SIZES,
    COMPATIBILITY.compatibility,
    DISPLAY.control_mode,
    DISPLAY.color_via_d_codes,
)


@dataclass(slots=True)
class _Path:
    task: "asyncio.Task[Found]"


class Paths:
    """The paths of one panel."""

    def __init__(self, installation: Installation, control: ControlThread) -> None:
        self._installation, self._control = installation, control
        self._pool = process()
        self._kept: OrderedDict[str, _Path] = OrderedDict()

    async def of(self, file: Path, dialect: str = "") -> tuple[str, Found | None]:
        """The tag of a file's path, and the path; None while it is being computed."""
        version = await asyncio.to_thread(version_of, file)
        tag = f"{MARK.decode()}-{version}-{stamp(self._installation.store)}-{dialect}"
        kept = self._kept.get(tag)
        if kept is None:
            kept = self._kept[tag] = _Path(asyncio.create_task(self._computed(file, dialect)))
            while len(self._kept) > KEPT:
                self._kept.popitem(last=False)
        else:
            self._kept.move_to_end(tag)
        if not kept.task.done():
            await asyncio.wait((kept.task,), timeout=0.05)
        if not kept.task.done():
            return tag, None
        try:
            return tag, result_of(kept.task)
        except Exception:
            self._kept.pop(tag, None)
            raise

    async def _computed(self, file: Path, dialect: str) -> Found:
        store = self._installation.store.path
        if store is None:
            raise UserError("the store is in memory: no path can be computed")
        return await self._pool.run(read_file, file, store, dialect)

    async def show(self) -> None:
        """Compute the path of the loaded program; its time and extents go to the screens."""
        loaded = self._control.station.part.loaded
        if loaded is None:
            return
        try:
            while True:
                _tag, found = await self.of(loaded.file, loaded.dialect)
                if found is not None:
                    break
                await asyncio.sleep(0.1)
        except (OSError, UserError):
            return
        facts, version = found.facts(), loaded.version
        findings = found.findings
        self._control.call(lambda station: station.part.note_facts(version, facts, findings))

    def close(self) -> None:
        """End the process."""
        for kept in self._kept.values():
            kept.task.cancel()
        self._pool.end()


def stamp(store: Store, more: tuple[int, ...] = ()) -> str:
    """A mark that changes with everything in the store that a path depends on, and `more` cells."""
    read = store.read
    values = [read(cell) for cell in (*CELLS_READ, *more)]
    values += [store.is_set(cell) for cell in SIZES]  # a blank has those that are stored
    packed = struct.pack(f"<{len(values)}d", *values)
    return hashlib.blake2b(packed, digest_size=8).hexdigest()
