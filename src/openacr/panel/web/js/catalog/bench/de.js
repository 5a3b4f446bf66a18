// Deutsche Texte des Arbeitsplatzes; was er mit dem des Bedieners teilt, steht in ../de.js.
const BENCH = {
  "bench.keys": "Tasten des Arbeitsplatzes", "bench.panes": "FENSTER", "bench.layouts": "ANORDNUNG", "bench.close": "FENSTER SCHLIESSEN", "bench.operator": "BEDIENER", "bench.empty": "Kein Fenster ist offen: FENSTER \u00f6ffnet eines.",
  "bench.save": "BEHALTEN ALS \u2026", "bench.reset": "ERSTE ANORDNUNG", "bench.name": "Name der Anordnung", "bench.saved": "Die Anordnung ist als {name} behalten", "bench.nolayout": "Noch keine Anordnung hat einen Namen.",
  "bench.delete": "{name} l\u00f6schen", "bench.replace": "Eine Anordnung {name} gibt es schon: Sie wird ersetzt.",
  "pane.tree": "Werte", "pane.watch": "Beobachten", "tree.search": "W\u00f6rter eines Namens, oder eine Nummer", "tree.card": "Karte", "tree.watch": "BEOBACHTEN", "tree.change": "\u00c4NDERN", "values.fixed": "Die Karte setzt diesen Wert: Er ist nur lesbar",
  "watch.name": "P12288, BIT516 oder axis0.actual position", "watch.add": "DAZU", "watch.remove": "Entfernen", "watch.change": "{name} \u00e4ndern", "watch.format": "Format", "watch.format.of": "Format von {name}",
  "watch.format.plain": "einfach", "watch.format.fixed": "0,000", "watch.format.hex": "hexadezimal", "watch.format.binary": "bin\u00e4r", "pane.status": "Zustand", "panels.which": "Was gezeigt wird", "panels.objects": "Welche davon", "pane.programs": "Programme", "pane.gain": "Verst\u00e4rkungen", "pane.io": "E/A", "pane.plc": "PLC", "pane.alarms": "ALARME",
  "pane.timeline": "Zeitachse", "time.pause": "PAUSE", "time.run": "WEITER", "time.speed": "Geschwindigkeit", "time.most": "so schnell es geht", "time.step": "SCHRITT", "time.step.what": "Was ein Schritt ist", "time.step.number": "Nummer des Programms oder Masters", "time.step.tick": "ein Takt", "time.step.back": "ein Takt zur\u00fcck", "time.step.line": "eine Zeile von Programm", "time.step.move": "eine Bewegung von Master",
  "time.branch": "NEUER ZWEIG HIER", "time.operate": "VON HIER BEDIENEN", "time.moment": "Zeitpunkt", "time.memory": "{used} MB von {most} MB Speicher, nichts auf der Platte", "time.marks": "Lesezeichen", "time.mark": "MERKEN", "time.mark.text": "Text eines Lesezeichens", "time.kind.error": "Fehler", "time.kind.alarm": "Alarm", "time.kind.end": "Ende", "time.kind.hand": "Lesezeichen",
  "time.branches": "Zweig", "time.from": "von s", "time.to": "bis s", "time.do": "Tasten", "time.name": "NAME", "time.switch": "WECHSELN", "time.forget": "VERGESSEN", "time.parameters": "Parameter zum Vergleichen", "time.names": "P12288, BIT516, axis0.actual position", "time.other": "Zweig zum Vergleichen", "time.around": "Zeit um den Zeitpunkt", "time.compare": "VERGLEICHEN", "time.comparing": "Beide Zweige werden noch einmal durchlebt \u2026",
  "time.noother": "es gibt keinen anderen Zweig zum Vergleichen", "time.apart": "die beiden Zweige haben hier keine gemeinsame Zeit", "time.differences": "{count} Parameter {count|unterscheidet|unterscheiden} sich bei {seconds} s",
  "pane.wizard": "Konfiguration", "wizard.dialogs": "Dialoge", "wizard.card": "Karte", "wizard.of.axis": "Achse {number}: {name}", "wizard.of.master": "Master {number}",
  "wizard.axis": "ACHSE DAZU", "wizard.master": "MASTER DAZU", "wizard.remove": "{name} ENTFERNEN", "wizard.open": "DATEI \u00d6FFNEN \u2026", "wizard.new": "NEU", "wizard.read": "Antworten aus {name} gelesen",
  "wizard.download": "{name} LADEN", "wizard.unset": "\u2014", "wizard.on": "ein", "wizard.off": "aus", "wizard.wrong": "falsch",
  "scope.head.color": "Farbe", "scope.head.unit": "Einheit", "scope.head.format": "Format", "scope.maths.wrong": "M: {what} ist nicht verständlich", "scope.maths.end": "M: am Ende fehlt etwas",
  "scope.between": "t1 {t1} ms, t2 {t2} ms, \u0394t {dt} ms, 1/\u0394t {f} Hz", "scope.measure.min": "min", "scope.measure.max": "max", "scope.measure.mean": "Mittel", "scope.measure.rms": "eff.", "scope.measure.span": "Sp.-Sp.", "scope.measure.deviation": "max \u0394 Ref",
  "scope.view.time": "ZEIT", "scope.view.xy": "XY", "scope.view.spectrum": "FFT", "scope.settings": "EINSTEL\u00adLUNGEN", "scope.cursors": "CURSOR", "scope.reference": "REFE\u00adRENZ", "scope.reference.short": "Ref", "scope.branch": "ZWEIG \u2026", "scope.branch.text": "Was ein anderer Zweig der Zeitleiste in denselben Takten tat, wird gestrichelt gezeichnet; REFERENZ nimmt es weg.", "scope.export": "EXPORT \u2026", "scope.export.text": "CSV und Parquet enthalten die Messwerte auf dem Schirm, PNG das Bild.", "scope.export.none": "Es gibt noch keine Aufzeichnung: erst START",
  "scope.spectrum.gap": "Messwerte fehlen", "scope.amplitude": "Amplitude", "scope.amplitude.unit": "in der Einheit", "scope.amplitude.decibel": "dB zu 1 Einheit", "scope.trigger": "Triggerquelle", "scope.trigger.none": "{channel} hat keine Quelle: er kann nicht triggern", "scope.program": "SAMP-Felder in PROG", "scope.before": "Vorlauf, %", "scope.x": "XY: quer", "scope.y": "XY: hoch",
  "scope.zoom": "Rad: Zoom, ziehen: verschieben, Doppelklick: die Ablenkung", "scope.zoom.label": "Schirm des Scope: + und - vergrößern oder verkleinern eine ruhende Aufzeichnung, Pfeiltasten verschieben sie, 0 zeigt ihre Ablenkung", "scope.legend": "{name}: {scale}/Teil, Versatz {offset}",
  "scope.window": "FFT-Fenster", "scope.window.rectangle": "Rechteck", "scope.window.hann": "Hann", "scope.window.hamming": "Hamming", "scope.window.blackman": "Blackman", "scope.window.flattop": "Flat Top", "scope.roll": "rollend", "scope.either": "beide",
};

