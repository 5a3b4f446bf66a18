// English texts of the screens. Names of keys are those of the AcroMill guide.
const MENU = {
  "menu.label": "Function keys", "menu.home": "HOME", "menu.clrzero": "CLR ZERO", "menu.setzero": "SET ZERO", "menu.edit": "EDIT", "menu.setup": "RUN SETUP", "menu.run": "RUN PROG",
  "menu.manual": "MANUAL", "menu.diag": "SET/\u200bDIAG", "menu.help": "HELP", "menu.exit": "EXIT", "menu.main": "MAIN MENU", "menu.cmprad": "CMP RAD", "menu.load": "LOAD PROG", "menu.feedrate": "FEED RATE",
  "menu.pparm": "P PARM", "menu.modals": "SET MODALS", "menu.stop": "STOP", "menu.start": "START", "menu.runline": "RUN", "menu.dryrun": "DRY RUN", "menu.fov": "OVER\u00adRIDES", "menu.block": "BLOCK",
  "menu.abort": "ABORT", "menu.back": "BACK", "menu.halt": "HALT", "menu.forward": "FOR\u00adWARD", "menu.resume": "RESUME", "menu.jog": "JOG", "menu.mdi": "MDI", "menu.handwheel": "HAND WHEEL",
  "menu.teach": "TEACH", "menu.gotozero": "GOTO ZERO", "menu.sysparam": "SYS PARAM", "menu.offsets": "OFFSETS", "menu.work": "WORK COORD", "menu.diagnostics": "DIAG\u00adNOSTICS",
  "menu.display": "DIS\u00adPLAY", "menu.iostatus": "I/O STATUS", "menu.terminal": "TERMI\u00adNAL", "menu.scope": "SCOPE", "menu.gain": "GAIN", "menu.board": "BOARD PARAM", "menu.servo": "SERVO LOOP", "menu.cpu": "CPU LOAD",
  "menu.fast": "FAST STATUS", "menu.memory": "MEMORY CONFIG", "menu.ionames": "I/O NAMES", "menu.buttons": "BUTTON PANEL", "menu.resize": "RESIZE SCREEN", "menu.messages": "USER MES\u00adSAGES", "menu.views": "SETUP SCREEN",
};

const FRAME = {
  "key.ok": "OK", "key.cancel": "CANCEL", "key.close": "CLOSE",
  "stale.old": "No new values: the positions shown are old. Nothing can be moved from here.",
  "stale.lost": "No connection to the controller program. The machine may still be moving. Connecting again \u2026",
  "stale.card": "The card does not answer. The machine may still be moving, the state of the spindle is unknown.",
  "api.lost": "The controller program does not answer: nothing was read or stored", "api.unknown": "The controller program has nothing by this name", "api.failed": "The controller program could not do this: nothing was stored",
  "stale.refused": "Nothing is moved: the positions shown are old",
  "state.IDLE": "IDLE", "state.RUN": "RUN", "state.WAIT": "WAIT", "state.HOMING": "HOMING", "state.HOLD": "HOLD", "state.ALARM": "ALARM", "state.JOG": "JOG",
  "stop.title": "Stops all that moves on the card, on its path and by its ramps. This is not an emergency stop.",
  "stopped.held": "STOP holds {what}", "stopped.moving": "In spite of STOP moves: {axes}",
  "stopped.all": "END EVERYTHING", "stopped.estop": "KILL, DRIVES OFF",
  "mode.past": "AT {at} s, {before} s BEFORE THE END", "mode.past.title": "The card is shown at a moment of its history: OPERATE of the timeline goes on from here", "mode.still": "THE TIME OF THE CARD IS STILL",
  "mode.setup": "SET UP", "mode.setup.done": "AcroMill has set the card up.",
  "mode.setup.text": "SET UP detaches the axes of its program, attaches those of AcroMill, and sends their settings: what was attached and set there is lost. Stored programs stay.",
  "lamp.moves": "CARD MOVES", "lamp.runs": "CARD RUNS", "lamp.drives": "Drives on: {axes}",
  "prompt.label": "Messages of the control and of programs", "ask.value": "A value is asked for", "ask.answer": "ANSWER", "tool.wanted": "Change the tool", "tool.changed": "TOOL CHANGED",
  "alarm.left": "Its cause is still there: {what}", "alarm.show": "ALARMS", "alarm.more": "+{count}", "alarm.count": "Active alarms: {count}", "alarm.none": "No alarm is active", "alarm.noprogram": "No program is loaded",
  "alarm.time": "Time", "alarm.code": "Alarm", "alarm.text": "Text",
  "control.title": "Who operates the machine", "control.you": "You operate", "control.other": "{name} operates", "control.free": "View only", "control.first": "Free", "control.has": "operates",
  "control.text": "The first key takes control of a free machine. One screen at a time moves the machine. STOP works on every screen at any time.", "control.ask": "ASK FOR CONTROL", "control.force": "TAKE IT NOW", "control.give": "GIVE TO {name}",
  "settings.title": "Appearance", "settings.bench": "Workspace of the engineer", "settings.operator": "Workspace of the operator", "settings.theme": "Colours", "settings.language": "Language", "theme.auto": "as the system", "theme.light": "light", "theme.dark": "dark",
  "role.view": "viewer", "role.operate": "operator", "role.setup": "set-up", "role.service": "service", "role.needed": "This needs the role {role}: log in",
  "display.label": "Display window", "tab.graphics": "GRAPHICS", "tab.program": "PROGRAM", "tab.io": "I/O STATUS", "tab.plc": "PLC", "tab.alarms": "ALARMS", "status.label": "Status window", "status.view": "VIEW {n}",
};

