"""Settings of the documentation's pages: `make docs` builds them."""

import logging
import sys
from importlib.metadata import version as version_of
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

from site_pages import write_generated_pages

project, author = "contactsim", "the contactsim developers"
version = release = version_of("contactsim")
html_show_copyright = False
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx_gallery.gen_gallery", "site_pages"]
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
exclude_patterns = ["_build", "gallery/counts.md", "gallery/gallery.md"]
default_role = "literal"
myst_enable_extensions = ["dollarmath", "deflist"]
myst_heading_anchors = 4
autodoc_member_order = "bysource"
autodoc_typehints = "none"
autodoc_class_signature = "mixed"
napoleon_google_docstring = False
napoleon_use_rtype = False
html_theme = "furo"
html_title = f"contactsim {version}"
html_copy_source = False
html_math_renderer = "mathml"
html_theme_options = {"navigation_with_keys": True, "top_of_page_buttons": []}
sphinx_gallery_conf = {
    "examples_dirs": "../examples",
    "gallery_dirs": "generated/examples",
    "filename_pattern": "plot_",
    "ignore_pattern": "reanalyse",
    "download_all_examples": False,
    "show_memory": False,
    "show_signature": False,
    "abort_on_example_error": True,
    "within_subsection_order": "FileNameSortKey",
    "write_computation_times": False,
}

logging.getLogger("contactsim").setLevel(logging.ERROR)  # examples would tell of every load
write_generated_pages()
