# Sphinx configuration of the documentation; docs/site/build.py runs it with the root of the tree as source folder.
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
root = pathlib.Path(__file__).parents[2]

project = "Snag"
author = copyright = re.search(r"name: (.*)", (root / "CITATION.cff").read_text())[1]
version = release = re.search(r"project\(snag VERSION (\S+)", (root / "CMakeLists.txt").read_text())[1]
extensions = ["myst_parser", "snag_site"]
root_doc = "docs/index"
include_patterns = ["docs/**", "cases/*/README.md", "CHANGELOG.md", "CONTRIBUTING.md", "CODE_OF_CONDUCT.md", "MAINTAINERS.md",
                    "SECURITY.md"]
exclude_patterns = ["build", "results", ".git", "tests"]
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 4
nitpicky = True

html_theme = "furo"
html_title = f"Snag {version}"
html_math_renderer = "katex"
html_static_path = ["static"]
html_css_files = ["katex/katex.min.css", "site.css"]
templates_path = ["templates"]
html_context = {"with_headers": tags.has("headers")}  # noqa: F821, of Sphinx
html_copy_source = False
pygments_style = "friendly"
