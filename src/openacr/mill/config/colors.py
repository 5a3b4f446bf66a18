"""The 16 colours of the guide's screens, by index, and what they are drawn as on both grounds."""

from typing import NamedTuple


class ScreenColor(NamedTuple):
    """A colour of the guide, and the tones of it that show on a white and on a dark ground."""

    plain: str
    on_light: str
    on_dark: str


COLORS = (
    ScreenColor("#000000", "#000000", "#A3ADB7"),  # black
    ScreenColor("#0000A8", "#0033CC", "#5C8DFF"),  # blue
    ScreenColor("#00A800", "#007A33", "#2FA35C"),  # green
    ScreenColor("#00A8A8", "#00808A", "#2AA5B0"),  # cyan
    ScreenColor("#A80000", "#B00020", "#E5484D"),  # red
    ScreenColor("#A800A8", "#8E24AA", "#B65FD3"),  # magenta
    ScreenColor("#A85400", "#8B5A2B", "#B57B45"),  # brown
    ScreenColor("#A8A8A8", "#8A8A8A", "#C3C7CB"),  # light grey
    ScreenColor("#545454", "#555555", "#7A828A"),  # dark grey
    ScreenColor("#5454FC", "#3B82F6", "#7FB2FF"),  # light blue
    ScreenColor("#54FC54", "#009E73", "#3DDC9A"),  # light green
    ScreenColor("#54FCFC", "#1292A8", "#4FD6EA"),  # light cyan
    ScreenColor("#FC5454", "#E4572E", "#FF8A65"),  # light red
    ScreenColor("#FC54FC", "#D957B5", "#FF9BE0"),  # light magenta
    ScreenColor("#FCFC54", "#AD8200", "#FFD54A"),  # yellow
    ScreenColor("#FCFCFC", "#6F8FAF", "#FFFFFF"),  # white
)
LIGHT_GREEN = 10