const BLOCKS = {
  "block.position": "Current position", "block.distance": "Distance to go", "block.next": "Next position", "block.modal": "Modal status", "block.estop": "Emergency stop", "block.feeds": "Feed and spindle", "block.buttons": "Push buttons",
  "position.machine": "Machine position", "position.togo": "Distance to go", "position.set": "Set the work position of {axis}", "position.hint": "The axis shall read this here and now", "position.done": "{axis} is set",
  "position.busy": "A position can be set while nothing runs", "position.homed": "homed", "position.nothomed": "not homed",
  "feeds.actual": "Feed", "feeds.set": "F set", "feeds.spindle": "Spindle", "feeds.rpm": "rpm", "feeds.off": "off", "feeds.tool": "Tool", "feeds.coolant": "Coolant", "feeds.flood": "flood", "feeds.mist": "mist",
  "feeds.line": "Line", "feeds.time": "Run time", "feeds.left": "Time left", "feeds.parts": "Parts",
  "estop.on": "Emergency stop is on", "estop.off": "Emergency stop is off", "estop.left": "Emergency stop is off again: its alarm is to be acknowledged", "estop.none": "Emergency stop: not wired", "estop.software": "STOP on this screen is not an emergency stop.",
  "buttons.none": "No push buttons are defined: SET/DIAG, DISPLAY, BUTTON PANEL", "override.label": "Overrides", "override.feed": "Feed", "override.rapid": "Rapid", "override.spindle": "Spindle", "override.open": "All overrides",
  "override.more": "Feed override up", "override.less": "Feed override down", "override.wired": "set by its switch on the panel",
  "pad.back": "delete", "pad.clear": "clear", "pad.sign": "change sign", "pad.none": "Not a number: digits, . + - * / and parentheses", "pad.open": "Number pad",
  "graphics.views": "Views", "graphics.label": "Tool path of the program", "graphics.top": "TOP", "graphics.front": "FRONT", "graphics.side": "SIDE", "graphics.iso": "3D", "graphics.fit": "FIT", "graphics.in": "Zoom in", "graphics.out": "Zoom out",
  "graphics.stock": "STOCK", "graphics.computing": "Stock: {percent} %", "graphics.dip": "Rapid in material: line {lines}", "graphics.below": "Below the blank: line {lines}", "graphics.sound": "No rapid in material, no cut below the blank",
  "graphics.loading": "Loading {name} \u2026", "graphics.draw": "DRAW", "graphics.notdrawn": "not drawn: Default Graphics (P250002) is false", "program.runs": "runs", "program.rests": "loaded, not running", "program.follow": "FOLLOW", "program.from": "RUN FROM {line}", "io.title": "I/O status", "io.inputs": "Inputs", "io.outputs": "Outputs", "io.on": "on", "io.off": "off",
};

