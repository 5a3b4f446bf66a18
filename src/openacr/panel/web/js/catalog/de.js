// Deutsche Texte. Die Namen der Tasten sind die der AcroMill-Anleitung, wo sie auf Maschinen üblich sind.
const MENU = {
  "menu.label": "Funktionstasten", "menu.home": "REFE\u00adRENZ", "menu.clrzero": "NULL LÖSCHEN", "menu.setzero": "NULL SETZEN", "menu.edit": "EDITOR", "menu.setup": "EIN\u00adRICHTEN", "menu.run": "PRO\u00adGRAMM",
  "menu.manual": "HAND", "menu.diag": "SETUP/\u200bDIAGN.", "menu.help": "HILFE", "menu.exit": "ENDE", "menu.main": "HAUPT\u00adMENÜ", "menu.cmprad": "RADIUS", "menu.load": "LADEN", "menu.feedrate": "VOR\u00adSCHUB",
  "menu.pparm": "P PARAM", "menu.modals": "G-CODES", "menu.stop": "STOP", "menu.start": "START", "menu.runline": "AB ZEILE", "menu.dryrun": "PROBE\u00adLAUF", "menu.fov": "OVER\u00adRIDES", "menu.block": "EINZEL\u00adSATZ",
  "menu.abort": "AB\u00adBRUCH", "menu.back": "RÜCK\u00adWÄRTS", "menu.halt": "HALT", "menu.forward": "VOR\u00adWÄRTS", "menu.resume": "WEITER", "menu.jog": "TIPPEN", "menu.mdi": "MDI", "menu.handwheel": "HAND\u00adRAD",
  "menu.teach": "TEACH", "menu.gotozero": "ZUM NULL\u00adPUNKT", "menu.sysparam": "SYSTEM\u00adPARAM", "menu.offsets": "KORREK\u00adTUREN", "menu.work": "NULL\u00adPUNKTE", "menu.diagnostics": "DIAG\u00adNOSE",
  "menu.display": "ANZEIGE", "menu.iostatus": "E/A STATUS", "menu.terminal": "TERMI\u00adNAL", "menu.scope": "SCOPE", "menu.gain": "REGLER", "menu.board": "KARTEN\u00adPARAM", "menu.servo": "REGEL\u00adKREIS", "menu.cpu": "CPU-LAST",
  "menu.fast": "FAST STATUS", "menu.memory": "SPEI\u00adCHER", "menu.ionames": "E/A NAMEN", "menu.buttons": "TASTEN\u00adFELD", "menu.resize": "FENSTER ZURÜCK", "menu.messages": "MEL\u00adDUNGEN", "menu.views": "ANSICH\u00adTEN",
};

