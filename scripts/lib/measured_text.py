"""Words of the tables that scripts/accuracy writes: numbers with few digits, rows, and where a table comes from."""

import datetime
import math
import textwrap

from measured_store import number

WIDTH = 120  # of a line of a page
MANY = 6  # rows of one origin that are not named one by one, where there are other origins
NEGLIGIBLE = 1e-6  # an error as a fraction: what is smaller is not told apart


def digits(value, count=2):
    """A number with so many digits that count: 0.0046, 4.6, 46, 460. Empty where there is none."""
    value = number(value)
    if math.isnan(value):
        return ""
    if value == 0:
        return "0"
    places = count - 1 - math.floor(math.log10(abs(value)))
    rounded = round(value, places)
    return f"{rounded:,.{max(0, count - 1 - math.floor(math.log10(abs(rounded))))}f}"


def whole(value):
    return f"{number(value):,.0f}"


def percent(fraction, count=2):
    value = number(fraction)
    if abs(value) < NEGLIGIBLE:
        return f"below {100 * NEGLIGIBLE:.4f} %"
    return "" if math.isnan(value) else digits(100 * value, count) + " %"


def percents(row, columns):
    return [percent(row.get(column)) for column in columns]


def signed(fraction):
    """A change in percent, with the sign of typography."""
    return f"{100 * fraction:+.1f} %".replace("-", "−")


def span(values, show=digits):
    """The range of some numbers, or the one that all are."""
    least, most = show(min(values)), show(max(values))
    return least if least == most else f"{least} to {most}"


def table(header, rows):
    lines = ["| " + " | ".join(cells) + " |" for cells in (header, *rows)]
    return "\n".join([lines[0], "|" + "---|" * len(header), *lines[1:]])


def code(text):
    return f"```\n{text.rstrip()}\n```"


def sentence(text):
    return textwrap.fill(text, WIDTH, break_on_hyphens=False, break_long_words=False)


def day(date):
    parsed = datetime.date.fromisoformat(date)
    return f"{parsed.day} {parsed:%B %Y}"


def origin(store, section, labelled):
    """The line below a table: when, with which version and on what its rows were measured; [(label, row)]."""
    groups = {}
    for label, row in labelled:
        place = (store.is_old(row), day(row["date"]), row["version"], row["machine"])
        labels, loads = groups.setdefault(place, ({}, []))
        labels[label] = None
        loads += [float(row["load"])] if row["load"] else []
    most = max((labels for labels, _ in groups.values()), key=len, default={})
    parts = []
    for (old, date, version, machine), (labels, loads) in sorted(groups.items(), key=lambda item: item[0][0]):
        load = ", load " + span(loads) if loads else ""
        named = "all others" if labels is most and len(most) > MANY else ", ".join(labels)
        rows = ": " + named if len(groups) > 1 else ""
        parts.append(f"{'**an older version**, ' if old else ''}{date}, version {version}, {machine}{load}{rows}")
    return sentence(f"Measured: {'; '.join(parts)} (`scripts/accuracy --section {section}`).")