const RUN = {
  "run.none": "No program is loaded: RUN SETUP, LOAD PROG", "run.wrong": "These errors were found when the program was loaded, with the machine as it was set then. The run ends at the first of them.", "run.anyway": "START ANYWAY", "findings.errors": "{count} {count|error|errors}", "findings.warnings": "{count} {count|warning|warnings}", "findings.title": "What is wrong with the program",
  "run.line": "Start line", "run.lines": "{count} {count|line|lines}", "run.seconds": "about {time}", "run.dry": "Dry run: Trial Speed, M codes off.", 
  "run.safez": "Safe Z (machine)", "run.safez.hint": "Where the tool is free, if no line before brings it there at rapid", "run.range": "The program has the lines 1 to {last}", "begin.title": "Start at line {line}", "begin.text": "The lines before it were run through without motion. This differs from what the machine has now:",
  "begin.tool": "Another tool is in the spindle", "begin.present": "Present", "begin.wanted": "Wanted", "begin.go": "MOVE AND START", "start.title": "Go on", "start.covered": "The machine goes on moving ({state} {reason}). The positions are covered by this screen.",
  "clrzero.title": "Clear zero", "clrzero.text": "The floating zero (G92) of all axes is cleared: positions read as in the work coordinate system.", "clrzero.done": "The floating zero is cleared",
  "gotozero.title": "Go to zero", "gotozero.text": "Rapids to program zero ({work} with the floating zero): {steps}. From: {places}", "gotozero.then": ", then ",
  "home.title": "Home", "home.text": "The axes move to their switches: clear the table. Order by priority.", "home.axes": "Axes to be homed", "home.progress": "Homing is in progress: {reason}", "home.homed": "homed", "home.nothomed": "not homed",
  "home.state.waiting": "waiting", "home.state.switch": "moves to its switch", "home.state.release of the switch": "leaves its switch", "home.state.marker": "looks for the marker", "home.state.rest": "comes to rest", "home.state.done": "homed", "home.state.failed": "failed",
  "axes.all": "All axes", "axes.none": "Choose an axis first", "zero.title": "Set zero", "zero.text": "The chosen axes read 0 where they are (G92).", "zero.axes": "Axes", "zero.done": "{axes} read 0 now",
  "jog.title": "Jog", "jog.speed": "Speed", "jog.slow": "SLOW", "jog.fast": "FAST", "jog.how": "Continuous or increment", "jog.continuous": "CONTINUOUS", "jog.text": "Hold a key to move. Arrow keys move X and Y, Page Up and Page Down move Z. STOP is not an emergency stop.", "jog.ended": "The jog has ended: {reason}",
  "handwheel.title": "Handwheel", "handwheel.text": "The wheel moves the chosen axes until this screen is left.", "handwheel.axes": "Axes on the wheel", "handwheel.start": "CONNECT", "handwheel.end": "DISCONNECT", "handwheel.on": "The wheel moves {axes}",
  "teach.title": "Teach", "teach.text": "Where the machine is becomes the origin of the system.", "teach.system": "Work coordinate system", "teach.axes": "Axes, machine position", "teach.done": "{system}: {axes} taught", "teach.length.done": "H{h} taught",
  "mdi.title": "MDI", "mdi.buffer": "Executed blocks", "mdi.line": "Block", "mdi.on": "BUFFER", "mdi.keep": "KEEP EDIT", "mdi.runall": "RUN ALL", "mdi.save": "SAVE AS", "mdi.clear": "CLEAR", "mdi.running": "A block is being executed", "mdi.count": "{count} {count|block|blocks}",
};