const FRAME = {
  "key.ok": "OK", "key.cancel": "ABBRECHEN", "key.close": "SCHLIESSEN",
  "stale.old": "Keine neuen Werte: Die gezeigten Positionen sind alt. Von hier aus ist keine Bewegung möglich.",
  "stale.lost": "Keine Verbindung zum Steuerungsprogramm. Die Maschine kann sich noch bewegen. Verbindung wird neu aufgebaut …",
  "stale.card": "Die Karte antwortet nicht. Die Maschine kann sich noch bewegen, der Zustand der Spindel ist unbekannt.",
  "api.lost": "Das Steuerungsprogramm antwortet nicht: nichts wurde gelesen oder gespeichert", "api.unknown": "Das Steuerungsprogramm hat nichts unter diesem Namen", "api.failed": "Das Steuerungsprogramm konnte das nicht tun: nichts wurde gespeichert",
  "stale.refused": "Keine Bewegung: Die gezeigten Positionen sind alt",
  "state.IDLE": "BEREIT", "state.RUN": "LÄUFT", "state.WAIT": "WARTET", "state.HOMING": "REFERENZ", "state.HOLD": "ANGEHALTEN", "state.ALARM": "ALARM", "state.JOG": "TIPPEN",
  "stop.title": "Hält alles an, was sich auf der Karte bewegt, auf seiner Bahn und mit seinen Rampen. Das ist kein Not-Halt.",
  "stopped.held": "STOP hält {what}", "stopped.moving": "Trotz STOP bewegt sich: {axes}",
  "stopped.all": "ALLES BEENDEN", "stopped.estop": "BEWEGUNG AUS, ANTRIEBE AUS",
  "mode.past": "BEI {at} s, {before} s VOR DEM ENDE", "mode.past.title": "Die Karte wird zu einem Zeitpunkt ihrer Geschichte gezeigt: BETREIBEN der Zeitachse geht von hier weiter", "mode.still": "DIE ZEIT DER KARTE STEHT",
  "mode.setup": "EINRICHTEN", "mode.setup.done": "AcroMill hat die Karte eingerichtet.",
  "mode.setup.text": "EINRICHTEN löst die Achsen ihres Programms, ordnet die von AcroMill zu und sendet deren Einstellungen: was dort zugeordnet und eingestellt war, geht verloren. Gespeicherte Programme bleiben.",
  "lamp.moves": "KARTE BEWEGT", "lamp.runs": "KARTE LÄUFT", "lamp.drives": "Antriebe ein: {axes}",
  "prompt.label": "Meldungen der Steuerung und der Programme", "ask.value": "Ein Wert wird verlangt", "ask.answer": "ANTWORTEN", "tool.wanted": "Werkzeug wechseln", "tool.changed": "GEWECHSELT",
  "alarm.left": "Die Ursache besteht noch: {what}", "alarm.show": "ALARME", "alarm.more": "+{count}", "alarm.count": "Anstehende Alarme: {count}", "alarm.none": "Kein Alarm steht an", "alarm.noprogram": "Kein Programm geladen",
  "alarm.time": "Zeit", "alarm.code": "Alarm", "alarm.text": "Text",
  "control.title": "Wer die Maschine bedient", "control.you": "Sie bedienen", "control.other": "{name} bedient", "control.free": "Nur Anzeige", "control.first": "Frei", "control.has": "bedient",
  "control.text": "Die erste Taste übernimmt eine freie Maschine. Nur ein Bildschirm bewegt die Maschine. STOP wirkt jederzeit von jedem Bildschirm.", "control.ask": "UM BEDIENUNG BITTEN", "control.force": "SOFORT ÜBERNEHMEN", "control.give": "AN {name} GEBEN",
  "settings.title": "Darstellung", "settings.bench": "Arbeitsplatz des Ingenieurs", "settings.operator": "Arbeitsplatz des Bedieners", "settings.theme": "Farben", "settings.language": "Sprache", "theme.auto": "wie das System", "theme.light": "hell", "theme.dark": "dunkel",
  "role.view": "Zuschauer", "role.operate": "Bediener", "role.setup": "Einrichter", "role.service": "Service", "role.needed": "Dafür ist die Rolle {role} nötig: anmelden",
  "display.label": "Anzeigefenster", "tab.graphics": "GRAFIK", "tab.program": "PROGRAMM", "tab.io": "E/A", "tab.plc": "SPS", "tab.alarms": "ALARME", "status.label": "Statusfenster", "status.view": "SICHT {n}",
};

