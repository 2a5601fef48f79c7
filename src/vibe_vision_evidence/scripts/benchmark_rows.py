"""Reads the table of vibe_vision_bench."""
import csv
import math


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