const FORMS = {
  "form.title": "Parameters", "form.savepage": "SAVE PAGE", "form.save": "SAVE", "form.undo": "UNDO", "form.changed": "Not saved: {count}", "form.locked": "Locked: {reason}", "form.axis": "Axis", "form.previous": "PREVIOUS", "form.next": "NEXT", "form.page": "{first}\u2013{last} of {total}",
  "form.goto": "Go to row", "form.goto.hint": "1 to {last}", "form.saved": "Saved: {count}", "form.refused": "Not saved; refused: {count}", "form.leave": "Not saved", "form.leave.text": "Changes that are lost without SAVE: {count}", "form.drop": "DROP", "form.elsewhere": "Changed elsewhere meanwhile",
  "field.least": "at least {low}", "field.most": "at most {high}", "field.range": "{low} to {high}", "field.typical": "typical {value}", "field.default": "default {value}", "field.motion": "not while a program runs",
  "ballscrew.title": "Ballscrew", "ballscrew.on": "Table on", "ballscrew.import": "IMPORT", "ballscrew.export": "EXPORT", "ballscrew.add": "ADD ROW", "ballscrew.remove": "Remove the row", "ballscrew.position": "Position", "ballscrew.error": "Error",
  "ballscrew.text": "An error is the commanded position minus the mean of what was measured there. Positions count from the reference point; those below it follow at the end. A table acts once its axis is homed.",
  "ballscrew.count": "Rows: {count}", "ballscrew.imported": "{name} is read; SAVE stores it", "ballscrew.saved": "The ballscrew table of {axis} is stored",
  "parameters.title": "System parameters", "parameters.search": "Find a parameter", "parameters.nothing": "Nothing found", "offsets.title": "Offsets",
  "load.title": "Load program", "load.source": "Source", "load.file": "USER FILE", "load.part": "LIBRARY PART", "load.dxf": "DXF FILE", "load.batch": "BATCH FILE", "load.drip": "DRIP FEED", "load.files": "Part programs", "load.text": "Text of the file", "load.choose": "Choose a file",
  "load.go": "LOAD FILE", "load.radians": "in radians", "load.radius": "the tool radius", "load.or": "or", "load.and": "and", "load.upload": "UPLOAD", "load.drop": "Files can be dropped here.", "load.toobig": "{name} is larger than {most}", "load.uploaded": "{name} is uploaded", "load.locked": "loaded", "load.more": "{count} more {count|line|lines}", "load.port": "Port",
  "load.drip.text": "The program is read from a serial port while it runs. An empty port is that of the COMMUNICATIONS tab.", "load.drip.start": "START READING",
  "load.link": "RS-232 (LINK)", "load.link.text": "A program is received over a serial port and kept as a file. It ends with %, Ctrl-Z, or silence after M2, M30 or M99. An empty port is that of the COMMUNICATIONS tab.",
  "load.link.file": "Keep as", "load.link.start": "RECEIVE", "load.link.receiving": "{name} from {port}: {lines} {lines|line|lines}, {bytes}", "load.link.kept": "{name} is kept: {lines} {lines|line|lines}, {bytes}", "load.link.cancelled": "{name} was cancelled: nothing was kept",
  "dxf.kind": "Kind", "dxf.path": "Continuous path", "dxf.drill": "Drill pattern", "dxf.direction": "Trace direction", "dxf.cw": "0 clockwise", "dxf.ccw": "1 counter-clockwise", "dxf.depth": "Z of the cut", "dxf.tool": "Cutter, D number", "dxf.layer": "Layer", "dxf.all": "all layers", "dxf.output": "Output file", "dxf.convert": "CONVERT", "dxf.done": "Conversion was successful: {name}",
  "edit.title": "Edit", "edit.text": "Text of the program", "edit.dxf": "DXF", "edit.open": "OPEN", "edit.new": "NEW", "edit.save": "SAVE", "edit.saveas": "SAVE AS", "edit.name": "File name (.TXT)", "edit.saved": "{name} is saved", "edit.unnamed": "new file", "edit.lines": "{count} {count|line|lines}", "edit.locked": "This program runs: it cannot be changed now",
  "edit.leave": "Not saved", "edit.leave.text": "{name} has changes that are not saved.", "edit.conflict": "Changed meanwhile", "edit.overwrite": "OVERWRITE",
};

