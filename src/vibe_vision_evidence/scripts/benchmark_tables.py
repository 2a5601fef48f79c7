#!/usr/bin/env python3
"""Makes the tables of docs/vision.md from the table of vibe_vision_bench.

Prints them as Markdown, or with --update writes them between the marks <!-- bench: NAME --> and <!-- end --> of a page. A
dash is what was not run or cannot be measured.
"""
import argparse
import math
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from benchmark_rows import readRows, updatePage

SCENES = {
    'static': 'at rest', 'moving': 'moving, 1 ms exposure', 'long_exposure': '4 ms exposure', 'defocus': 'defocus',
    'light': 'flicker, drift, vignetting, lens', 'highlights': 'highlights', 'occluder': 'occluder',
    'look_alike': 'look-alike', 'all': 'all of these at once', 'tilt': 'tilt and slant of 15°', 'scale': 'scale ±10 %'}
METHODS = {'ring': 'ring', 'sleeve': 'sleeve', 'centroid': 'centroid', 'aruco': 'ArUco', 'apriltag': 'AprilTag'}
OWN = ('ring', 'sleeve')
MISSING = '–'  # was not run, or cannot be measured


class Table:
    """Rows of the benchmark by what they measure."""

    def __init__(self, rows):
        self.rows = rows

    def find(self, method, scene, marker=40, exposure=0, width=0):
        for row in self.rows:
            if (row['method'], row['scene'], row['marker_px'], row['width']) == (method, scene, marker, width) and \
                    abs(row['exposure_s'] - exposure) < 1e-9:
                return row
        return None


def number(value, digits):
    return MISSING if value is None or math.isnan(value) else f'{value:.{digits}f}'


def share(part, whole):
    if not whole > 0:
        return MISSING
    percent = 100 * part / whole
    return '100' if part == whole else f'{min(percent, 99.9):.1f}'


def markdown(header, rows):
    lines = ['| ' + ' | '.join(header) + ' |', '|' + '---|' * len(header)]
    return '\n'.join(lines + ['| ' + ' | '.join(row) + ' |' for row in rows])


def cells(table, scene, text):
    return [text(row) if row else MISSING for row in (table.find(method, scene) for method in METHODS)]


def withBound(row):
    error = number(row['rms_px'], 4)
    return f"{error} ({number(row['bound_ratio'], 1)})" if error != MISSING else error


def errorTable(table):
    rows = []
    for scene, name in SCENES.items():
        sleeve = table.find('sleeve', scene)
        rows.append([name] + cells(table, scene, withBound) + [number(sleeve and sleeve['rotation_rms_deg'], 2)])
    return markdown(['scene'] + list(METHODS.values()) + ['rotation [°]'], rows)


def foundTable(table):
    def text(row):
        found = share(row['tracked'], row['visible'])
        bad = [f"{row['wrong']:.0f} wrong" if row['wrong'] > 0 else '', f"{row['phantom']:.0f} phantom" if row['phantom'] > 0 else '']
        return ', '.join(part for part in [found] + bad if part)
    return markdown(['scene'] + list(METHODS.values()), [[name] + cells(table, scene, text) for scene, name in SCENES.items()])


def consistencyTable(table):
    def text(row):
        if math.isnan(row['nees']):
            return MISSING
        inside = row['nees_low'] <= row['nees'] <= row['nees_high']
        return f"{row['nees']:.2f} {'in' if inside else 'outside'} [{row['nees_low']:.2f}, {row['nees_high']:.2f}]"
    rows = []
    for scene, name in SCENES.items():
        own = [table.find(method, scene) for method in OWN]
        lead = [number(row and 1e3 * row['lead_rms_m'], 3) for row in own]
        rows.append([name] + [text(row) if row else MISSING for row in own] + lead)
    return markdown(['scene', 'NEES of the ring', 'NEES of the sleeve', 'ring at 14 ms [mm]', 'sleeve at 14 ms [mm]'], rows)


def timeTable(table):
    def times(row, kind):
        if not row:
            return MISSING
        return f"{number(1e3 * row[kind + '_min_s'], 3)} / {number(1e3 * row[kind + '_median_s'], 3)}"
    rows = []
    for method, name in dict(METHODS, both='ring and sleeve in one tracker').items():
        columns = [(table.find(method, 'moving'), kind) for kind in ('track', 'search')]
        columns += [(table.find(method, 'all'), kind) for kind in ('track', 'search')]
        columns += [(table.find(method, 'moving', width=1936), kind) for kind in ('track', 'search')]
        rows.append([name] + [times(row, kind) for row, kind in columns])
    return markdown(['[ms], least / median', 'moving: track', 'search', 'all at once: track', 'search',
                     '1936 x 1216: track', 'search'], rows)


