"""Pages of HELP of menus and forms; a command has its page beside it, a screen in its file."""

from typing import NamedTuple


class Page(NamedTuple):
    """A page of HELP."""

    key: str  # as the screens ask for it
    title: str
    text: str  # paragraphs, with empty lines between them
    de: tuple[str, str]  # title and text in German

    def data(self, language: str) -> dict[str, str]:
        """Title and text in a language of the screens."""
        title, text = self.de if language == "de" else (self.title, self.text)
        return {"title": title, "text": text}


HELPS = (
    Page(
        "setup",
        "RUN SETUP",
        "What a program needs that does not say it itself: the radius of the cutter (CMP RAD), the"
        " feedrate, P parameters, modal codes. Then LOAD PROG. A program that sets all this itself"
        " can be loaded at once.",
        de=(
            "EINRICHTEN",
            "Was ein Programm braucht, das es nicht selbst angibt: den Radius des"
            " Fräsers (RADIUS), den Vorschub, P-Parameter, modale Codes. Dann LADEN. Ein"
            " Programm, das alles selbst setzt, kann gleich geladen werden.",
        ),
    ),
    Page(
        "cmprad",
        "CMP RAD",
        "The radius of the cutter for programs that choose no D.",
        de=("RADIUS", "Der Radius des Fräsers für Programme, die kein D wählen."),
    ),
    Page(
        "feedrate",
        "FEEDRATE",
        "The feed of programs before their first F; 0: Cut Speed.",
        de=("VORSCHUB", "Der Vorschub von Programmen vor ihrem ersten F; 0: Cut Speed."),
    ),
    Page(
        "modals",
        "SET MODALS",
        "The codes that are active when a program starts, until it says others. SAVE puts them in"
        " force; without Start set chosen programs start as at power-up.",
        de=(
            "G-CODES",
            "Die Codes, die beim Start eines Programms gelten, bis es andere angibt."
            " SPEICHERN setzt sie in Kraft; ohne Start set chosen beginnen Programme wie"
            " nach dem Einschalten.",
        ),
    ),
    Page(
        "manual",
        "MANUAL",
        "MDI runs blocks that you type. JOG moves axes while a key is held, or by an increment."
        " HANDWHEEL connects the wheel with axes. GOTO ZERO moves to the floating zero, Z first"
        " where that is upward, else last.",
        de=(
            "HAND",
            "MDI führt Sätze aus, die eingegeben werden. TIPPEN bewegt Achsen, solange"
            " eine Taste gedrückt ist, oder um ein Schrittmaß. HANDRAD verbindet das Rad"
            " mit Achsen. ZUM NULLPUNKT fährt zum verschobenen Nullpunkt, Z zuerst, wenn"
            " das aufwärts ist, sonst zuletzt.",
        ),
    ),
    Page(
        "setdiag",
        "SET/DIAG",
        "Settings and diagnostics. System parameters describe the machine: with wrong ones it does"
        " not do what is commanded. They may be guarded by a password.",
        de=(
            "SETUP/DIAGN.",
            "Einstellungen und Diagnose. Systemparameter beschreiben die Maschine: Mit"
            " falschen tut sie nicht, was befohlen wird. Sie können durch ein Kennwort"
            " geschützt sein.",
        ),
    ),
    Page(
        "work",
        "WORK COORDINATES",
        "The zeros of G54 to G59.2 in machine positions. TEACH makes the present position the zero"
        " of a system.",
        de=(
            "NULLPUNKTE",
            "Die Nullpunkte von G54 bis G59.2 in Maschinenpositionen. TEACH macht die"
            " jetzige Position zum Nullpunkt eines Systems.",
        ),
    ),
    Page(
        "diagnostics",
        "DIAGNOSTICS",
        "Inputs and outputs, terminal, scope, gains, parameters of the card, servo loop, load,"
        " memory. For experienced personnel: the terminal and the gains act at once.",
        de=(
            "DIAGNOSE",
            "Eingänge und Ausgänge, Terminal, Scope, Regler, Parameter der Karte,"
            " Regelkreis, Last, Speicher. Für erfahrenes Personal: Terminal und Regler"
            " wirken sofort.",
        ),
    ),
    Page(
        "display",
        "DISPLAY",
        "BUTTON PANEL: push buttons of the screen. I/O NAMES: names of inputs and outputs. USER"
        " MESSAGES: texts shown while a bit is set. SETUP SCREEN: what VIEW 1 to 3 show. RESIZE"
        " SCREEN: this browser looks again as it did at first.",
        de=(
            "ANZEIGE",
            "TASTENFELD: Tasten des Bildschirms. E/A NAMEN: Namen der Eingänge und"
            " Ausgänge. MELDUNGEN: Texte, die gezeigt werden, solange ein Bit gesetzt"
            " ist. ANSICHTEN: was SICHT 1 bis 3 zeigen. FENSTER ZURÜCK: Dieser Browser"
            " sieht wieder aus wie am Anfang.",
        ),
    ),
)
