"""Pages of the C++ interface, one for every folder of public headers, from the XML of Doxygen; and what the headers lack:
symbols without a comment, numbers without a unit. Neither may be."""

import re
import xml.etree.ElementTree as ElementTree

SPECIAL = str.maketrans({mark: "\\" + mark for mark in "\\`*_{}[]<>|$#~"})

SHOWN = ("vibe_core", "vibe_hardware", "vibe_vision", "vibe_firmware", "vibe_graphics", "vibe_operator", "vibe_rviz_plugins",
         "vibe_ros_utils")
NUMBER = re.compile(r"^(?!.*function|.*\(\*|.*::\*).*(\b(double|float)\b|Eigen|Vector)")
# A unit in brackets, or words for a number that has none; "0: left, 1: right" is a scale of its own
UNIT = re.compile(r"\[|\bunit\b|\b0 to \d|up to 1\b|\bsum 1\b|(?<!\d)[01]: |\bpart of\b|\bper turn\b|"
                  r"\b((ratio|share|fraction|factor|weight|coefficient|exponent|tangent|quaternion)s?|turns|probability|"
                  r"confidence|opacity|strain|stretch|relative|barycentric|dimensionless)\b",
                  re.IGNORECASE)


# --- descriptions in Markdown

def escaped(text):
    """Text of which Markdown shall read nothing but code in backquotes, as the comments write it."""
    return "".join(part if part.startswith("`") and part.endswith("`") and len(part) > 1 else part.translate(SPECIAL)
                   for part in re.split(r"(`[^`]+`)", text or ""))


def inline(node):
    """Text of a node; code in backquotes."""
    if node.tag == "computeroutput":
        return "`" + "".join(node.itertext()) + "`"
    text = escaped(node.text)
    for child in node:
        if child.tag not in ("parameterlist", "simplesect", "itemizedlist", "verbatim", "programlisting"):
            text += inline(child)
        text += escaped(child.tail)
    return text


def flat(text):
    return re.sub(r"\s+", " ", text).strip()


def blocks(node):
    """Paragraphs and items of a description."""
    if node is None:
        return
    for paragraph in node.iter("para"):
        text = flat(inline(paragraph))
        if text and not any(paragraph in list(holder.iter("para")) for holder in node.iter("parameterlist")) and not any(
                paragraph in list(holder.iter("para")) for holder in node.iter("simplesect")):
            yield text
    for item in node.iter("parameteritem"):
        names = ", ".join("`{}`".format("".join(name.itertext())) for name in item.iter("parametername"))
        yield "* {}: {}".format(names, flat(inline(item.find("parameterdescription"))))
    for section in node.iter("simplesect"):
        yield "* {}: {}".format({"return": "returns", "see": "see"}.get(section.get("kind"), section.get("kind")), flat(inline(section)))


def described(node):
    parts = [part for name in ("briefdescription", "detaileddescription") for part in blocks(node.find(name))]
    return re.sub(r"\n\n(?=\* )", "\n", "\n\n".join(parts))


def code(text):
    return "`" + flat(text).replace("`", "") + "`"


# --- declarations

def text_of(node, name):
    found = node.find(name)
    return "" if found is None else "".join(found.itertext())


def declaration(member):
    kind = member.get("kind")
    if kind == "function":
        return flat("{} {}{}".format(text_of(member, "type"), text_of(member, "name"), text_of(member, "argsstring")))
    if kind == "enum":
        values = (text_of(value, "name") + (" " + text_of(value, "initializer") if value.find("initializer") is not None else "")
                  for value in member.iter("enumvalue"))
        return "enum {} {{ {} }}".format(text_of(member, "name"), ", ".join(values))
    if kind == "typedef":
        return flat(text_of(member, "definition").replace("vibe::", ""))
    initializer = text_of(member, "initializer")
    return flat("{} {}{} {}".format(text_of(member, "type"), text_of(member, "name"), text_of(member, "argsstring"),
                                    initializer if len(initializer) < 40 else ""))


def is_public(member):
    return member.get("prot") in ("public", "protected") and member.get("kind") in ("function", "variable", "enum", "typedef")


def line_of(member):
    location = member.find("location")
    return (location.get("file"), location.get("line")) if location is not None else (None, None)


def described_with_its_line(member, members):
    """Doxygen gives the comment of `double fx, fy;  ///< [px]` to the last one only; it is of all."""
    return described(member) or next((described(other) for other in members
                                      if line_of(other) == line_of(member) and described(other)), "")


def member_lines(members):
    """Numbers and other data as a table, what has a longer text as items."""
    data = [member for member in members if member.get("kind") == "variable"]
    if data:
        yield "| member | meaning |\n|---|---|\n" + "\n".join(
            "| {} | {} |".format(code(declaration(member)).replace("|", "\\|"),
                                 described_with_its_line(member, data).replace("\n", " "))
            for member in data) + "\n"
    for member in members:
        if member.get("kind") != "variable":
            text = described(member).replace("\n", "\n  ")
            values = "".join("\n  * {}: {}".format(code(text_of(value, "name")), described(value).replace("\n", " "))
                             for value in member.iter("enumvalue") if described(value))
            yield "* {}{}{}\n".format(code(declaration(member)), "  \n  " + text if text else "", values)


