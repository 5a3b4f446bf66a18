"""Help texts of the keys: pages of those that open something; commands have theirs beside them."""

from typing import NamedTuple


class Page(NamedTuple):
    """A page of HELP."""

    key: str  # as the screens ask for it
    title: str
    text: str  # paragraphs, with empty lines between them


HELPS = (
    Page(
        "edit",
        "EDIT",
        "Choose a file of the list, or type its name: one that does not exist begins a new part"
        " program. Errors are marked while you type. The program that is running"
        " cannot be stored; a program that is loaded has to be loaded again to take the change.",
    ),
    Page(
        "setup",
        "RUN SETUP",
        "What a program needs that does not say it itself: the radius of the cutter (CMP RAD), the"
        " feedrate, P parameters, modal codes. Then LOAD PROG. A program that sets all this itself"
        " can be loaded at once.",
    ),
    Page(
        "cmprad",
        "CMP RAD",
        "The radius of the cutter for programs that choose no D.",
    ),
    Page(
        "feedrate",
        "FEEDRATE",
        "The feed of programs before their first F; 0: Cut Speed.",
    ),
    Page(
        "pparm",
        "P PARM",
        "P0 to P99 are variables of the card, P100 to P199 of the store. Programs read and write"
        " them while they run.",
    ),
    Page(
        "modals",
        "SET MODALS",
        "The codes that are active when a program starts, until it says others. SAVE puts them in"
        " force; without Start set chosen programs start as at power-up.",
    ),
    Page(
        "manual",
        "MANUAL",
        "MDI runs blocks that you type. JOG moves axes while a key is held, or by an increment."
        " HANDWHEEL connects the wheel with axes. GOTO ZERO moves to the floating zero, Z first"
        " where that is upward, else last.",
    ),
    Page(
        "setdiag",
        "SET/DIAG",
        "Settings and diagnostics. System parameters describe the machine: with wrong ones it does"
        " not do what is commanded. They may be guarded by a password.",
    ),
    Page(
        "offsets",
        "OFFSETS",
        "Radii (D) and lengths (H) of tools with their wear, ballscrew tables, backlash, reference"
        " points. SAVE PAGE stores the page; a value that is refused stays in its field.",
    ),
    Page(
        "work",
        "WORK COORDINATES",
        "The zeros of G54 to G59.2 in machine positions. TEACH makes the present position the zero"
        " of a system.",
    ),
    Page(
        "diagnostics",
        "DIAGNOSTICS",
        "Inputs and outputs, terminal, scope, gains, parameters of the card, servo loop, load,"
        " memory. For experienced personnel: the terminal and the gains act at once.",
    ),
    Page(
        "io",
        "I/O STATUS",
        "Every input and output of the card and of its expansion modules, live, with the names of"
        " I/O NAMES. The numbers are those of the flags of the card.",
    ),
    Page(
        "servo",
        "SERVO LOOP",
        "The whole loop of one axis, live: setpoints, gains, the terms they give, filters, output.",
    ),
    Page(
        "cpu",
        "CPU LOAD",
        "How much of its time the processor of the card is busy, in per cent.",
    ),
    Page(
        "fast",
        "FAST STATUS",
        "The copies that the card keeps for fast readers, live.",
    ),
    Page(
        "display",
        "DISPLAY",
        "BUTTON PANEL: push buttons of the screen. I/O NAMES: names of inputs and outputs. USER"
        " MESSAGES: texts shown while a bit is set. SETUP SCREEN: what VIEW 1 to 3 show. RESIZE"
        " SCREEN: this browser looks again as it did at first.",
    ),
    Page(
        "help",
        "HELP",
        "A page on every key: choose it on the left.",
    ),
)