const BLOCKS = {
  "block.position": "Istposition", "block.distance": "Restweg", "block.next": "Nächste Position", "block.modal": "Aktive G-Codes", "block.estop": "Not-Halt", "block.feeds": "Vorschub und Spindel", "block.buttons": "Tasten",
  "position.machine": "Maschinenposition", "position.togo": "Restweg", "position.set": "Werkstückposition von {axis} setzen", "position.hint": "Diesen Wert soll die Achse hier anzeigen", "position.done": "{axis} ist gesetzt",
  "position.busy": "Eine Position lässt sich setzen, solange nichts läuft", "position.homed": "referenziert", "position.nothomed": "nicht referenziert",
  "feeds.actual": "F ist", "feeds.set": "F soll", "feeds.spindle": "Spindel", "feeds.rpm": "1/min", "feeds.off": "aus", "feeds.tool": "Werkzeug", "feeds.coolant": "Kühlung", "feeds.flood": "Strahl", "feeds.mist": "Nebel",
  "feeds.line": "Zeile", "feeds.time": "Laufzeit", "feeds.left": "Restzeit", "feeds.parts": "Teile",
  "estop.on": "Not-Halt ist betätigt", "estop.off": "Not-Halt ist frei", "estop.left": "Not-Halt ist wieder frei: Alarm quittieren", "estop.none": "Not-Halt: nicht verdrahtet", "estop.software": "STOP auf diesem Bildschirm ist kein Not-Halt.",
  "buttons.none": "Keine Tasten definiert: SETUP/DIAGN., ANZEIGE, TASTENFELD", "override.label": "Overrides", "override.feed": "Vorschub", "override.rapid": "Eilgang", "override.spindle": "Spindel", "override.open": "Alle Overrides",
  "override.more": "Vorschub-Override höher", "override.less": "Vorschub-Override tiefer", "override.wired": "am Schalter des Bedienpults",
  "pad.back": "löschen", "pad.clear": "leeren", "pad.sign": "Vorzeichen", "pad.none": "Keine Zahl: Ziffern, . + - * / und Klammern", "pad.open": "Ziffernblock",
  "graphics.views": "Ansichten", "graphics.label": "Werkzeugbahn des Programms", "graphics.top": "OBEN", "graphics.front": "VORN", "graphics.side": "SEITE", "graphics.iso": "3D", "graphics.fit": "GANZ", "graphics.in": "Vergrößern", "graphics.out": "Verkleinern",
  "graphics.stock": "ROHTEIL", "graphics.computing": "Rohteil: {percent} %", "graphics.dip": "Eilgang im Material: Satz {lines}", "graphics.below": "Unter dem Rohteil: Satz {lines}", "graphics.sound": "Kein Eilgang im Material, kein Schnitt unter dem Rohteil",
  "graphics.loading": "{name} wird geladen …", "graphics.draw": "ZEICHNEN", "graphics.notdrawn": "nicht gezeichnet: Default Graphics (P250002) ist aus", "program.runs": "läuft", "program.rests": "geladen, läuft nicht", "program.follow": "FOLGEN", "program.from": "AB ZEILE {line}", "io.title": "E/A-Status", "io.inputs": "Eingänge", "io.outputs": "Ausgänge", "io.on": "ein", "io.off": "aus",
};

const RUN = {
  "run.none": "Kein Programm geladen: EINRICHTEN, LADEN", "run.wrong": "Diese Fehler wurden beim Laden gefunden, so wie die Maschine da eingestellt war. Der Lauf endet beim ersten davon.", "run.anyway": "TROTZDEM STARTEN", "findings.errors": "{count} Fehler", "findings.warnings": "{count} {count|Warnung|Warnungen}", "findings.title": "Was am Programm nicht stimmt",
  "run.line": "Startzeile", "run.lines": "{count} {count|Zeile|Zeilen}", "run.seconds": "etwa {time}", "run.dry": "Probelauf: Trial Speed, ohne M-Funktionen.", 
  "run.safez": "Sicheres Z (Maschine)", "run.safez.hint": "Wo das Werkzeug frei ist, wenn keine Zeile davor es im Eilgang dorthin bringt", "run.range": "Das Programm hat die Zeilen 1 bis {last}", "begin.title": "Start bei Zeile {line}", "begin.text": "Die Zeilen davor wurden ohne Bewegung durchlaufen. Das unterscheidet sich vom jetzigen Zustand der Maschine:",
  "begin.tool": "In der Spindel ist ein anderes Werkzeug", "begin.present": "Jetzt", "begin.wanted": "Verlangt", "begin.go": "ANFAHREN UND STARTEN", "start.title": "Weiter", "start.covered": "Die Maschine fährt weiter ({state} {reason}). Dieser Bildschirm verdeckt die Positionen.",
  "clrzero.title": "Null löschen", "clrzero.text": "Der Nullpunkt aus G92 wird für alle Achsen gelöscht: Es gilt wieder das Werkstück-Koordinatensystem.", "clrzero.done": "Der Nullpunkt ist gelöscht",
  "gotozero.title": "Zum Nullpunkt", "gotozero.text": "Im Eilgang zum Programmnullpunkt ({work} mit dem aus G92): {steps}. Von: {places}", "gotozero.then": ", dann ",
  "home.title": "Referenzfahrt", "home.text": "Die Achsen fahren zu ihren Schaltern: Tisch freimachen. Reihenfolge nach Priorität.", "home.axes": "Achsen", "home.progress": "Die Referenzfahrt läuft: {reason}", "home.homed": "referenziert", "home.nothomed": "nicht referenziert",
  "home.state.waiting": "wartet", "home.state.switch": "fährt zum Schalter", "home.state.release of the switch": "verlässt den Schalter", "home.state.marker": "sucht die Nullmarke", "home.state.rest": "bremst", "home.state.done": "referenziert", "home.state.failed": "fehlgeschlagen",
  "axes.all": "Alle Achsen", "axes.none": "Zuerst eine Achse wählen", "zero.title": "Null setzen", "zero.text": "Die gewählten Achsen zeigen hier 0 an (G92).", "zero.axes": "Achsen", "zero.done": "{axes}: 0 gesetzt",
  "jog.title": "Tippen", "jog.speed": "Geschwindigkeit", "jog.slow": "LANGSAM", "jog.fast": "SCHNELL", "jog.how": "Dauernd oder schrittweise", "jog.continuous": "DAUERND", "jog.text": "Taste halten zum Fahren. Pfeiltasten fahren X und Y, Bild auf und ab fahren Z. STOP ist kein Not-Halt.", "jog.ended": "Das Tippen ist beendet: {reason}",
  "handwheel.title": "Handrad", "handwheel.text": "Das Rad bewegt die gewählten Achsen, bis dieser Bildschirm verlassen wird.", "handwheel.axes": "Achsen am Rad", "handwheel.start": "VERBINDEN", "handwheel.end": "TRENNEN", "handwheel.on": "Das Rad bewegt {axes}",
  "teach.title": "Teach", "teach.text": "Die Stelle der Maschine wird zum Nullpunkt des Systems.", "teach.system": "Koordinatensystem", "teach.axes": "Achsen, Maschinenposition", "teach.done": "{system}: {axes} übernommen", "teach.length.done": "H{h} übernommen",
  "mdi.title": "MDI", "mdi.buffer": "Ausgeführte Sätze", "mdi.line": "Satz", "mdi.on": "PUFFER", "mdi.keep": "ÜBERNEHMEN", "mdi.runall": "ALLE AUSFÜHREN", "mdi.save": "SPEICHERN", "mdi.clear": "LEEREN", "mdi.running": "Ein Satz wird ausgeführt", "mdi.count": "{count} {count|Satz|Sätze}",
};

