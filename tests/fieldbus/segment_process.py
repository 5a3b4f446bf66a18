"""An emulated segment as a process of its own, at one end of a pair of sockets.

`python -m tests.fieldbus.segment_process FRAMES COMMANDS DIGITAL < machine.toml`, two numbers of
sockets: on one frames are answered, on the other faults are caused, which answers position and
state of the drives, a line each.
"""

import select
import socket
import sys
import time

from openacr.fieldbus.ethercat.emulated.build import segment_of
from openacr.fieldbus.ethercat.emulated.drive import Drive
from openacr.fieldbus.ethercat.emulated.faults import Line
from openacr.fieldbus.ethercat.wire.registers import Register
from openacr.plant.describe.load import parse_world

WATCHDOG_2_6_S = 65000  # with the usual 1000 units


def main() -> None:
    frames, commands = (socket.socket(fileno=int(number)) for number in sys.argv[1:3])
    segment = segment_of(parse_world(sys.stdin.read()), int(sys.argv[3]))
    drives = [slave for slave in segment.slaves if isinstance(slave, Drive)]
    for slave in segment.slaves:  # a busy computer may let them wait longer than a cable
        slave.controller.put(Register.WATCHDOG_DIVIDER, WATCHDOG_2_6_S, 2)
    line = Line(segment)
    commands.send(b"ready")
    while True:
        ready = select.select([frames, commands], [], [])[0]
        if frames in ready:
            for sent in line.send(frames.recv(2048), time.monotonic_ns()):
                frames.send(sent.frame)
        if commands in ready:
            text = commands.recv(2048).decode()
            if not text:
                return
            if text != "state":
                line.command(text)
            shown = (f"{each.motor.position_cnt:.3f} {each.shown()}" for each in drives)
            commands.send("\n".join(shown).encode())


if __name__ == "__main__":
    main()
