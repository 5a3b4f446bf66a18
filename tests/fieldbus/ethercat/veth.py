"""Two ends of a cable inside this computer, and `openacr bus emulate` on one of them."""

import os
import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager

import pytest
from tests.fieldbus.emulator import Emulator, emulating


@contextmanager
def emulated(*words: str) -> Iterator[Emulator]:
    """The master's end of a cable, with slaves on the other; skips without the right to it."""
    own, other = f"oem{os.getpid()}", f"oes{os.getpid()}"
    if shutil.which("ip") is None:
        pytest.skip("no command `ip`: no network interfaces can be made")
    made = subprocess.run(
        ["ip", "link", "add", own, "type", "veth", "peer", "name", other],
        capture_output=True,
        check=False,
    )
    if made.returncode:
        pytest.skip("veth interfaces need root and a kernel that has them")
    try:
        for each in (own, other):
            subprocess.run(["ip", "link", "set", each, "up"], check=True)
        with emulating(own, "--interface", other, *words) as one:
            assert one.line().startswith(f"emulating on {other}: 0 ")
            yield one
    finally:
        subprocess.run(["ip", "link", "delete", own], check=False)