def members_of(compound):
    return [member for section in compound.iter("sectiondef") for member in section.iter("memberdef") if is_public(member)]


class Headers:
    """What stands in each header: {header: [(heading, text)]}."""

    def __init__(self, xml):
        self.parts = {}
        free = {}
        for file in sorted(xml.glob("*.xml")):
            for compound in ElementTree.parse(file).getroot().iter("compounddef"):
                kind = compound.get("kind")
                if kind in ("struct", "class", "union") and compound.get("prot") != "private":
                    self.add_class(compound, kind)
                elif kind in ("namespace", "file"):
                    for member in members_of(compound):
                        header = self.header(member)
                        if header and member.get("static") != "yes":
                            free.setdefault(header, {})[member.get("id")] = member
        for header, members in free.items():
            self.parts.setdefault(header, []).insert(0, ("", "\n".join(member_lines(list(members.values())))))

    @staticmethod
    def header(node):
        location = node.find("location")
        found = re.search(r"src/\w+/include/(.*)", location.get("file")) if location is not None else None
        return found.group(1) if found else None

    def add_class(self, compound, kind):
        header = self.header(compound)
        if header:
            name = text_of(compound, "compoundname")
            text = described(compound) + "\n\n" + "\n".join(member_lines(members_of(compound)))
            self.parts.setdefault(header, []).append(("{} `{}`".format(kind, name), text))


def folders(root, package):
    """{folder: headers} of the public headers of a package."""
    include = root / "src" / package / "include"
    found = {}
    for header in sorted([*include.rglob("*.hpp"), *include.rglob("*.h")]):
        found.setdefault(header.parent.relative_to(include).as_posix(), []).append(header.relative_to(include).as_posix())
    return found


def page_of(folder, headers, parts):
    lines = ["# {}\n".format(folder)]
    for header in headers:
        lines.append("## {}\n".format(header.rsplit("/", 1)[-1]))
        for heading, text in parts.get(header, []):
            lines += (["### {}\n".format(heading)] if heading else []) + [text + "\n"]
    return "\n".join(lines)


# --- what is lacking

def words_of(node):
    parts = (node.find(name) for name in ("briefdescription", "detaileddescription", "inbodydescription"))
    return "".join("".join(part.itertext()) for part in parts if part is not None).strip()


# What its declaration says completely: destructors, copies, comparisons, overrides (described where they are declared
# first), the members that every container has, and toString().
PLAIN = re.compile(r"^(~.*|operator.*|toString|size|empty|clear|begin|end|back|push_back)$")


def says_all(member):
    text = text_of(member, "argsstring")
    return member.get("kind") == "function" and bool(
        PLAIN.match(text_of(member, "name")) or re.search(r"=\s*(default|delete)|\boverride\b", text))


class Symbol:
    """A public member with the words about it: its name, its own or those of its line, and those of its struct, which may
    name the unit of all."""

    def __init__(self, member, words, around):
        self.member, self.words, self.around = member, words, around

    def silent(self):
        return not self.words and not says_all(self.member)

    def unitless(self):
        is_number = self.member.get("kind") == "variable" and bool(NUMBER.match(text_of(self.member, "type")))
        name = text_of(self.member, "name").replace("_", " ")
        return is_number and not UNIT.search(f"{name} {self.words} {self.around}")


def symbols_of(compound):
    """The public members of a class, namespace or file."""
    members = [member for section in compound.iter("sectiondef") for member in section.iter("memberdef")]
    by_line = {}
    for member in members:
        by_line.setdefault(line_of(member), []).append(words_of(member))
    around = words_of(compound) if compound.get("kind") in ("struct", "class", "union") else ""
    for member in members:
        if re.search(r"src/\w+/include/", line_of(member)[0] or "") and member.get("prot") == "public":
            yield Symbol(member, words_of(member) or "".join(by_line[line_of(member)]), around)


def public_symbols(xml):
    """Every public member, once."""
    seen = set()
    for file in sorted(xml.glob("*.xml")):
        for compound in ElementTree.parse(file).getroot().iter("compounddef"):
            for symbol in symbols_of(compound) if compound.get("prot") != "private" else ():
                if symbol.member.get("id") not in seen:
                    seen.add(symbol.member.get("id"))
                    yield symbol


def problems(xml):
    """One sentence for each symbol that lacks something."""
    for symbol in public_symbols(xml):
        place = "{}:{}: '{}'".format(*line_of(symbol.member), text_of(symbol.member, "name"))
        if symbol.silent():
            yield place + " has no comment; write one"
        if symbol.unitless():
            yield place + " is a number without a unit; write it in brackets, or that it is a ratio"


def pages(root, xml):
    parts = Headers(xml).parts
    lines = ["# C++\n", "The public headers, one page for each folder. The libraries need no ROS.\n"]
    for package in SHOWN:
        for folder, headers in folders(root, package).items():
            name = "reference/cpp/{}.md".format(folder.replace("/", "_"))
            yield name, page_of(folder, headers, parts)
            lines.append("* [{}](cpp/{})".format(folder, name.rsplit("/", 1)[-1]))
    yield "reference/cpp.md", "\n".join(lines) + "\n\n```{toctree}\n:hidden:\n:glob:\ncpp/*\n```\n"