const FORMS = {
  "form.title": "Parameter", "form.savepage": "SEITE SPEICHERN", "form.save": "SPEICHERN", "form.undo": "ZURÜCK", "form.changed": "Nicht gespeichert: {count}", "form.locked": "Gesperrt: {reason}", "form.axis": "Achse", "form.previous": "ZURÜCK", "form.next": "WEITER", "form.page": "{first}–{last} von {total}",
  "form.goto": "Gehe zu Zeile", "form.goto.hint": "1 bis {last}", "form.saved": "Gespeichert: {count}", "form.refused": "Nicht gespeichert; abgelehnt: {count}", "form.leave": "Nicht gespeichert", "form.leave.text": "Änderungen, die ohne SPEICHERN verloren gehen: {count}", "form.drop": "VERWERFEN", "form.elsewhere": "Inzwischen anderswo geändert",
  "field.least": "mindestens {low}", "field.most": "höchstens {high}", "field.range": "{low} bis {high}", "field.typical": "üblich {value}", "field.default": "Vorgabe {value}", "field.motion": "nicht während ein Programm läuft",
  "ballscrew.title": "Ballscrew", "ballscrew.on": "Tabelle ein", "ballscrew.import": "IMPORT", "ballscrew.export": "EXPORT", "ballscrew.add": "NEUE ZEILE", "ballscrew.remove": "Zeile entfernen", "ballscrew.position": "Position", "ballscrew.error": "Fehler",
  "ballscrew.text": "Ein Fehler ist die befohlene Position minus dem Mittel des dort Gemessenen. Positionen zählen vom Referenzpunkt; die unter ihm folgen am Ende. Eine Tabelle wirkt, sobald ihre Achse referenziert ist.",
  "ballscrew.count": "Zeilen: {count}", "ballscrew.imported": "{name} ist gelesen; SPEICHERN speichert es", "ballscrew.saved": "Die Spindeltabelle von {axis} ist gespeichert",
  "parameters.title": "Systemparameter", "parameters.search": "Parameter suchen", "parameters.nothing": "Nichts gefunden", "offsets.title": "Korrekturen",
  "load.title": "Programm laden", "load.source": "Quelle", "load.file": "DATEI", "load.part": "TEILEBIBLIOTHEK", "load.dxf": "DXF", "load.batch": "STAPEL", "load.drip": "SERIELL", "load.files": "Programme", "load.text": "Text der Datei", "load.choose": "Eine Datei wählen",
  "load.go": "LADEN", "load.radians": "im Bogenmaß", "load.radius": "der Werkzeugradius", "load.or": "oder", "load.and": "und", "load.upload": "HOCHLADEN", "load.drop": "Dateien können hier abgelegt werden.", "load.toobig": "{name} ist größer als {most}", "load.uploaded": "{name} ist hochgeladen", "load.locked": "geladen", "load.more": "{count} weitere {count|Zeile|Zeilen}", "load.port": "Schnittstelle",
  "load.drip.text": "Das Programm wird während des Laufs von einer seriellen Schnittstelle gelesen. Ohne Angabe gilt die der Seite COMMUNICATIONS.", "load.drip.start": "LESEN",
  "load.link": "RS-232 (LINK)", "load.link.text": "Ein Programm wird von einer seriellen Schnittstelle empfangen und als Datei behalten. Es endet mit %, Strg-Z oder Stille nach M2, M30 oder M99. Ohne Angabe gilt die Schnittstelle der Seite COMMUNICATIONS.",
  "load.link.file": "Behalten als", "load.link.start": "EMPFANGEN", "load.link.receiving": "{name} von {port}: {lines} {lines|Zeile|Zeilen}, {bytes}", "load.link.kept": "{name} ist da: {lines} {lines|Zeile|Zeilen}, {bytes}", "load.link.cancelled": "{name} wurde abgebrochen: nichts wurde behalten",
  "dxf.kind": "Art", "dxf.path": "Zusammenhängende Bahn", "dxf.drill": "Bohrbild", "dxf.direction": "Richtung", "dxf.cw": "0 im Uhrzeigersinn", "dxf.ccw": "1 gegen den Uhrzeigersinn", "dxf.depth": "Z des Schnitts", "dxf.tool": "Fräser, D-Nummer", "dxf.layer": "Layer", "dxf.all": "alle Layer", "dxf.output": "Ausgabedatei", "dxf.convert": "UMWANDELN", "dxf.done": "Umgewandelt: {name}",
  "edit.title": "Editor", "edit.text": "Text des Programms", "edit.dxf": "DXF", "edit.open": "ÖFFNEN", "edit.new": "NEU", "edit.save": "SPEICHERN", "edit.saveas": "SPEICHERN ALS", "edit.name": "Dateiname (.TXT)", "edit.saved": "{name} ist gespeichert", "edit.unnamed": "neue Datei", "edit.lines": "{count} {count|Zeile|Zeilen}", "edit.locked": "Dieses Programm läuft: Es lässt sich jetzt nicht ändern",
  "edit.leave": "Nicht gespeichert", "edit.leave.text": "{name} hat ungespeicherte Änderungen.", "edit.conflict": "Inzwischen geändert", "edit.overwrite": "ÜBERSCHREIBEN",
};

