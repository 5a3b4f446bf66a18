"""Sphinx: `make site` copies docs/ and the pages beside this file to build/site-pages."""

project = "openacr"
copyright = "the openacr authors"
extensions = ["myst_parser", "sphinx.ext.autodoc"]
html_theme = "furo"
html_title = "openacr"
html_copy_source = False
html_theme_options = {"source_directory": "docs/"}
exclude_patterns = ["images"]
myst_heading_anchors = 3
suppress_warnings = ["myst.header", "misc.highlighting_failure"]
autodoc_member_order = "bysource"
autodoc_typehints = "description"
autodoc_default_options = {"members": True, "show-inheritance": True}
nitpicky = False
