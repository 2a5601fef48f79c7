"""Makes the theme as Debian packs it work from the file system: its script is a module that imports another, which browsers
refuse for files; its style sheet imports one by an address of a web server, and has lost the rules for systems in the dark."""

import pathlib
import re


def mend(app, problem):
    static = pathlib.Path(app.outdir) / "_static"
    script, style = static / "scripts/furo.js", static / "styles/furo.css"
    if problem or not script.is_file() or not style.is_file():
        return
    text = script.read_text(encoding="utf-8")
    found = re.match(r'import Gumshoe from "\./(.*)";\n', text)
    if found:
        script.write_text((script.parent / found.group(1)).read_text(encoding="utf-8") + text[found.end():], encoding="utf-8")
    rules = style.read_text(encoding="utf-8")
    rules = re.sub(r"@import url\(/.*?\);\n", "", rules)
    dark = re.search(r"@media not print \{\n(.*?\} *)\}\n", rules, re.DOTALL)
    if dark and "prefers-color-scheme" not in rules:
        rules += "\n@media screen and (prefers-color-scheme: dark) {\n" + dark.group(1).replace(
            'body[data-theme="dark"]', 'body:not([data-theme="light"])') + "}\n"
    style.write_text(rules, encoding="utf-8")


def setup(app):
    app.connect("build-finished", mend)
    return {"parallel_read_safe": True}
