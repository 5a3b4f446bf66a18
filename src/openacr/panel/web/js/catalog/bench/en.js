// English texts of the engineer's workspace; what it shares with the operator's is in ../en.js.
const BENCH = {
  "bench.keys": "Keys of the workspace", "bench.panes": "PANES", "bench.layouts": "LAYOUTS", "bench.close": "CLOSE PANE", "bench.operator": "OPERATOR", "bench.empty": "No pane is open: PANES opens one.",
  "bench.save": "KEEP AS \u2026", "bench.reset": "FIRST LAYOUT", "bench.name": "Name of the layout", "bench.saved": "The layout is kept as {name}", "bench.nolayout": "No layout has been kept under a name.",
  "bench.delete": "Delete {name}", "bench.replace": "A layout {name} is there already: it is replaced.",
  "pane.tree": "Values", "pane.watch": "Watch list", "tree.search": "Words of a name, or a number", "tree.card": "Card", "tree.watch": "WATCH", "tree.change": "CHANGE", "values.fixed": "The card sets this value: it can only be read",
  "watch.name": "P12288, BIT516 or axis0.actual position", "watch.add": "ADD", "watch.remove": "Remove", "watch.change": "Change {name}", "watch.format": "Format", "watch.format.of": "Format of {name}",
  "watch.format.plain": "plain", "watch.format.fixed": "0.000", "watch.format.hex": "hexadecimal", "watch.format.binary": "binary", "pane.status": "Status", "panels.which": "What is shown", "panels.objects": "Which of them", "pane.programs": "Programs", "pane.gain": "Gains", "pane.io": "I/O", "pane.plc": "PLC", "pane.alarms": "ALARMS",
  "pane.timeline": "Timeline", "time.pause": "PAUSE", "time.run": "RUN", "time.speed": "Speed", "time.most": "as fast as it goes", "time.step": "STEP", "time.step.what": "What a step is", "time.step.number": "Number of the program or master", "time.step.tick": "a tick", "time.step.back": "a tick back", "time.step.line": "a line of program", "time.step.move": "a move of master",
  "time.branch": "NEW BRANCH HERE", "time.operate": "OPERATE FROM HERE", "time.moment": "Moment", "time.memory": "{used} MB of {most} MB of memory, nothing on disk", "time.marks": "Bookmarks", "time.mark": "MARK", "time.mark.text": "Text of a bookmark", "time.kind.error": "error", "time.kind.alarm": "alarm", "time.kind.end": "end", "time.kind.hand": "mark",
  "time.branches": "Branch", "time.from": "from s", "time.to": "to s", "time.do": "Keys", "time.name": "NAME", "time.switch": "CHANGE TO", "time.forget": "FORGET", "time.parameters": "Parameters to compare", "time.names": "P12288, BIT516, axis0.actual position", "time.at": "Time, s", "time.at.wrong": "{text} is no time: 885.8 or 14:45.8", "time.go": "GO", "time.whole": "ALL", "time.lanes.use": "A click goes to the moment, the wheel zooms, with Shift it moves along", "time.unknown": "{time} s is not known on this branch: from {first} to {last} s are", "time.other": "Branch to compare with", "time.around": "Time around the moment", "time.compare": "COMPARE", "time.comparing": "Both branches are lived through again \u2026",
  "time.noother": "there is no other branch to compare with", "time.apart": "the two branches have no time in common here", "time.differences": "{count} {count|parameter differs|parameters differ} at {seconds} s",
  "pane.wizard": "Configuration", "wizard.dialogs": "Dialogs", "wizard.card": "Card", "wizard.of.axis": "Axis {number}: {name}", "wizard.of.master": "Master {number}",
  "wizard.axis": "ADD AXIS", "wizard.master": "ADD MASTER", "wizard.remove": "REMOVE {name}", "wizard.open": "OPEN FILE \u2026", "wizard.new": "NEW", "wizard.read": "Answers were read from {name}",
  "wizard.download": "DOWNLOAD {name}", "wizard.unset": "\u2014", "wizard.on": "on", "wizard.off": "off", "wizard.wrong": "wrong",
  "scope.head.color": "colour", "scope.head.unit": "unit", "scope.head.format": "format", "scope.maths.wrong": "M: {what} is not understood", "scope.maths.end": "M: something is missing at the end",
  "scope.between": "t1 {t1} ms, t2 {t2} ms, \u0394t {dt} ms, 1/\u0394t {f} Hz", "scope.measure.min": "min", "scope.measure.max": "max", "scope.measure.mean": "mean", "scope.measure.rms": "rms", "scope.measure.span": "pk-pk", "scope.measure.deviation": "max \u0394 ref",
  "scope.view.time": "TIME", "scope.view.xy": "XY", "scope.view.spectrum": "FFT", "scope.settings": "SETTINGS", "scope.cursors": "CURSORS", "scope.reference": "REFER\u00adENCE", "scope.reference.short": "ref", "scope.branch": "BRANCH \u2026", "scope.branch.text": "What another branch of the timeline did at the same ticks is drawn dashed; REFERENCE takes it away.", "scope.export": "EXPORT \u2026", "scope.export.text": "CSV and Parquet hold the samples on the screen, PNG the picture.", "scope.export.none": "There is no record yet: START first",
  "scope.spectrum.gap": "samples are missing", "scope.amplitude": "Amplitude", "scope.amplitude.unit": "in its unit", "scope.amplitude.decibel": "dB of 1 unit", "scope.trigger": "Trigger source", "scope.trigger.none": "{channel} has no source: it cannot trigger", "scope.program": "SAMP arrays in PROG", "scope.before": "Pre-trigger, %", "scope.x": "XY: across", "scope.y": "XY: up",
  "scope.zoom": "wheel: zoom, drag: pan, double click: the sweep", "scope.zoom.label": "Screen of the scope: + and - zoom a record at rest, arrow keys pan it, 0 shows its sweep", "scope.legend": "{name}: {scale}/div, offset {offset}",
  "scope.window": "FFT window", "scope.window.rectangle": "rectangle", "scope.window.hann": "Hann", "scope.window.hamming": "Hamming", "scope.window.blackman": "Blackman", "scope.window.flattop": "flat top", "scope.roll": "roll", "scope.either": "either",
};