const SERVICE = {
  "diag.warning": "Nur für Fachleute: Änderungen wirken sofort auf die Karte.", "terminal.title": "Terminal", "terminal.line": "Zeile an die Karte", "terminal.send": "SENDEN",
  "scope.title": "Scope", "scope.channel": "Quelle von Kanal {n}", "scope.scale": "Maßstab von Kanal {n}, Einheiten/Teil", "scope.offset": "Versatz von Kanal {n}", "scope.source": "P12290", "scope.sweep": "Ablenkung, ms/Teil", "scope.period": "Abtastung, ms",
  "scope.index.text": "Die Achse fährt jetzt: {move}. Ist ihr Weg frei?", "scope.profile": "Index-Profil", "scope.autoscale": "AUTOSKALA", "scope.range": "Ablenkung und Abtastung sind Zeiten über 0 ms", "scope.divisions": "Teile", "scope.level": "Triggerpegel", "scope.mode": "Trigger", "scope.free": "frei laufend", "scope.auto": "auto", "scope.normal": "normal", "scope.single": "einmal",
  "scope.state.waiting": "WARTET auf einen Trigger, {count} {count|Messwert|Messwerte}", "scope.state.triggered": "GETRIGGERT, {count} {count|Messwert|Messwerte}", "scope.state.taken": "ÜBERNOMMEN: Das Scope misst jetzt für {owner}. START holt es zurück", "scope.take": "SCOPE ÜBERNEHMEN", "scope.head.source": "Quelle", "scope.head.scale": "Einh./Teil", "scope.head.offset": "Versatz",
  "scope.slope": "Flanke", "scope.rising": "steigend", "scope.falling": "fallend", "scope.start": "START", "scope.armed": "Scharf", "scope.read": "{count} {count|Messwert|Messwerte}", "scope.stopped": "Angehalten nach {count} {count|Messwert|Messwerten}",
  "gain.title": "Reglerverstärkung", "gain.warning": "Ein Wert wirkt auf den Regelkreis, sobald er eingegeben ist.", "gain.store": "in den Maschinenparametern behalten", "gain.enter": "EINGABE", "gain.done": "{gain} ist {value}", "gain.later": "{gain} ist {value}; gespeichert wird, sobald die Maschine ruht",
  "board.title": "Kartenparameter", "board.search": "Name oder Nummer", "board.number": "Nummer", "board.name": "Name", "board.value": "Wert", "board.doc": "Bedeutung", "values.set": "SETZEN", "values.clear": "L\u00d6SCHEN", "values.now": "Jetzt: {value}", "values.is": "{name} ist {value}", "board.written": "P{number} ist {value}",
  "pparm.title": "P-Parameter", "pparm.done": "P{n} ist {value}", "servo.title": "Regelkreis", "cpu.title": "CPU-Last", "fast.title": "Fast Status", "memory.title": "Speicheraufteilung",
  "views.title": "Ansichten", "views.block": "Block", "views.save": "ANSICHT SPEICHERN", "views.saved": "Die Ansichten sind gespeichert", "tour.title": "RUNDGANG", "tour.back": "ZURÜCK", "tour.next": "NÄCHSTES", "tour.end": "SCHLUSS",
  "tour.state": "Was die Maschine jetzt tut. Daneben: wer bedient, und die Einstellungen dieses Browsers; darunter das geladene Programm und seine Alarme.",
  "tour.status": "Die Positionsanzeige: der Ort jeder Achse. Die Taste einer Achse setzt ihren Nullpunkt; ANSICHT 1 bis 3 zeigen andere Werte.",
  "tour.display": "Das Anzeigefenster: das Bild der Bahn, das Programm, Ein- und Ausgänge, Alarme. Die Tasten F1 bis F10 öffnen hier ihre Bildschirme.",
  "tour.prompt": "Was Programm und Maschine ausgeben, warum eine Taste abgelehnt wird, und Fragen an Sie.",
  "tour.menu": "Die Funktionstasten F1 bis F10. Eine Taste öffnet einen Bildschirm oder ein anderes Menü; F10 führt zurück. EINRICHTEN lädt ein Programm, PROGRAMM startet es.",
  "tour.stop": "STOP hält den Vorschub an, jederzeit. Es ist nicht der Not-Halt der Maschine.",
  "help.title": "Hilfe", "help.none": "Zu dieser Taste gibt es keine Seite.",
};