const WORLD = {
  "pane.world": "Welt", "world.label": "Maschine", "world.controls": "Eing\u00e4nge, Fehler und Ger\u00e4te", "world.inputs": "Eing\u00e4nge", "world.faults": "Fehler", "world.devices": "Ger\u00e4te", "world.by.hand": "von Hand geschaltet",
  "world.input.on": "EIN", "world.input.off": "AUS", "world.input.released": "FREIGEBEN", "world.input.on.of": "Eingang {input} ein", "world.input.off.of": "Eingang {input} aus", "world.input.released.of": "Eingang {input} freigeben",
  "world.forced.on": "ein, erzwungen", "world.forced.off": "aus, erzwungen", "world.fault.axis": "Achse des Fehlers", "world.fault.kind": "Art des Fehlers", "world.fault.cause": "AUSL\u00d6SEN", "world.mend": "BEHEBEN", "world.mend.of": "{name} beheben",
  "world.fault.encoder-lost": "Geberleitung unterbrochen", "world.fault.encoder-noise": "Gebersignale gest\u00f6rt", "world.fault.drive": "Antriebsfehler", "world.fault.motor-cable": "Motorkabel unterbrochen", "world.fault.jam": "blockiert",
  "world.fault.obstacle": "Hindernis", "world.fault.friction": "mehr Reibung", "world.fault.supply": "Versorgung zu niedrig", "world.fault.at": "Stelle", "world.fault.torque_nm": "Drehmoment", "world.fault.volts": "Spannung",
};