def sizeTable(table):
    def text(row):
        found = share(row['tracked'], row['visible'])
        return withBound(row) + ('' if found == '100' else f', {found} % found')
    rows = []
    for scene in ('static', 'moving'):
        for marker in (16, 24, 32, 40, 64):
            found = [table.find(method, scene, marker=marker) for method in METHODS]
            if not any(found):
                continue
            rows.append([f'{SCENES[scene]}, {marker} px'] + [text(row) if row else MISSING for row in found])
    return markdown(['size'] + list(METHODS.values()), rows)


def worst(rows, key):
    values = [row[key] for row in rows if row and not math.isnan(row[key])]
    return max(values) if values else math.nan


def goalTable(table):
    """What was to be reached, and the worse of the two instruments."""
    own = {scene: [row for row in (table.find(method, scene) for method in OWN) if row] for scene in SCENES}
    both = {scene: table.find('both', scene) for scene in SCENES}
    every = [row for rows in own.values() for row in rows]
    found = min((row['tracked'] / row['visible'] for row in own['all']), default=math.nan)
    wrong = max((row['wrong'] / max(row['reports'], 1) for row in every), default=math.nan)
    phantom = sum(row['phantom'] for row in every)
    inside = sum(row['nees_low'] <= row['nees'] <= row['nees_high'] for row in every)
    goals = [
        ('slide error at rest', '≤ 1.2 times the bound', worst(own['static'], 'bound_ratio'), 1.2, '{:.2f} times'),
        ('slide error moving, 1 ms exposure', '≤ 0.01 px', worst(own['moving'], 'rms_px'), 0.01, '{:.4f} px'),
        ('rotation of the rod', '≤ 0.3°', worst(own['moving'], 'rotation_rms_deg'), 0.3, '{:.2f}°'),
        ('all degradations: visible frames tracked', '≥ 99 %', -100 * found, -99, '{:.1f} %'),
        ('all degradations: slide error', '≤ 0.1 px', worst(own['all'], 'rms_px'), 0.1, '{:.3f} px'),
        ('wrong by more than 0.5 mm, worst scene', '< 0.1 %', 100 * wrong, 0.0999, '{:.2f} %'),
        ('reports of hidden markers, all scenes', 'none', phantom, 0, '{:.0f}'),
        ('tilt and slant of 15°: slide error', '≤ 0.02 px', worst(own['tilt'], 'rms_px'), 0.02, '{:.4f} px'),
        ('tilt and slant of 15°: rotation', '≤ 0.6°', worst(own['tilt'], 'rotation_rms_deg'), 0.6, '{:.2f}°'),
        ('scale ±10 %: slide error', '≤ 0.02 px', worst(own['scale'], 'rms_px'), 0.02, '{:.4f} px'),
        ('tracking both, moving, median', '≤ 0.1 ms', 1e3 * worst([both['moving']], 'track_median_s'), 0.1, '{:.3f} ms'),
        ('search for both, moving, median', '≤ 1 ms', 1e3 * worst([both['moving']], 'search_median_s'), 1, '{:.2f} ms'),
        ('slide predicted 14 ms ahead, moving', '≤ 0.05 mm', 1e3 * worst(own['moving'], 'lead_rms_m'), 0.05, '{:.3f} mm'),
        ('NEES within its 95 % band', 'all scenes', -inside, -len(every), f'{{:.0f}} of {len(every)}'),
    ]
    rows = []
    for name, goal, value, limit, text in goals:
        measured = [MISSING, MISSING] if math.isnan(value) else [text.format(abs(value)), 'yes' if value <= limit else 'no']
        rows.append([name, goal] + measured)
    return markdown(['', 'goal', 'measured', 'reached'], rows)


TABLES = {'goals': goalTable, 'errors': errorTable, 'found': foundTable, 'consistency': consistencyTable,
          'times': timeTable, 'sizes': sizeTable}


def processor():
    try:
        with open('/proc/cpuinfo') as file:
            return next(line.split(':', 1)[1].strip() for line in file if line.startswith('model name'))
    except (OSError, StopIteration):
        return 'unknown processor'


def conditions(rows, machine):
    frames = max(row['frames'] for row in rows if not math.isnan(row['frames']))
    return f'Measured on: {machine}; {frames:.0f} frames per scene, over all seeds.'


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('table', help='CSV of vibe_vision_bench')
    parser.add_argument('--update', metavar='PAGE', help='Markdown file to write the tables into')
    parser.add_argument('--machine', default=processor(), help="what to say of the machine (default: the processor's name)")
    arguments = parser.parse_args()
    table = Table(readRows(arguments.table))
    texts = {name: make(table) for name, make in TABLES.items()}
    texts['conditions'] = conditions(table.rows, arguments.machine)
    if not arguments.update:
        print('\n\n'.join(texts.values()))
        return
    updatePage(arguments.update, texts)


if __name__ == '__main__':
    main()
