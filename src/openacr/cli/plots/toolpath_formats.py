"""The tool path of a part program as a picture, in the format of a file name."""

from pathlib import Path

from openacr.cli.plots.toolpath import Scene


def draw_path(scene: Scene, path: Path) -> None:
    """Draw a scene in the format of the file name."""
    if path.suffix.lower() == ".html":
        from openacr.cli.plots.toolpath_page import write_page

        write_page(scene, path)
    else:
        from openacr.cli.plots.toolpath_image import write_image

        write_image(scene, path)