// Tafeln und ihre Gruppen, nach den Namen in openacr/client/panels.py.
const PANELS = {
  "panels.card": "Karte", "panels.Motion enable": "Bewegungsfreigabe", "panels.axes": "Achsen", "panels.masters": "Master", "panels.programs": "Programme", "panels.plcs": "PLCs", "panels.encoders": "Geber", "panels.streams": "Str\u00f6me", "panels.drives": "Antriebe (Drive Talk)", "panels.network": "CANopen-Netz",
  "panels.nodes": "CANopen-Knoten", "panels.Setpoint part by part": "Sollwert, Teil f\u00fcr Teil", "panels.Loop": "Regelkreis", "panels.State": "Zustand", "panels.Limits": "Grenzen", "panels.Motion": "Bewegung", "panels.Overrides": "Overrides", "panels.Place": "Stelle",
  "panels.Scan": "Zyklus", "panels.Counts": "Z\u00e4hler", "panels.Buffers": "Puffer", "panels.Drive": "Antrieb", "panels.Health": "Befinden", "panels.Network": "Netz", "panels.Node": "Knoten", "panels.Inputs and outputs": "Ein- und Ausg\u00e4nge",
};

const TEXTS = {
  "pane.variables": "Variablen", "vars.program": "Programm", "vars.levels": "Ablaufstapel", "vars.nolevels": "Keine Ebene ist offen", "vars.own": "Variablen des Programms", "vars.none": "Keine ist dimensioniert", "vars.used": "Parameter und Merker in seinem Text", "vars.value": "Wert oder Ausdruck",
  "pane.editor": "Editor", "texts.text": "Text der Steuerungsdatei", "texts.which": "Programm oder Datei", "texts.file": "Datei", "texts.read": "LESEN", "texts.send": "SENDEN",
  "texts.compare": "VERGLEICHEN", "texts.open": "DATEI \u00d6FFNEN \u2026", "texts.save": "DATEI SPEICHERN", "texts.project.save": "INS PROJEKT SPEICHERN", "texts.project.open": "TEXT DES PROJEKTS", "texts.project.saved": "{name} steht jetzt in {file} des Projekts", "texts.project.differs": "die Karte weicht von {file} des Projekts ab", "texts.rename": "UMBENENNEN", "texts.newname": "Neuer Name", "texts.uses": "VERWENDUNG",
  "texts.format": "FORMATIEREN", "texts.outline": "GLIEDERUNG", "texts.close": "SCHLIESSEN", "texts.beside": "Neben dem Text", "texts.findings": "Befunde und Stellen", "texts.changed": "ge\u00e4ndert",
  "texts.runs": "{name} l\u00e4uft: erst anhalten", "texts.more": "{count} {count|weiterer Befund|weitere Befunde}", "texts.other": "Dieser Name ist auf der Karte definiert, nicht in diesem Text",
  "texts.fold": "Zeilen einklappen", "texts.unfold": "Zeilen ausklappen", "texts.folded": "Eingeklappte Zeilen", "texts.unfolded": "Ausgeklappte Zeilen", "texts.foldto": "bis",
  "texts.noname": "Hier steht kein Name, den dieser Text definiert", "texts.nooutline": "Kein Programm, keine Marke, kein Alias", "texts.download.title": "{name} senden?",
  "texts.download.text": "Die Karte speichert die Programme dieser Datei und f\u00fchrt alle anderen Zeilen sofort aus: Sie k\u00f6nnen Programme l\u00f6schen, Einstellungen \u00e4ndern und Achsen bewegen.",
  "texts.sent": "{name}: {count} {count|Zeile wurde|Zeilen wurden} gesendet", "texts.same": "gleich wie auf der Karte", "texts.different": "nicht gleich wie auf der Karte", "texts.here": "Hier",
  "texts.oncard": "Auf der Karte", "texts.compared": "{name} hier und auf der Karte", "texts.equal.lines": "{count} gleiche {count|Zeile|Zeilen}",
  "texts.noprogram": "Keine Zeile dieser Datei wird in einem Programm gespeichert", "texts.notcompared": "Der Text konnte nicht verglichen werden: noch einmal versuchen",
};

