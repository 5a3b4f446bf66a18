"""Help texts of the menus, by key: title and paragraphs."""

HELPS: dict[str, tuple[str, str]] = {
    "home": (
        "HOME",
        "Choose all axes or some, then START HOME. Each axis runs fast to its switch, slowly off"
        " it, then to the marker of its encoder; there its position becomes Home Preset. Axes of"
        " priority 1 go first, those of priority 0 are never homed.\n\nSTOP ends homing with"
        " alarm 34: the axes that were under way are not homed.",
    ),
    "clrzero": (
        "CLR ZERO",
        "No axis has a floating zero any more: positions count from the zero of the work system"
        " again. Nothing moves.",
    ),
    "setzero": (
        "SET ZERO",
        "The chosen axes read 0 where they are, as by G92. The shift counts in every work system"
        " and is kept until CLR ZERO. Nothing moves.",
    ),
    "edit": (
        "EDIT",
        "Choose a file of the list, or type its name: one that does not exist begins a new part"
        " program. Errors are marked while you type. The program that is running"
        " cannot be stored; a program that is loaded has to be loaded again to take the change.",
    ),
    "setup": (
        "RUN SETUP",
        "What a program needs that does not say it itself: the radius of the cutter (CMP RAD), the"
        " feedrate, P parameters, modal codes. Then LOAD PROG. A program that sets all this itself"
        " can be loaded at once.",
    ),
    "cmprad": ("CMP RAD", "The radius of the cutter for programs that choose no D."),
    "load": (
        "LOAD PROG",
        "USER FILE: a program of the folder. LIBRARY PART: a part with sizes to choose. DXF FILE: a"
        " drawing that is converted to a program, cut at the Z that is asked for. BATCH FILE: a"
        " list of programs, run one after the other. RS232 DRIP FEED: a program that runs"
        " while it arrives over a serial line. RS-232 (LINK): a program that arrives over a serial"
        " line is kept as a file, then loaded like any other.",
    ),
    "feedrate": ("FEEDRATE", "The feed of programs before their first F; 0: Cut Speed."),
    "pparm": (
        "P PARM",
        "P0 to P99 are variables of the card, P100 to P199 of the store. Programs read and write"
        " them while they run.",
    ),
    "modals": (
        "SET MODALS",
        "The codes that are active when a program starts, until it says others. SAVE puts them in"
        " force; without Start set chosen programs start as at power-up.",
    ),
    "run": (
        "RUN PROG",
        "RUN starts the loaded program at a line. At a later line than 1 the lines before it are"
        " read without motion: what differs is shown and confirmed; then Z goes up, the axes go"
        " over the place and down at feed.\n\nSTOP holds the feed. START goes on after a stop of"
        " the program, and where a tool is asked for once it is in the spindle. DRY RUN moves"
        " at Trial Speed, M codes have no effect. BLOCK stops after"
        " every block.",
    ),
    "stop": (
        "STOP",
        "The program is held. RESUME goes on where the path was left; axes that were jogged away"
        " return first. ABORT ends the program. The path can be traced back and forward.\n\nA stop"
        " by software is no emergency stop.",
    ),
    "manual": (
        "MANUAL",
        "MDI runs blocks that you type. JOG moves axes while a key is held, or by an increment."
        " HANDWHEEL connects the wheel with axes. GOTO ZERO moves to the floating zero, Z first"
        " where that is upward, else last.",
    ),
    "jog": (
        "JOG",
        "An axis moves while its key is held and stops when it is released, when the connection"
        " falls silent for 200 ms, and at every stop, alarm or change of screen. SLOW is Jog"
        " Feedrate, FAST is Jog Rapid. An increment is made whole at one press.",
    ),
    "mdi": (
        "MDI",
        "Blocks run one by one; what they switch on stays on. While BUFFER is on, the text keeps"
        " what was executed; it can be edited and stored as a program.",
    ),
    "handwheel": ("HANDWHEEL", "The wheel of each chosen axis moves it, by its ratio per click."),
    "gotozero": ("GOTO ZERO", "Rapids to the floating zero; Z first if that is up, else last."),
    "setdiag": (
        "SET/DIAG",
        "Settings and diagnostics. System parameters describe the machine: with wrong ones it does"
        " not do what is commanded. They may be guarded by a password.",
    ),
    "offsets": (
        "OFFSETS",
        "Radii (D) and lengths (H) of tools with their wear, ballscrew tables, backlash, reference"
        " points. SAVE PAGE stores the page; a value that is refused stays in its field.",
    ),
    "work": (
        "WORK COORDINATES",
        "The zeros of G54 to G59.2 in machine positions. TEACH makes the present position the zero"
        " of a system.",
    ),
    "diagnostics": (
        "DIAGNOSTICS",
        "Inputs and outputs, terminal, scope, gains, parameters of the card, servo loop, load,"
        " memory. For experienced personnel: the terminal and the gains act at once.",
    ),
    "programs": (
        "PROGRAM/PLC",
        "The programs and PLCs of the card: what each does, and its text with the line that is"
        " executed. RUN starts one, HALT ends it and its motion, PAUSE holds it, RESUME goes on."
        " With BLOCK a program waits before every line for STEP. LISTEN shows what it prints.\n\n"
        "EDIT changes the text: numbered lines, or the text between PROGRAM and ENDP; SEND stores"
        " it on the card and compares the listing. What the card refuses leaves the former text."
        " ESAVE keeps programs without power. CLEAR erases the lines. Programs that this machine"
        " needs, one that runs, and all of them while the machine moves cannot be changed.\n\n"
        "STOP pauses programs of the card, also those that no screen has started. They know no"
        " limits and overrides of this machine: only service personnel should start one. PROG0 and"
        " its axes are taken from AcroMill where it is started or changed here: SET UP at the top"
        " gives them back.\n\nThe tab PLC draws"
        " a PLC as a ladder. Closed contacts and outputs that are set are filled; wires that carry"
        " power are thick. The flags are read ten times a second: a pulse of one scan is not seen.",
    ),
    "io": (
        "I/O STATUS",
        "Every input and output of the card and of its expansion modules, live, with the names of"
        " I/O NAMES. The numbers are those of the flags of the card.",
    ),
    "terminal": (
        "TERMINAL",
        "A direct line to the card: what is typed is sent as it is, what the card prints is shown,"
        " for example ?P3. While the machine moves only lines that begin with ? are sent.",
    ),
    "scope": (
        "SCOPE",
        "Up to four parameters of the card, sampled in its time, on ten by ten divisions. Every"
        " channel has its source, units per division and offset; the sweep is in ms per division."
        "\n\nWith INDEX the profile is run and recorded from its start: ACC, DEC, STP, JRK, F, RES"
        " and the move of one axis, for example X15. The axis really moves.",
    ),
    "gain": (
        "GAIN",
        "The gains of an axis. A value reaches the card when ENTER is pressed in its field, and"
        " acts at once; with the check set it is stored as well.",
    ),
    "board": (
        "BOARD PARAMETERS",
        "Every parameter of the card with its number, name and value, live. A touch on a value that"
        " can be written sets it.",
    ),
    "servo": (
        "SERVO LOOP",
        "The whole loop of one axis, live: setpoints, gains, the terms they give, filters, output.",
    ),
    "cpu": ("CPU LOAD", "How much of its time the processor of the card is busy, in per cent."),
    "fast": ("FAST STATUS", "The copies that the card keeps for fast readers, live."),
    "memory": (
        "MEMORY CONFIG",
        "The bytes of the card for each program and PLC program. A change loses what is stored in"
        " it, so it is refused while anything runs, and asks first.",
    ),
    "teach": (
        "TEACH",
        "The present machine position becomes the zero of a work system, on the chosen axes; or"
        " that of Z the length of a tool. Nothing moves.",
    ),
    "overrides": (
        "OVERRIDES",
        "Feed, rapid and spindle speed in 16 clicks of their table (SYS PARAM). Where a switch of"
        " the panel is wired, the switch counts and the screen only shows it.",
    ),
    "display": (
        "DISPLAY",
        "BUTTON PANEL: push buttons of the screen. I/O NAMES: names of inputs and outputs. USER"
        " MESSAGES: texts shown while a bit is set. SETUP SCREEN: what VIEW 1 to 3 show. RESIZE"
        " SCREEN: this browser looks again as it did at first.",
    ),
    "help": ("HELP", "A page on every key: choose it on the left."),
    "exit": (
        "EXIT",
        "LEAVE leaves the screens and gives up control; END, at the computer of the controller,"
        " ends the controller program. What moves is brought to rest first, unless another operator"
        " has control.",
    ),
    "alarms": (
        "ALARMS",
        "An alarm stays until its cause is gone and it was acknowledged; nothing starts before.",
    ),
    "control": (
        "Control",
        "One operator at a time has control of the machine. Others see everything and may stop it."
        " Control can be handed over or taken.",
    ),
}
