"""Decide in each tick whether the networks need service; the work is done in Python."""

from openacr.map.numbers import (
    BUSNI_BASE,
    BUSNI_LEVELS,
    BUSNI_STRIDE,
    CANF_RESET_NETWORK,
    CANF_START_NETWORK,
    DTCF_AUTO_ADDRESS_REQUEST,
    DTCF_GET_CONFIGURATION_REQUEST,
    DTCF_GET_DRIVE_DATA_REQUEST,
    DTCF_SEND_CONFIGURATION_REQUEST,
    DTCF_SEND_ERRORL_REQUEST,
    DTCF_WORD,
    DTK_COUNT,
    DTSF_AUTO_ADDRESS_ALL,
    NETF_BASE,
    NETF_DUE_TK,
    NETL_COUNT,
    NETMI_BASE,
    NETMI_PHASE,
    NETMI_SLAVES,
    NETS_COUNT,
    NETSF_BASE,
    NETSF_CHANGE_TK,
    NETSF_STRIDE,
    NETSI_BASE,
    NETSI_LIVE,
    NETSI_NODE,
    NETSI_SENT,
    NETSI_STRIDE,
    NETSI_WORDS,
    SYSI_BASE,
    SYSI_SLOW_PHASE,
    W_CAN,
    W_DTALK_LPT1,
)
from openacr.views import F64, I32

__all__ = ["networks_due"]

RUNNING = 5  # what the network master is doing, see `canopen.rows.Phase`
DRIVE_REQUESTS = (
    DTCF_AUTO_ADDRESS_REQUEST
    | DTCF_GET_CONFIGURATION_REQUEST
    | DTCF_SEND_CONFIGURATION_REQUEST
    | DTCF_SEND_ERRORL_REQUEST
    | DTCF_GET_DRIVE_DATA_REQUEST
)


def networks_due(F: F64, I: I32, number: int) -> bool:
    """Whether a time has come, an input of a node has changed, or a request flag is set."""
    due: float = F[NETF_BASE + NETF_DUE_TK]
    if due > 0.0 and float(number) >= due:
        return True
    if I[NETMI_BASE + NETMI_PHASE] == RUNNING and inputs_changed(F, I):
        return True
    return I[SYSI_BASE + SYSI_SLOW_PHASE] == 0 and requests_set(I)


def inputs_changed(F: F64, I: I32) -> bool:
    """Whether a live node has a changed input that it has not sent yet."""
    count: int = min(I[NETMI_BASE + NETMI_SLAVES], NETS_COUNT)
    for slave in range(count):
        s: int = NETSI_BASE + slave * NETSI_STRIDE
        waits: float = F[NETSF_BASE + slave * NETSF_STRIDE + NETSF_CHANGE_TK]
        if I[s + NETSI_LIVE] and waits == 0.0:
            levels: int = BUSNI_BASE + I[s + NETSI_NODE] * BUSNI_STRIDE + BUSNI_LEVELS
            for word in range(I[s + NETSI_WORDS]):
                if I[levels + word] != I[s + NETSI_SENT + word]:
                    return True
    return False


def requests_set(I: I32) -> bool:
    """Whether a request flag of the networks is set; polled in the slow scan."""
    if I[W_CAN] & (CANF_START_NETWORK | CANF_RESET_NETWORK):
        return True
    for axis in range(DTK_COUNT):
        if I[DTCF_WORD + axis] & DRIVE_REQUESTS:
            return True
    for port in range(NETL_COUNT):
        if I[W_DTALK_LPT1 + port] & DTSF_AUTO_ADDRESS_ALL:
            return True
    return False