// Einstellen einer Achse.
const TUNING = {
  "pane.tune": "Einstellen", "tune.measure": "MESSEN", "tune.apply": "DIESE WERTE SETZEN", "tune.amplitude": "Amplitude, Pulse", "tune.lowest": "Tiefste Frequenz, Hz", "tune.highest": "H\u00f6chste Frequenz, Hz",
  "tune.time": "Dauer, s", "tune.margin": "Phasenreserve, Grad", "tune.wanted": "Durchtritt, Hz (leer: der h\u00f6chste)", "tune.integral": "mit IGAIN", "tune.measure.text": "Achse {axis} bewegt sich jetzt: um {amplitude} Pulse nach beiden Seiten, {time} s lang, immer schneller. Ist ihr Weg frei? STOP beendet es.", "tune.apply.text": "Achse {axis} bekommt {gains}. Dann macht sie einen Sprung; vorhergesagtes \u00dcberschwingen: {overshoot} %. Schlechte Werte nimmt die Karte zur\u00fcck.",
  "tune.moving": "Achse {axis} wird gemessen. STOP beendet es.", "tune.reading": "{done} von {count} Werten", "tune.done": "Achse {axis} ist gemessen; nichts wurde gesetzt", "tune.nothing": "Nichts wird vorgeschlagen: {why}", "tune.applied": "Achse {axis} hat die vorgeschlagenen Werte", "tune.facts": "Motor: {accel} Pulse/s\u00b2 je V, Rate {rate} /s, Reibung {friction} V, Versatz {offset} V, Verzug {delay} Servotakte",
  "tune.sure": "{error} % der Antwort sind nicht erkl\u00e4rt, Koh\u00e4renz {coherence}", "tune.unsure": "Nicht sicher: {error} % der Antwort sind nicht erkl\u00e4rt, Koh\u00e4renz {coherence}", "tune.limited": "Schneller geht es nicht: {why}", "tune.crossover": "Durchtritt, Hz", "tune.gain.margin": "Amplitudenreserve, dB", "tune.bandwidth": "Bandbreite, Hz",
  "tune.resonance": "Resonanz: {hz} Hz \u00b1 {spread}, Antiresonanz {anti} Hz, D\u00e4mpfung {damping}, Last das {ratio}-fache des Motors", "tune.rigid": "Resonanz: {why}", "tune.notch": "NOTCH, Hz", "tune.width": "NOTCH, Breite, Hz", "tune.lopass": "LOPASS, Hz", "tune.swing": "Last schwingt nach einem Sprung, Pulse",
  "tune.overshoot": "\u00dcberschwingen eines Sprungs, %", "tune.present": "jetzt", "tune.proposed": "Vorschlag", "tune.setpoint": "Sollwert", "tune.measured": "gemessen", "tune.modelled": "nachgebildet",
  "tune.predicted": "vorhergesagt", "tune.motor": "Motor, gemessen", "tune.model": "Motor, Modell", "tune.record": "Aufzeichnung, Pulse", "tune.steps": "Vorhergesagte Spr\u00fcnge, Pulse", "tune.magnitude": "Betrag, dB",
  "tune.phase": "Phase, Grad", "tune.coherence": "Koh\u00e4renz", "tune.step": "SPRUNG", "tune.step.text": "Achse {axis} bewegt sich jetzt: um {amplitude} Pulse und zur\u00fcck, auf einmal. Ist ihr Weg frei? STOP beendet es.", "tune.former": "zuvor",
  "tune.stepped": "Achse {axis}: \u00dcberschwingen {overshoot} %, Anstieg {rise} ms, Einschwingen {settling} ms", "tune.trial": "Sprung, Pulse", "tune.changes": "\u00c4nderungen", "tune.undo": "ZUR\u00dcCK", "tune.redo": "WIEDER",
  "tune.start": "WIE AM ANFANG", "tune.started": "Die Werte sind wie am Anfang", "tune.slider": "{gain}, Schieber", "tune.zero": "0: Wert eintippen",
};

export default Object.freeze({ ...BENCH, ...WORLD, ...PANELS, ...TEXTS, ...TUNING });
