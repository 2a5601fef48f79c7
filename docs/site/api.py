"""Pages of the C++ interface, one for every folder of public headers, from the XML of Doxygen; and what the headers lack:
symbols without a comment, numbers without a unit."""

import re
import xml.etree.ElementTree as ElementTree

SPECIAL = str.maketrans({mark: "\\" + mark for mark in "\\`*_{}[]<>|$#~"})

# Of each package: public symbols without a comment, and public numbers whose comment names no unit, range or frame. The
# counts may only fall; lower them here when they have.
LACKING = {
    "vibe_core": (437, 117), "vibe_firmware": (88, 9), "vibe_graphics": (161, 35), "vibe_hardware": (252, 56),
    "vibe_ros_utils": (4, 0), "vibe_rviz_plugins": (60, 14), "vibe_testing": (29, 3), "vibe_vision": (153, 60),
}  # fmt: skip
SHOWN = ("vibe_core", "vibe_hardware", "vibe_vision", "vibe_firmware", "vibe_graphics", "vibe_rviz_plugins", "vibe_ros_utils")
NUMBER = re.compile(r"\b(double|float)\b|Eigen|Vector")
UNIT = re.compile(r"\[|\bunit\b|\bshare\b|\bpart of\b|\b0 to \d|up to 1\b|quaternion|coefficient", re.IGNORECASE)


# --- descriptions in Markdown

def inline(node):
    """Text of a node; code in backquotes."""
    if node.tag == "computeroutput":
        return "`" + "".join(node.itertext()) + "`"
    text = (node.text or "").translate(SPECIAL)
    for child in node:
        if child.tag not in ("parameterlist", "simplesect", "itemizedlist", "verbatim", "programlisting"):
            text += inline(child)
        text += (child.tail or "").translate(SPECIAL)
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


def member_lines(members):
    """Numbers and other data as a table, what has a longer text as items."""
    data = [member for member in members if member.get("kind") == "variable"]
    if data:
        yield "| member | meaning |\n|---|---|\n" + "\n".join(
            "| {} | {} |".format(code(declaration(member)).replace("|", "\\|"), described(member).replace("\n", " "))
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

def words_of(member):
    parts = (member.find(name) for name in ("briefdescription", "detaileddescription", "inbodydescription"))
    return "".join("".join(part.itertext()) for part in parts if part is not None).strip()


def public_members(xml):
    """(package, member) of every public member, once."""
    seen = set()
    for file in sorted(xml.glob("*.xml")):
        for member in ElementTree.parse(file).getroot().iter("memberdef"):
            location = member.find("location")
            found = re.search(r"src/(\w+)/include/", location.get("file") if location is not None else "")
            if found and member.get("prot") == "public" and member.get("id") not in seen:
                seen.add(member.get("id"))
                yield found.group(1), member


def lacking(xml):
    """{package: [symbols, without a comment, numbers without a unit]}"""
    counts = {}
    for package, member in public_members(xml):
        count = counts.setdefault(package, [0, 0, 0])
        words, kind = words_of(member), "".join(member.find("type").itertext()) if member.find("type") is not None else ""
        count[0] += 1
        count[1] += not words
        count[2] += member.get("kind") == "variable" and bool(NUMBER.search(kind)) and not UNIT.search(words)
    return counts


def problems(xml):
    """One sentence for each package whose headers lack more than before."""
    for package, (_, silent, unitless) in lacking(xml).items():
        most = LACKING.get(package, (0, 0))
        if silent > most[0]:
            yield "{}: {} public symbols have no comment, {} before; write one for what is new".format(package, silent, most[0])
        if unitless > most[1]:
            yield "{}: {} public numbers have no unit, {} before; write it in brackets".format(package, unitless, most[1])


def pages(root, xml):
    parts, counts = Headers(xml).parts, lacking(xml)
    lines = ["# C++\n", "The public headers, one page for each folder. The libraries need no ROS.\n"]
    for package in SHOWN:
        for folder, headers in folders(root, package).items():
            name = "reference/cpp/{}.md".format(folder.replace("/", "_"))
            yield name, page_of(folder, headers, parts)
            lines.append("* [{}](cpp/{})".format(folder, name.rsplit("/", 1)[-1]))
    lines += ["\n## What is not documented yet\n", "| package | public symbols | without a comment | numbers whose comment "
              "names no unit |\n|---|---|---|---|"]
    lines += ["| {} | {} | {} | {} |".format(package, *counts[package]) for package in sorted(counts)]
    yield "reference/cpp.md", "\n".join(lines) + "\n\n```{toctree}\n:hidden:\n:glob:\ncpp/*\n```\n"
