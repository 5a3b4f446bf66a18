"""Write the colours of the store as a module of the screens.

Run `python -m openacr.panel.palette` after a change of them.
"""

from pathlib import Path

from openacr.mill.config.colors import COLORS

MODULE = Path(__file__).parent / "web/js/draw/colors.js"
TEXT = """\
// The 16 colours of the store. Written by `python -m openacr.panel.palette`; do not edit.
/** As the guide has them: texts and grounds of user messages. */
export const PLAIN = Object.freeze([
{plain}
]);
/** Colours of paths, for the ground of either theme. */
export const PENS = Object.freeze([
{pens}
]);
"""


def module_text() -> str:
    """The text of the module."""
    plain = "\n".join(f'  "{color.plain}",' for color in COLORS)
    pens = "\n".join(f'  "light-dark({color.on_light}, {color.on_dark})",' for color in COLORS)
    return TEXT.format(plain=plain, pens=pens)


def main() -> None:
    """Write the module."""
    MODULE.write_text(module_text())


if __name__ == "__main__":
    main()