const ON_CARD = {
  "splitter.label": "Kante zwischen Status- und Anzeigefenster", "message.all": "Alle Meldungen", "message.more": "+{count}",
  "find.find": "Suchen", "find.by": "Ersetzen durch", "find.next": "WEITER", "find.previous": "ZURÜCK", "find.all": "ALLE", "find.case": "Groß/klein", "find.regexp": "regulärer Ausdruck", "find.word": "ganze Wörter", "find.replace": "ERSETZEN", "find.replaceall": "ALLE ERSETZEN", "find.current": "jetziger Treffer", "find.online": "in Zeile", "find.replaced": "in Zeile $ ersetzt", "find.replacedall": "$ ersetzt", "find.goto": "Zu Zeile", "find.go": "LOS",
  "menu.programs": "PROG/\u200bSPS", "programs.title": "Programme und SPS der Karte", "programs.list": "Programme und SPS", "programs.text": "Text, wie ihn die Karte auflistet", "programs.printed": "Ausgaben des Programms", "programs.read": "LESEN",
  "programs.choose": "Programm wählen", "programs.line": "Zeile {line}", "programs.bytes": "{used} Byte", "programs.differs": "≠ Projekt", "programs.differs.text": "Auf der Karte steht ein anderer Text als im Projekt: er geht mit dem Prozess des Panels verloren, wenn er nicht ins Projekt gespeichert wird (Editor)", "programs.nomemory": "kein Speicher", "programs.run": "START", "programs.halt": "HALT", "programs.pause": "PAUSE", "programs.resume": "WEITER",
  "programs.block": "EINZEL", "programs.step": "SCHRITT", "programs.listen": "MITHÖREN", "programs.edit": "ÄNDERN", "programs.clear": "LÖSCHEN", "programs.send": "SENDEN", "programs.sent": "{name}: {count} {count|Zeile ist|Zeilen sind} auf der Karte gespeichert",
  "programs.run.title": "{name} starten?", "programs.run.text": "Ein Programm der Karte kann sofort Achsen bewegen. STOP hält es an; die Overrides dieser Maschine wirken nicht darauf.",
  "programs.clear.title": "{name} löschen?", "programs.clear.text": "Seine Zeilen werden im Speicher der Karte gelöscht.", "programs.cleared": "{name} ist leer",
  "programs.state.running": "läuft", "programs.state.halted": "steht", "programs.state.paused": "angehalten", "programs.state.waits for STEP": "wartet auf SCHRITT", "programs.state.waits for room": "wartet auf Platz", "programs.state.dwells": "verweilt", "programs.state.inhibited": "gesperrt",
  "plc.choose": "SPS", "plc.ladder": "Kontaktplan", "plc.listing": "LISTE", "plc.read": "LESEN", "plc.running": "läuft", "plc.halted": "steht", "plc.empty": "Diese SPS hat keinen Text.", "plc.notdrawn": "Nicht als Kontaktplan zeichenbar: {why}", "plc.norung": "sie enthält keinen Strompfad", "plc.rung": "Strompfad {line}",
  "loop.label": "Regelkreis der Achse {axis}", "loop.open": "Regelkreis offen", "loop.closed": "Regelkreis geschlossen", "loop.filtering": "Filter ein", "loop.bypassed": "Filter aus",
  "loop.current": "Position", "loop.gear": "Gear-Versatz", "loop.jog": "Tipp-Versatz", "loop.cam": "Cam-Versatz", "loop.backlash": "Umkehrspiel", "loop.ballscrew": "Spindel", "loop.primary": "1. Sollwert", "loop.secondary": "2. Sollwert", "loop.actual": "Istposition",
  "loop.error": "Schleppfehler", "loop.p": "P-Anteil, V", "loop.i": "I-Anteil, V", "loop.d": "D-Anteil, V", "loop.ffvel": "Vorsteuerung v, V", "loop.ffacc": "Vorsteuerung a, V", "loop.fbvel": "Rückführung v, V",
  "loop.sum": "Summe, V", "loop.filter0": "Filter 0", "loop.filter1": "Filter 1", "loop.filtered": "Gefiltert, V", "loop.limits": "Grenzen, V", "loop.output": "Ausgang, V",
};

