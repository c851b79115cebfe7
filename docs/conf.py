"""Sphinx configuration: ``python -m sphinx -W -b html docs docs/_build/html``."""

import sys
from pathlib import Path

sys.path[:0] = [str(Path(__file__).resolve().parent.parent / "src"), str(Path(__file__).resolve().parent)]

import ancf  # noqa: E402

project = "ancf"
author = "The ancf developers"
copyright = "2026, The ancf developers"
release = version = ancf.__version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.mathjax",
    "sphinx.ext.napoleon",
    "sphinx-mathjax-offline",  # equations are drawn without a network
    "reference_pages",
]
exclude_patterns = ["_build"]
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}

myst_enable_extensions = ["amsmath", "colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3

napoleon_google_docstring = False
napoleon_numpy_docstring = True
napoleon_use_ivar = True  # attributes are a list, as properties have entries of their own
autodoc_member_order = "bysource"
autodoc_typehints = "description"

html_show_search_summary = False  # a summary is fetched, which a page from disk may not do
html_theme = "furo"
html_title = f"ancf {release}"
html_static_path = ["_static"]
html_css_files = ["custom.css"]
html_js_files = ["reachable.js"]
html_theme_options = {
    "light_css_variables": {"color-brand-primary": "#14507a", "color-brand-content": "#14507a"},
    "dark_css_variables": {"color-brand-primary": "#7fbde6", "color-brand-content": "#7fbde6"},
}
