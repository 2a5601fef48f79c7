"""The text of every section, for the search of the site (search.js), in the place of Sphinx's own index, which knows neither
sections nor how often a word is in one, and whose results have no text where pages are opened as files."""

import json
import pathlib
import re

from docutils import nodes

# What says how to use it counts most, then worked cases, what lists or judges, and the insides.
WEIGHTS = ((r"code/|.*/CHANGELOG$|index$|docs/README$", 0), (r"reference/cpp|src/.*/test/|docs/(policy|architecture|rviz_benchmark)$", 0.4),
           (r"README|CONTRIBUTING|reference/|src/|examples/|docs/(accuracy|measurements|phantom|peers|dependencies|robustness)$", 0.7),
           (r"docs/tutorials/", 0.9))


def weight(page):
    """How much a page counts; 0: it is not searched."""
    return next((weight for pattern, weight in WEIGHTS if re.match(pattern, page)), 1)


def plain(text):
    """Without what HTML leaves out, on one line."""
    return " ".join(re.sub(r"<!--.*?-->", "", text, flags=re.DOTALL).split())


def sections_of(tree):
    """(anchor, heading, text without that of the sections inside)"""
    for section in tree.findall(nodes.section):
        text = " ".join(part.astext() for part in section if not isinstance(part, (nodes.section, nodes.title)))
        inner = section.parent is not tree
        yield "#" + section["ids"][0] if inner else "", section.next_node(nodes.title).astext(), plain(text)


def write(app, problem):
    if problem:
        return
    env = app.env
    rows = [[page, env.titles[page].astext(), weight(page), list(sections_of(env.get_doctree(page)))]
            for page in sorted(env.found_docs) if weight(page)]
    file = pathlib.Path(app.outdir) / "_static/sections.js"
    file.write_text("const PAGES = {};\n".format(json.dumps(rows, ensure_ascii=False, separators=(",", ":"))), encoding="utf-8")


def without_index(app):
    app.builder.search = False


def setup(app):
    app.connect("builder-inited", without_index)
    app.connect("build-finished", write)
    return {"parallel_read_safe": True}
