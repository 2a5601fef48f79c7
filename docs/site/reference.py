"""Pages of reference that are made from the sources: messages and services, keys of scenes, events, measures, command
lines, parameters of nodes, the Python module. pages(root) gives (name, Markdown) of each."""

import ast
import json
import os
import re
import subprocess

CELL = str.maketrans({"|": "\\|", "<": "&lt;", ">": "&gt;", "*": "\\*", "_": "\\_", "[": "\\[", "]": "\\]", "\n": " "})


def cell(text):
    """A sentence of a source as the cell of a table."""
    return text.strip().translate(CELL)


def table(columns, rows):
    lines = ["| " + " | ".join(columns) + " |", "|" + "---|" * len(columns)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


# --- messages and services

FIELD = re.compile(r"(?P<type>[\w/]+(?:\[\d*\])?)\s+(?P<name>\w+)(?:\s*=\s*(?P<value>[^#]*?))?\s*(?:#\s*(?P<words>.*))?$")


def message_part(text):
    """Introduction and rows of one part of a definition: a comment above fields is that of the first one below it."""
    introduction, rows, words = None, [], []
    for line in text.splitlines():
        line = line.strip()
        found = FIELD.match(line)
        if line.startswith("#"):
            words.append(line.lstrip("# ").rstrip())
        elif found:
            name = "`{}`".format(found["name"]) + (" = {}".format(found["value"].strip()) if found["value"] else "")
            rows.append((name, "`{}`".format(found["type"]), cell(" ".join([*words, found["words"] or ""]))))
            words = []
        elif not line and words and not rows and introduction is None:
            introduction, words = " ".join(words), []
    return introduction or " ".join(words), rows


def definition(file):
    parts = file.read_text(encoding="utf-8").split("\n---\n")
    lines = ["## {}\n".format(file.stem)]
    for title, part in zip(("Request", "Response") if len(parts) > 1 else ("",), parts):
        introduction, rows = message_part(part)
        lines += [introduction.translate(CELL) + "\n"] if introduction else []
        lines += ["**{}**\n".format(title)] if title else []
        lines += [table(("field", "type", "meaning"), rows)] if rows else ["No fields.\n"]
    return "\n".join(lines)


def messages(root):
    folder = root / "src/vibe_msgs"
    lines = ["# Messages and services\n", "The definitions of package `vibe_msgs`, in SI units. Which topic has which "
             "type: [Interfaces](../docs/interfaces.md#published-topics).\n"]
    for file in [*sorted(folder.glob("msg/*.msg")), *sorted(folder.glob("srv/*.srv"))]:
        lines.append(definition(file))
    return "\n".join(lines)


# --- scenes

def scene_keys(root):
    page = (root / "docs/scenes.md").read_text(encoding="utf-8")
    schema = page[page.index("<!-- schema: begin -->"):page.index("<!-- schema: end -->")]
    rows, section = [], ""
    for line in schema.splitlines():
        if line.startswith("#"):
            section = line.lstrip("# ").strip("`")
        found = re.match(r"\| `([^`]+)` \| ([^|]*) \| ([^|]*) \| ([^|]*) \| ((?:[^|]|\\\|)*?) \|", line)
        if found:
            prefix = "" if section == "Top level" else section + "."
            anchor = re.sub(r"[^\w\- ]", "", section.lower()).replace(" ", "-")
            rows.append(("[`{}{}`](../docs/scenes.md#{})".format(prefix, found[1], anchor), *(part.strip() for part in found.groups()[1:])))
    return "\n".join(["# Keys of scene files\n", "All keys in the order of their names. Sources of the defaults and how "
                      "to write a scene: [Scene files](../docs/scenes.md).\n",
                      table(("key", "unit", "default", "range", "meaning"), sorted(rows))])


# --- events and measures

def strings_of(text):
    """The rows {..., "a" "b", "c"} of a table in C++: identifiers and strings of each."""
    for row in re.findall(r"\{((?:Kind|Reason)::(?:[^{}\"]|\"(?:\\.|[^\"\\])*\")*)\}", text):
        joined = re.sub(r'"\s*\n?\s*"', "", row)
        yield re.match(r"\w+::(\w+)", row)[1], re.findall(r'"((?:\\.|[^"\\])*)"', joined)


def events(root):
    text = (root / "src/vibe_core/src/events/event_table.cpp").read_text(encoding="utf-8")
    kinds, reasons = text.split("reasonRows()", 1)
    definition_of = (root / "src/vibe_msgs/msg/ProcedureEvent.msg").read_text(encoding="utf-8")
    numbers = {name.replace("_", "").lower(): value for name, value in re.findall(r"^uint8 (\w+) = (\d+)", definition_of, re.M)}
    rows = [(numbers.get(kind.lower(), ""), cell(words[0]), cell(words[1]), cell(words[2]))
            for kind, words in strings_of(kinds) if len(words) == 3]
    refused = [(cell(words[0]), cell(words[1])) for _, words in strings_of(reasons) if len(words) == 2]
    return "\n".join([
        "# Events\n", "Kinds of events on `procedure/events`, with the number in `vibe_msgs/ProcedureEvent`, the unit of "
        "`value`, and the sentence in `text`; words in braces are filled in. When each happens: "
        "[Interfaces](../docs/interfaces.md#events).\n", table(("number", "kind", "unit", "sentence"), rows),
        "## Reasons to reject a command\n", table(("reason", "sentence"), refused)])


def measures(root):
    program = root / "devel/lib/vibe_core/vibe_headless"
    listed = json.loads(subprocess.run([program, "--list-measures"], check=True, capture_output=True, text=True).stdout
                        if program.exists() else "{}")
    return "\n".join(["# Measures by name\n", "What `vibe_headless --list-measures` prints: the names in reports, cohorts, "
                      "regressions and `vibe_msgs/SkillMetrics`. Definitions and sources: [Measures](../docs/metrics.md).\n",
                      table(("measure", "unit"), measure_rows(listed))])


def measure_rows(listed):
    rows = listed.get("measures", listed)
    if isinstance(rows, dict):
        return [("`{}`".format(name), value.get("unit", "") if isinstance(value, dict) else "") for name, value in rows.items()]
    return [("`{}`".format(row["name"]), row["unit"]) for row in rows]


# --- command lines

def programs(root):
    """(heading, command) of everything that has --help and needs no graph."""
    for script in sorted((root / "scripts").iterdir()):
        if script.is_file() and os.access(script, os.X_OK):
            yield "scripts/" + script.name, script
    for source in sorted((root / "src").glob("*/programs/*")):
        name = re.sub(r"(_main)?\.cpp$", "", source.name)
        if source.suffix == ".cpp":
            yield "rosrun {} {}".format(source.parts[-3], name), root / "devel/lib" / source.parts[-3] / name


def command_lines(root):
    lines = ["# Command lines\n", "What `--help` prints.\n"]
    setup, missing = root / "devel/setup.bash", []
    for heading, program in programs(root):
        if not program.exists():
            missing.append("`{}`".format(heading))
            continue
        command = 'set +u; [ ! -f "$1" ] || . "$1"; exec "$2" --help'
        said = subprocess.run(["bash", "-c", command, "-", setup, program], capture_output=True, text=True, timeout=120,
                              env={**os.environ, "COLUMNS": "100"})
        if said.returncode == 0 and said.stdout.strip():
            text = said.stdout.replace(str(root) + "/", "")
            lines.append("## `{}`\n\n```none\n{}\n```\n".format(heading, text.rstrip()))
    if missing:
        lines.append("Not built when this page was made: {}.\n".format(", ".join(missing)))
    return "\n".join(lines)


# --- nodes

# The tables of parameters: of a section that is called after its node, or of the page of one node.
PARAMETER_PAGES = {"interfaces": None, "web": "web_node", "endoscope_camera": "endoscope_camera", "latency": "latency_probe"}
PARAMETER_TABLE = re.compile(r"^\| parameter \| default \|( range \|)? meaning \|\n\|[-|]*\n(?P<rows>(?:\|.*\n)+)", re.M)


def parameter_rows(name, page, node):
    """(parameter, node, default, range, meaning) of the tables of a page."""
    for section in re.split(r"^## ", page, flags=re.M):
        heading = section.partition("\n")[0]
        anchor = re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
        for found in PARAMETER_TABLE.finditer(section):
            for row in found["rows"].splitlines():
                parameter, default, *between, meaning = (part.strip() for part in re.split(r"(?<!\\)\|", row)[1:-1])
                meaning = re.sub(r"\]\((?=#)", "]({}.md".format(name), meaning)
                yield (parameter, "[{}](../docs/{}.md#{})".format(cell(node or heading), name, anchor), default, "".join(between),
                       re.sub(r"\]\((?!\w+:)", "](../docs/", meaning))


def parameters(root):
    rows = [row for name, node in PARAMETER_PAGES.items()
            for row in parameter_rows(name, (root / "docs/{}.md".format(name)).read_text(encoding="utf-8"), node)]
    return "\n".join(["# Parameters of nodes\n", "All private parameters, in the order of their names. An unknown or invalid "
                      "one ends a node with status 2.\n", table(("parameter", "node", "default", "range", "meaning"), sorted(rows))])


# --- Python

def python_module(root):
    stubs = root / "devel/lib/python3/dist-packages/vibe/_core.pyi"
    tree = ast.parse(stubs.read_text(encoding="utf-8") if stubs.exists() else "")
    lines = ["# Python module `vibe`\n", "Signatures and docstrings of the module, from its stubs. How to use it: "
             "[Python](../docs/python.md).\n"]
    for item in tree.body:
        if isinstance(item, ast.ClassDef):
            lines += class_lines(item)
        elif isinstance(item, ast.FunctionDef):
            lines += ["## `{}`\n".format(signature(item)), (ast.get_docstring(item) or "").translate(CELL) + "\n"]
    return "\n".join(lines)


def signature(function):
    return "{}({})".format(function.name, ast.unparse(function.args).replace("self, ", "").replace("self", "")) + (
        " -> " + ast.unparse(function.returns) if function.returns else "")


def class_lines(item):
    yield "## class `{}`\n".format(item.name)
    yield (ast.get_docstring(item) or "").translate(CELL) + "\n"
    rows = []
    for member in item.body:
        if isinstance(member, ast.FunctionDef):
            is_property = any(isinstance(word, ast.Name) and word.id == "property" for word in member.decorator_list)
            shown = "{}: {}".format(member.name, ast.unparse(member.returns)) if is_property else signature(member)
            rows.append(("`{}`".format(shown), cell(ast.get_docstring(member) or "")))
    if rows:
        yield table(("member", "meaning"), rows)


def empty(text):
    """Whether a page lists nothing, or one of its tables has no row."""
    return not re.search(r"^(\||## )", text, re.M) or bool(re.search(r"^\|[-|]+\n(?!\|)", text, re.M))


def pages(root):
    for name, make in (("messages", messages), ("scene_keys", scene_keys), ("events", events), ("measures", measures),
                       ("command_lines", command_lines), ("parameters", parameters), ("python_module", python_module)):
        yield "reference/{}.md".format(name), make(root)