const WORLD = {
  "pane.world": "World", "world.label": "Machine", "world.controls": "Inputs, faults and devices", "world.inputs": "Inputs", "world.faults": "Faults", "world.devices": "Devices", "world.others": "{count} more {count|input|inputs}, switched by hand", "world.by.hand": "switched by hand",
  "world.input.on": "ON", "world.input.off": "OFF", "world.input.released": "RELEASE", "world.input.on.of": "Input {input} on", "world.input.off.of": "Input {input} off", "world.input.released.of": "Release input {input}",
  "world.forced.on": "forced on", "world.forced.off": "forced off", "world.fault.axis": "Axis of the fault", "world.fault.kind": "Kind of the fault", "world.fault.cause": "CAUSE", "world.mend.of": "Mend {name}",
  "world.fault.encoder-lost": "encoder line cut", "world.fault.encoder-noise": "encoder signals disturbed", "world.fault.drive": "drive fault", "world.fault.motor-cable": "motor cable cut", "world.fault.jam": "jammed",
  "world.fault.obstacle": "obstacle", "world.fault.friction": "more friction", "world.fault.supply": "supply too low", "world.fault.at": "place", "world.fault.torque_nm": "torque", "world.fault.volts": "voltage",
};

// Panels and their groups, by their names in openacr/client/panels.py.
const PANELS = {
  "panels.card": "Card", "panels.Motion enable": "Motion enable", "panels.axes": "Axes", "panels.masters": "Masters", "panels.programs": "Programs", "panels.plcs": "PLCs", "panels.encoders": "Encoders", "panels.streams": "Streams", "panels.drives": "Drives (Drive Talk)", "panels.network": "CANopen network",
  "panels.nodes": "CANopen nodes", "panels.Setpoint part by part": "Setpoint part by part", "panels.Loop": "Loop", "panels.State": "State", "panels.Limits": "Limits", "panels.Motion": "Motion", "panels.Overrides": "Overrides", "panels.Place": "Place",
  "panels.Scan": "Scan", "panels.Counts": "Counts", "panels.Buffers": "Buffers", "panels.Drive": "Drive", "panels.Health": "Health", "panels.Network": "Network", "panels.Node": "Node", "panels.Inputs and outputs": "Inputs and outputs",
};

