"""Reads the table of vibe_vision_bench, and writes tables into pages."""
import csv
import math
import re

from vibe_sessions.whole_file import open_whole


def readRows(path):
    """One dictionary per cell and method: scene and method as text, the rest as numbers, NaN where nothing is."""
    rows = []
    with open(path, newline='') as file:
        for row in csv.DictReader(file):
            rows.append({key: text if key in ('scene', 'method') else number(text) for key, text in row.items()})
    return rows


def number(text):
    try:
        return float(text)
    except ValueError:
        return math.nan


def isStandard(row):
    """Markers of 40 px with the exposure and the sensor of the scene."""
    return row['marker_px'] == 40 and row['exposure_s'] == 0 and row['width'] == 0


def updatePage(path, tables):
    """Writes between the marks <!-- bench: NAME --> and <!-- end -->. `tables`: {NAME: text}."""
    with open(path, encoding='utf-8') as file:
        page = file.read()
    for name, text in tables.items():
        page, count = re.subn(rf'(<!-- bench: {name} -->\n).*?(<!-- end -->)',
                              lambda m, text=text: f'{m[1]}{text}\n{m[2]}', page, flags=re.DOTALL)
        if count != 1:
            raise SystemExit(f"'{path}' has {count} places '<!-- bench: {name} -->'; it needs exactly one.")
    with open_whole(path) as file:
        file.write(page)
