"""Operating system: hardware configuration, network, diagnostics, restart."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from openacr.basic.language import registry
from openacr.basic.language.grammar import Form, Int, Repeat, Str, Word
from openacr.basic.language.registry import ANY, IMMEDIATE
from openacr.basic.memory.setup import DEFAULT_CONFIG, Setup
from openacr.basic.vm.run import Run
from openacr.errors import CardError
from openacr.lang.lexer import TokenKind
from openacr.map.rows import axes
from openacr.messages import NOT_SUPPORTED, SYNTAX_ERROR
from openacr.motion.axis.modules import is_fitted
from openacr.motion.card import Card

if TYPE_CHECKING:
    from openacr.basic.language.parser import Parser

GROUP = "Operating System"
REF = "PG Operating System"
command = partial(registry.command, group=GROUP, ref=REF)
MODULES = 4
DIAGNOSTICS = 7044
DIAGNOSED = ("ISO", "EXT", "ENC", "BCF", "BCL", "VEE", "VDD")
EXPANSION_BOARDS = 4
EXPANSION_ENABLE = 116
CANOPEN_STATE = 32779
SERVO_FIXED_S = 25e-6
SERVO_PER_AXIS_S = 15e-6
EPL_OPERATIONAL, EPL_FAILED = 16649, 16650
CONFIG_NOTICE = "CONFIG acts after ESAVE and REBOOT"


class Modules(Form):
    """Four words, each directly followed by a number: `ENC8 DAC4 NONE ADC8`."""

    def starts(self, p: Parser) -> bool:
        """Whether a word stands here."""
        return p.cursor.token.kind is TokenKind.WORD

    def parse(self, p: Parser) -> tuple[str, ...]:
        """Read them; CLEAR stands alone."""
        if p.cursor.accept("CLEAR"):
            return DEFAULT_CONFIG
        found = []
        for _ in range(MODULES):
            if not self.starts(p):
                raise p.cursor.error(SYNTAX_ERROR)
            word = str(p.cursor.advance().value)
            has_number = p.cursor.token.kind is TokenKind.NUMBER
            found.append(word + (p.cursor.advance().text if has_number else ""))
        return tuple(found)


@command(
    "CONFIG",
    levels=ANY,
    grammar=(Modules("modules", optional=True),),
    default="ENC8 DAC4 DAC4 ADC8",
    saved=True,
)
def config(run: Run, modules: tuple[str, ...] | None) -> None:
    """Set the hardware modules, effective after ESAVE and REBOOT, or show them."""
    setup: Setup = run.system.setup
    if modules is None:
        run.print("CONFIG " + " ".join(setup.config))
        return
    setup.configure(modules)
    if not is_fitted(run.system.card, modules):
        run.print(CONFIG_NOTICE)


@command(
    "CONFIG IO",
    levels=ANY,
    grammar=(Word("INPUT", "OUTPUT", optional=True), Repeat(Int("group"), optional=True)),
)
def config_io(run: Run, direction: str | None, groups: tuple[int, ...] | None) -> None:
    """Choose the direction of onboard contacts; refused where it is fixed, as here."""
    raise CardError(NOT_SUPPORTED)


@command(
    "CONFIG XIO",
    levels=ANY,
    grammar=(Int("boards", 0, EXPANSION_BOARDS, optional=True),),
    default="0",
)
def config_xio(run: Run, boards: int | None) -> None:
    """Set how many expansion I/O boards are enabled, or show it."""
    flags = range(EXPANSION_ENABLE, EXPANSION_ENABLE + EXPANSION_BOARDS)
    memory = run.card.memory
    if boards is None:
        run.print(f"CONFIG XIO {sum(map(memory.bit, flags))}")
        return
    for board, flag in enumerate(flags):
        memory.set_bit(flag, board < boards)


@command(
    "IP",
    levels=ANY,
    grammar=(Word("MASK", "GATE", optional=True), Str("address", optional=True)),
    default="192.168.10.40",
    saved=True,
)
def ip(run: Run, name: str | None, address: str | None) -> None:
    """Set an address of the network, effective after REBOOT, or show all."""
    setup: Setup = run.system.setup
    if address is not None:
        setup.set_address(name or "IP", address)
        return
    for shown, value in setup.addresses.items():
        if name in (None, shown):
            run.print(f"{shown} {value}")


@command("DIAG", levels=ANY)
def diag(run: Run) -> None:
    """Report supplies and signals, expansion boards and the CANopen state."""
    memory = run.card.memory
    failed = int(memory.read(DIAGNOSTICS))
    for bit, name in enumerate(DIAGNOSED):
        run.print(f"{name} {'FAIL' if failed >> bit & 1 else 'PASS'}")
    for board in range(EXPANSION_BOARDS):
        present = memory.bit(EXPANSION_ENABLE + board)
        run.print(f"BOARD{board} {'PRESENT' if present else 'ABSENT'}")
    run.print(f"CANOPEN STATE {int(memory.read(CANOPEN_STATE))}")


@command(
    "EPLC",
    group="Drive Control",
    levels=ANY,
    grammar=(Word("ON", "OFF", optional=True),),
    ref="PG Drive Control",
    lacks="no modelled card has an ETHERNET Powerlink board: BIT16648 stays clear",
)
def eplc(run: Run, switch: str | None) -> None:
    """Start or stop the Ethernet Powerlink network; the virtual card has none to start."""
    memory = run.card.memory
    if switch is None:
        states = ((EPL_OPERATIONAL, "OPERATIONAL"), (EPL_FAILED, "FAILED"))
        run.print(next((text for bit, text in states if memory.bit(bit)), "OFF"))
        return
    memory.set_bit(EPL_FAILED, switch == "ON")
    memory.set_bit(EPL_OPERATIONAL, False)


@command("CPU", levels=ANY)
def cpu(run: Run) -> None:
    """Print the share of the servo interrupt and that of the rest of the processor time."""
    foreground = min(servo_time_s(run.card) / run.card.clock.period_s, 1.0) * 100
    run.print(f"Foreground {foreground:.1f}%")
    run.print(f"Background {100 - foreground:.1f}%")


def servo_time_s(card: Card) -> float:
    """Time one servo interrupt would take on the processor of a card.

    A model, so that equal states report equal loads: a fixed part and one per axis that
    is on.
    """
    on = sum(card.memory.I[axes.on[axis]] for axis in range(card.model.axes))
    return SERVO_FIXED_S + SERVO_PER_AXIS_S * on


@command("CIP", group="Global Objects", levels=ANY, ref="PG Global Objects")
def cip(run: Run) -> None:
    """Report the connections and the state of EtherNet/IP, which is not served: none, idle."""
    run.print("CIP connections 0")
    run.print("CIP state IDLE")


@command("REBOOT", levels=ANY, use=IMMEDIATE)
def reboot(run: Run) -> None:
    """Restart the card as at power-up."""
    run.system.reboot()
