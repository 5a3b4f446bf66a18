"""Decide in each tick whether the networks need service; the work is done in Python."""

from openacr.map import numbers as at
from openacr.map.rows import (
    drive_talk,
    drive_talk_lines,
    network_master,
    network_slaves,
    networks,
    system,
)
from openacr.map.words import canf, dtcf, dtsf
from openacr.views import F64, I32

__all__ = ["networks_due"]

RUNNING = 5  # what the network master is doing, see `canopen.rows.Phase`
DRIVE_REQUESTS = (
    dtcf.AUTO_ADDRESS_REQUEST
    | dtcf.GET_CONFIGURATION_REQUEST
    | dtcf.SEND_CONFIGURATION_REQUEST
    | dtcf.SEND_ERRORL_REQUEST
    | dtcf.GET_DRIVE_DATA_REQUEST
)


def networks_due(F: F64, I: I32, number: int) -> bool:
    """Whether a time has come, an input of a node has changed, or a request flag is set."""
    due: float = F[networks.due_tk]
    if due > 0.0 and float(number) >= due:
        return True
    if I[network_master.phase] == RUNNING and inputs_changed(F, I):
        return True
    return I[system.slow_phase] == 0 and requests_set(I)


def inputs_changed(F: F64, I: I32) -> bool:
    """Whether a live node has a changed input that it has not sent yet."""
    count: int = min(I[network_master.slaves], network_slaves.COUNT)
    for slave in range(count):
        s: int = at.NETSI_BASE + slave * at.NETSI_STRIDE
        waits: float = F[at.NETSF_BASE + slave * at.NETSF_STRIDE + at.NETSF_CHANGE_TK]
        if I[s + at.NETSI_LIVE] and waits == 0.0:
            levels: int = at.BUSNI_BASE + I[s + at.NETSI_NODE] * at.BUSNI_STRIDE + at.BUSNI_LEVELS
            for word in range(I[s + at.NETSI_WORDS]):
                if I[levels + word] != I[s + at.NETSI_SENT + word]:
                    return True
    return False


def requests_set(I: I32) -> bool:
    """Whether a request flag of the networks is set; polled in the slow scan."""
    if I[at.W_CAN] & (canf.START_NETWORK | canf.RESET_NETWORK):
        return True
    for axis in range(drive_talk.COUNT):
        if I[at.DTCF_WORD + axis] & DRIVE_REQUESTS:
            return True
    for port in range(drive_talk_lines.COUNT):
        if I[at.W_DTALK_LPT1 + port] & dtsf.AUTO_ADDRESS_ALL:
            return True
    return False