// The editor of controller files.
const TEXTS = {
  "pane.variables": "Variables", "vars.program": "Program", "vars.levels": "Flow stack", "vars.nolevels": "No level is open", "vars.own": "Variables of the program", "vars.none": "None is dimensioned", "vars.used": "Parameters and flags in its text", "vars.value": "Value or expression",
  "pane.editor": "Editor", "texts.text": "Text of the controller file", "texts.which": "Program or file", "texts.file": "File", "texts.read": "READ", "texts.send": "DOWNLOAD",
  "texts.compare": "COMPARE", "texts.open": "OPEN FILE \u2026", "texts.save": "SAVE FILE", "texts.project.save": "SAVE INTO PROJECT", "texts.project.open": "PROJECT'S TEXT", "texts.project.saved": "{name} is stored in {file} of the project", "texts.project.differs": "the card differs from {file} of the project", "texts.rename": "RENAME", "texts.newname": "New name", "texts.uses": "USES", "texts.format": "FORMAT",
  "texts.outline": "OUTLINE", "texts.close": "CLOSE", "texts.beside": "Beside the text", "texts.findings": "Findings and places", "texts.changed": "changed", "texts.runs": "{name} runs: halt it first",
  "texts.more": "{count} more {count|finding|findings}", "texts.other": "This name is defined on the card, not in this text", "texts.noname": "There is no name here that this text defines",
  "texts.fold": "Fold these lines", "texts.unfold": "Show the lines again", "texts.folded": "Folded lines", "texts.unfolded": "Lines shown again", "texts.foldto": "to",
  "texts.nooutline": "No program, label or alias", "texts.download.title": "Download {name}?",
  "texts.download.text": "The card stores the programs in this file and carries out all other lines at once: they can erase programs, change settings and move axes.",
  "texts.sent": "{name}: {count} {count|line was|lines were} sent", "texts.same": "the same on the card", "texts.different": "not the same on the card", "texts.here": "Here", "texts.oncard": "On the card",
  "texts.compared": "{name} here and on the card", "texts.equal.lines": "{count} equal {count|line|lines}", "texts.noprogram": "No line of this file is stored in a program",
  "texts.notcompared": "The text could not be compared: try again",
};

// Tuning of an axis.
const TUNING = {
  "pane.tune": "Tuning", "tune.amplitude": "Amplitude, pulses", "tune.lowest": "Lowest frequency, Hz", "tune.highest": "Highest frequency, Hz",
  "tune.time": "Time, s (empty: what fits)", "tune.swept": "Measured for {time} s", "tune.worse": "Worse than with the present gains: {name} {after} instead of {before}", "tune.worse.overshoot_percent": "overshoot of a step, %", "tune.worse.rise_s": "rise of a step, ms", "tune.worse.settling_s": "settling of a step, ms", "tune.margin": "Phase margin, degrees", "tune.wanted": "Crossover, Hz (empty: the highest)", "tune.integral": "with IGAIN", "tune.measure.text": "Axis {axis} moves now: by {amplitude} pulses to both sides, for {time} s at most, quicker and quicker. Is it free to move? STOP ends it.", "tune.apply.text": "Axis {axis} gets {gains}. It then makes a step; predicted overshoot: {overshoot} %. Bad gains are taken back by the card.",
  "tune.moving": "Axis {axis} is measured. STOP ends it.", "tune.reading": "{done} of {count} {count|sample|samples}", "tune.done": "Axis {axis} is measured; nothing has been set", "tune.nothing": "Nothing is proposed: {why}", "tune.applied": "Axis {axis} has the proposed gains", "tune.facts": "Motor: {accel} pulses/s\u00b2 per V, rate {rate} /s, friction {friction} V, offset {offset} V, delay {delay} servo periods",
  "tune.sure": "{error} % of the response is unexplained, coherence {coherence}", "tune.unsure": "Not sure: {error} % of the response is unexplained, coherence {coherence}", "tune.limited": "Faster is barred: {why}", "tune.crossover": "Crossover, Hz", "tune.gain.margin": "Gain margin, dB", "tune.bandwidth": "Bandwidth, Hz",
  "tune.resonance": "Resonance: {hz} Hz \u00b1 {spread}, antiresonance {anti} Hz, damping {damping}, load {ratio} of the motor", "tune.rigid": "Resonance: {why}", "tune.notch": "NOTCH, Hz", "tune.width": "NOTCH width, Hz", "tune.lopass": "LOPASS, Hz", "tune.swing": "Load swings after a step, pulses",
  "tune.overshoot": "Overshoot of a step, %", "tune.present": "present", "tune.proposed": "proposed", "tune.setpoint": "setpoint", "tune.measured": "measured", "tune.modelled": "modelled",
  "tune.predicted": "predicted", "tune.motor": "motor, measured", "tune.model": "motor, model", "tune.record": "Record, pulses", "tune.steps": "Predicted steps, pulses", "tune.magnitude": "Magnitude, dB",
  "tune.phase": "Phase, degrees", "tune.coherence": "Coherence", "tune.step.text": "Axis {axis} moves now: by {amplitude} pulses and back, at once. Is it free to move? STOP ends it.", "tune.former": "before",
  "tune.stepped": "Axis {axis}: overshoot {overshoot} %, rise {rise} ms, settling {settling} ms", "tune.trial": "Step, pulses", "tune.changes": "Changes", "tune.undo": "UNDO", "tune.redo": "REDO",
  "tune.start": "AS AT THE START", "tune.started": "The gains are as they were at the start", "tune.slider": "{gain}, slider", "tune.zero": "0: type a value",
};

export default Object.freeze({ ...BENCH, ...WORLD, ...PANELS, ...TEXTS, ...TUNING });
