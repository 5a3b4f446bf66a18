"""What Linux gives a thread that has to be on time: its priority, its core, memory that stays."""

import contextlib
import ctypes
import os
import sys

from openacr.errors import UserError, reason

PRIORITY = 80  # of SCHED_FIFO; the kernel's own interrupts have 50
_MCL_CURRENT_AND_FUTURE = 3
_PR_SET_TIMERSLACK = 29
_NO_SLEEP_STATES = "/dev/cpu_dma_latency"


class RealtimeRights:
    """Rights of the thread that calls `take`; `missing` says in sentences what was refused."""

    def __init__(self, core: int | None = None) -> None:
        """UserError elsewhere than on Linux, and for a core that this computer does not have."""
        if sys.platform != "linux":
            raise UserError("--realtime needs Linux (and the compiled core)")
        cores = sorted(os.sched_getaffinity(0))
        if core is not None and core not in cores:
            known = ", ".join(map(str, cores))
            raise UserError(f"--core {core}: this process may use the cores {known}")
        self._core = core
        self._held: int | None = None  # keeps the processor from sleeping deeply while it is open
        self.missing: list[str] = []

    def take(self) -> None:
        """Take what can be had for the calling thread; memory is locked for the whole process."""
        if sys.platform != "linux":
            return
        libc = ctypes.CDLL(None, use_errno=True)
        libc.prctl(_PR_SET_TIMERSLACK, 1, 0, 0, 0)
        if self._core is not None:
            os.sched_setaffinity(0, {self._core})
        try:
            os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(PRIORITY))
        except OSError as failure:
            self.missing.append(
                f"no real-time priority ({reason(failure)}): the loop competes with all other"
                " programs; run as root or give the right CAP_SYS_NICE"
            )
        if libc.mlockall(_MCL_CURRENT_AND_FUTURE):
            self.missing.append(
                f"memory is not locked ({os.strerror(ctypes.get_errno())}): a page that was swapped"
                " out makes a cycle late; run as root or raise the limit (ulimit -l unlimited)"
            )
        with contextlib.suppress(OSError):
            self._held = os.open(_NO_SLEEP_STATES, os.O_WRONLY)
            os.write(self._held, bytes(4))

    def give_back(self) -> None:
        """Let the processor sleep again, and memory be swapped."""
        if self._held is not None:
            os.close(self._held)
            self._held = None
        ctypes.CDLL(None).munlockall()
