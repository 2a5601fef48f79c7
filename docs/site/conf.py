"""Configuration of Sphinx for the site that scripts/docs builds; the sources are what assemble.py puts together."""

import os
import re
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

ROOT = os.environ["VIBE_ROOT"]  # the workspace; scripts/docs sets it


def version_of(package):
    with open(os.path.join(ROOT, "src", package, "package.xml"), encoding="utf-8") as text:
        return re.search(r"<version>(.*?)</version>", text.read()).group(1)


project = "ViBE for ROS"
copyright = "the ViBE for ROS authors, BSD-3-Clause"  # noqa: A001
release = version = version_of("vibe_core")
language = "en"

extensions = ["myst_parser", "sphinx.ext.mathjax", "theme", "sections"]
myst_enable_extensions = ["dollarmath", "amsmath"]
myst_dmath_double_inline = True
myst_heading_anchors = 4
# A page may show C++, shell, YAML and sessions without a word that tells Pygments which.
highlight_language = "none"
suppress_warnings = ["misc.highlighting_failure"]

# KaTeX of Debian in the place of MathJax: it draws formulas without a server and is small. sphinx.ext.mathjax writes the
# formulas between \( \) and \[ \]; formulas.js draws them.
mathjax_path = "formulas.js"
mathjax_options = {"defer": "defer"}

html_theme = "furo"
html_title = "ViBE for ROS " + version
html_static_path = [os.path.join(os.environ["VIBE_SITE_SOURCE"], "_static")]
html_css_files = ["katex/katex.min.css", "site.css"]
html_js_files = [("katex/katex.min.js", {"defer": "defer"}), ("katex/contrib/auto-render.js", {"defer": "defer"})]
html_copy_source = False
html_show_sourcelink = False
templates_path = ["templates"]
html_additional_pages = {"search": "search.html"}
html_last_updated_fmt = None
