"""Sphinx configuration of the documentation site: `make docs` builds it into out/docs."""

import sys
from pathlib import Path

DOCS = Path(__file__).resolve().parent
sys.path[:0] = [str(DOCS.parent), str(DOCS)]

import site_pages

import jaxhydro

project = "jaxhydro"
author = "The jaxhydro developers"
copyright = f"2026, {author}"
version = release = jaxhydro.__version__

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.mathjax",
    "sphinx.ext.napoleon",
    "sphinx_copybutton",
]
exclude_patterns = ["evidence"]
suppress_warnings = ["myst.header"]  # the page of evidence goes from H2 to H4
highlight_language = "none"  # of examples that name no language
default_role = "code"  # docstrings have names between single backticks

myst_enable_extensions = ["dollarmath", "html_image"]
myst_fence_as_directive = ["math"]  # ```math, as on GitHub
myst_heading_anchors = 4
nb_execution_mode = "off"  # tests run the notebooks
nb_merge_streams = True

autodoc_member_order = "bysource"
autodoc_typehints = "description"
autodoc_typehints_description_target = "documented"
autodoc_type_aliases = {"ArrayLike": "ArrayLike"}
autosummary_generate = False
napoleon_google_docstring = True
napoleon_numpy_docstring = False
napoleon_use_ivar = True
napoleon_custom_sections = [("Objectives", "params_style")]  # of calibrate_in_waves
python_maximum_signature_line_length = 88

html_theme = "pydata_sphinx_theme"
html_title = f"jaxhydro {release}"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_show_sourcelink = False
html_copy_source = False
html_theme_options = {
    "logo": {"text": "jaxhydro"},
    "github_url": site_pages.REPOSITORY,
    "header_links_before_dropdown": 7,
    "navigation_with_keys": False,
    "show_toc_level": 2,
    "footer_start": ["copyright"],
    "footer_end": ["sphinx-version"],
    "secondary_sidebar_items": {"**": ["page-toc"], "index": []},
    "show_prev_next": False,
}
html_sidebars = {page: [] for page in ("index", "quickstart", "faq")}


def setup(app):
    """Make the pages that are no files of this folder; connect what changes pages and docstrings as they are read."""
    site_pages.make_pages(DOCS)
    app.connect("source-read", site_pages.as_site_page)
    app.connect("autodoc-process-docstring", site_pages.as_restructured_text, priority=100)
    return {"parallel_read_safe": True}