const SERVICE = {
  "diag.warning": "Only experienced personnel: what is changed here acts on the card at once.", "terminal.title": "Terminal", "terminal.line": "Line for the card", "terminal.send": "SEND",
  "scope.title": "Scope", "scope.channel": "Source of channel {n}", "scope.scale": "Scale of channel {n}, units/div", "scope.offset": "Offset of channel {n}", "scope.source": "P12290", "scope.sweep": "Sweep, ms/div", "scope.period": "Sampling, ms",
  "scope.index.text": "The axis moves now: {move}. Is its path free?", "scope.profile": "Index profile", "scope.autoscale": "AUTOSCALE", "scope.range": "Sweep and sampling are times above 0 ms", "scope.divisions": "divisions", "scope.level": "Trigger level", "scope.mode": "Trigger", "scope.free": "free run", "scope.auto": "auto", "scope.normal": "normal", "scope.single": "single",
  "scope.state.waiting": "WAITING for a trigger, {count} {count|sample|samples}", "scope.state.triggered": "TRIGGERED, {count} {count|sample|samples}", "scope.state.taken": "TAKEN: the scope samples for {owner} now. START takes it back", "scope.take": "TAKE THE SCOPE", "scope.head.source": "source", "scope.head.scale": "units/div", "scope.head.offset": "offset",
  "scope.slope": "Edge", "scope.rising": "rising", "scope.falling": "falling", "scope.start": "START", "scope.armed": "Armed", "scope.read": "{count} {count|sample|samples}", "scope.stopped": "Stopped at {count} {count|sample|samples}",
  "gain.title": "Gain", "gain.warning": "A gain acts on the servo loop the moment it is entered.", "gain.store": "keep it in the parameters of the machine", "gain.enter": "ENTER", "gain.done": "{gain} is {value}", "gain.later": "{gain} is {value}; it is stored once the machine rests",
  "board.title": "Board parameters", "board.search": "Name or number", "board.number": "Number", "board.name": "Name", "board.value": "Value", "board.doc": "Meaning", "values.set": "SET", "values.clear": "CLEAR", "values.now": "Now: {value}", "values.is": "{name} is {value}", "board.written": "P{number} is {value}",
  "pparm.title": "P parameters", "pparm.done": "P{n} is {value}", "servo.title": "Servo loop", "cpu.title": "CPU load", "fast.title": "Fast status", "memory.title": "Memory configuration",
  "views.title": "Setup screen", "views.block": "Block", "views.save": "SAVE VIEW", "views.saved": "The views are saved", "tour.title": "TOUR", "tour.back": "BACK", "tour.next": "NEXT", "tour.end": "END",
  "tour.state": "What the machine does now. Beside it: who commands, and the settings of this browser; below, the loaded program and its alarms.",
  "tour.status": "The read-out: the place of each axis. A key on an axis sets its zero; VIEW 1 to 3 show other values.",
  "tour.display": "The display window: the picture of the path, the program, inputs and outputs, alarms. The keys F1 to F10 open their screens here.",
  "tour.prompt": "What the program and the machine print, why a key is refused, and questions to you.",
  "tour.menu": "The function keys, F1 to F10. A key opens a screen or another menu; F10 goes back. RUN SETUP loads a program, RUN PROG starts it.",
  "tour.stop": "STOP holds the feed, at any time. It is not the emergency stop of the machine.",
  "help.title": "Help", "help.none": "There is no page on this key.",
};