const CARD = {
  "units.switch": "Anzeige zwischen mm und Zoll umschalten", "cpu.foreground": "Servo-Interrupt", "cpu.background": "Für Programme übrig", "memory.warning": "Nur für erfahrenes Personal. Eine Änderung löscht alle Programme, SPS-Programme und Variablen der Karte.", "memory.save": "SPEICHERN UND KARTE LÖSCHEN",
  "memory.lost": "Alle Programme, SPS-Programme und Variablen auf der Karte gehen verloren. Die Maschine wird neu eingerichtet.", "memory.bytes": "Byte", "memory.free": "Frei: {free} Byte", "memory.number": "{name}: eine ganze Zahl von Byte", "memory.done": "Der Speicher der Karte ist neu aufgeteilt",
};

const ACCESS = {
  "exit.text": "VERLASSEN schließt die Bildschirme; das Steuerungsprogramm läuft weiter. BEENDEN beendet das Steuerungsprogramm.", "exit.remote": "Den Bildschirm verlassen? Das Steuerungsprogramm läuft weiter.",
  "exit.busy": "Die Maschine arbeitet. Sie wird zuerst angehalten: Das Programm endet, die Achsen kommen zum Stillstand.", "exit.leave": "VERLASSEN", "exit.end": "BEENDEN",
  "exit.done": "Sie haben den Bildschirm verlassen. Das Steuerungsprogramm läuft weiter.", "exit.ended": "AcroMill ist beendet.", "exit.again": "ZURÜCKKEHREN",
  "login.title": "Anmelden", "login.role": "Rolle", "login.password": "Passwort", "login.go": "ANMELDEN",
};

/** @type {Record<string, string>} */
const texts = { ...MENU, ...FRAME, ...BLOCKS, ...RUN, ...FORMS, ...SERVICE, ...ON_CARD, ...ACCESS, ...CARD };

export default texts;