const ON_CARD = {
  "splitter.label": "Edge between status and display window", "message.all": "All messages", "message.more": "+{count}",
  "find.find": "Find", "find.by": "Replace by", "find.next": "NEXT", "find.previous": "PREVIOUS", "find.all": "ALL", "find.case": "match case", "find.regexp": "regular expression", "find.word": "whole words", "find.replace": "REPLACE", "find.replaceall": "REPLACE ALL", "find.current": "present match", "find.online": "on line", "find.replaced": "replaced on line $", "find.replacedall": "$ replaced", "find.goto": "Go to line", "find.go": "GO",
  "menu.programs": "PROG/\u200bPLC", "programs.title": "Programs and PLCs of the card", "programs.list": "Programs and PLCs", "programs.text": "Text as the card lists it", "programs.printed": "What the program prints", "programs.read": "READ",
  "programs.choose": "Choose a program", "programs.line": "line {line}", "programs.bytes": "{used} bytes", "programs.differs": "≠ project", "programs.differs.text": "Its text on the card is another one than in the project: it is lost with the process of the panel unless it is saved into the project (Editor)", "programs.nomemory": "no memory", "programs.run": "RUN", "programs.halt": "HALT", "programs.pause": "PAUSE", "programs.resume": "RESUME",
  "programs.block": "BLOCK", "programs.step": "STEP", "programs.listen": "LISTEN", "programs.edit": "EDIT", "programs.clear": "CLEAR", "programs.send": "SEND", "programs.sent": "{name}: {count} {count|line is|lines are} stored on the card",
  "programs.run.title": "Start {name}?", "programs.run.text": "A program of the card can move axes at once. STOP pauses it; it is not held by the overrides of this machine.",
  "programs.clear.title": "Erase {name}?", "programs.clear.text": "Its lines are erased from the memory of the card.", "programs.cleared": "{name} is empty",
  "programs.state.running": "running", "programs.state.halted": "halted", "programs.state.paused": "paused", "programs.state.waits for STEP": "waits for STEP", "programs.state.waits for room": "waits for room", "programs.state.dwells": "dwells", "programs.state.inhibited": "inhibited",
  "plc.choose": "PLC", "plc.ladder": "Ladder", "plc.listing": "LIST", "plc.read": "READ", "plc.running": "running", "plc.halted": "halted", "plc.empty": "This PLC has no text.", "plc.notdrawn": "Not drawn as a ladder: {why}", "plc.norung": "there is no rung in it", "plc.rung": "Rung {line}",
  "loop.label": "Servo loop of axis {axis}", "loop.open": "Loop open", "loop.closed": "Loop closed", "loop.filtering": "filters on", "loop.bypassed": "filters off",
  "loop.current": "Position", "loop.gear": "Gear offset", "loop.jog": "Jog offset", "loop.cam": "Cam offset", "loop.backlash": "Backlash", "loop.ballscrew": "Ballscrew", "loop.primary": "Primary setp.", "loop.secondary": "Second. setp.", "loop.actual": "Actual pos.",
  "loop.error": "Follow. error", "loop.p": "Proportional, V", "loop.i": "Integral, V", "loop.d": "Derivative, V", "loop.ffvel": "Feedforward v, V", "loop.ffacc": "Feedforward a, V", "loop.fbvel": "Feedback v, V",
  "loop.sum": "Sum, V", "loop.filter0": "Filter 0", "loop.filter1": "Filter 1", "loop.filtered": "Filtered, V", "loop.limits": "Torque limits, V", "loop.output": "Output, V",
};

const CARD = {
  "units.switch": "Switch the read-out between mm and inch", "cpu.foreground": "Servo interrupt", "cpu.background": "Left for programs", "memory.warning": "Only experienced personnel. A change loses all programs, PLC programs and variables on the card.", "memory.save": "SAVE AND CLEAR THE CARD",
  "memory.lost": "All programs, PLC programs and variables that are stored on the card are lost. The machine is set up again.", "memory.bytes": "bytes", "memory.free": "Free: {free} bytes", "memory.number": "{name}: a whole number of bytes", "memory.done": "The memory of the card is divided anew",
};

const ACCESS = {
  "exit.text": "LEAVE leaves the screens; the controller program keeps running. END ends the controller program.", "exit.remote": "Leave the screens? The controller program keeps running.",
  "exit.busy": "The machine is working. It is stopped first: the program ends, the axes come to rest.", "exit.leave": "LEAVE", "exit.end": "END",
  "exit.done": "You have left the screens. The controller program is still running.", "exit.ended": "AcroMill has ended.", "exit.again": "COME BACK",
  "login.title": "Log in", "login.role": "Role", "login.password": "Password", "login.go": "LOG IN",
};

export default { ...MENU, ...FRAME, ...BLOCKS, ...RUN, ...FORMS, ...SERVICE, ...ON_CARD, ...ACCESS, ...CARD };
