#!/usr/bin/env python3
"""Draws error against processor time and error against motion blur, from the table of vibe_vision_bench.

Reads what `rosrun vibe_vision_evidence vibe_vision_bench --csv FILE` writes; makes vision_error_time.png and
vision_error_blur.png.
"""
import argparse
import math
import os
import sys

import matplotlib

matplotlib.use('Agg')
import matplotlib.pyplot as plt
from matplotlib.ticker import FuncFormatter

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from benchmark_rows import isStandard, readRows

METHODS = {  # name: (label, colour, marker)
    'ring': ('ring (vibe_vision)', '#1b6ca8', 'o'),
    'sleeve': ('sleeve (vibe_vision)', '#2b7a3d', 's'),
    'centroid': ('grey centroid of the ring', '#8a8a8a', '^'),
    'aruco': ('ArUco 4x4, sub-pixel corners', '#c23b22', 'D'),
    'apriltag': ('AprilTag 36h11', '#d98c1f', 'v'),
}
SCENES = {'static': 'at rest', 'moving': '0.5 m/s, 1 ms exposure', 'all': 'all degradations at once'}
LIMIT = {'static': None, 'moving': 0.01, 'all': 0.1}  # to reach [px]
PIXELS_PER_METRE = 1e4
PEAK = 0.5  # speed [m/s]
PLAIN = FuncFormatter(lambda value, _: f'{value:g}')


def legendOf(panels):
    """Each label once, in the order of METHODS."""
    found = {}
    for panel in panels:
        for handle, label in zip(*panel.get_legend_handles_labels()):
            found.setdefault(label, handle)
    order = [label for label, _, _ in METHODS.values() if label in found]
    order += [label for label in found if label not in order]
    return [found[label] for label in order], order


def drawTimes(axes, rows, scene, name):
    """One point per method: median time of a frame to track (full symbol) and to search (hollow)."""
    for method, (label, colour, marker) in METHODS.items():
        for row in rows:
            if row['scene'] != scene or row['method'] != method or not isStandard(row) or math.isnan(row['rms_px']):
                continue
            track, search = 1e3 * row['track_median_s'], 1e3 * row['search_median_s']
            axes.plot([track, search], [row['rms_px']] * 2, color=colour, linewidth=0.8, alpha=0.6)
            axes.plot(track, row['rms_px'], marker, color=colour, markersize=8, label=label)
            axes.plot(search, row['rms_px'], marker, color=colour, markersize=8, markerfacecolor='white')
            if row['tracked'] < row['visible']:
                axes.annotate(f"{100 * row['tracked'] / row['visible']:.0f} %", (track, row['rms_px']), xytext=(0, 8),
                              textcoords='offset points', ha='center', fontsize=8, color=colour)
    if LIMIT[scene]:
        axes.axhline(LIMIT[scene], color='black', linestyle=':', linewidth=1)
    axes.set_title(name, fontsize=11)
    axes.set_xlabel('processor time per marker and frame [ms]')
    axes.set_xscale('log')
    axes.set_yscale('log')
    axes.xaxis.set_major_formatter(PLAIN)
    axes.yaxis.set_major_formatter(PLAIN)
    axes.margins(x=0.1, y=0.12)
    axes.grid(alpha=0.3, which='both')


def plotTimes(rows, path):
    figure, panels = plt.subplots(1, len(SCENES), figsize=(13, 4.8), sharey=True)
    for axes, (scene, name) in zip(panels, SCENES.items()):
        drawTimes(axes, rows, scene, name)
    panels[0].set_ylabel('RMS error along the axis [px]')
    handles, labels = legendOf(panels)
    figure.legend(handles, labels, loc='lower center', ncol=len(labels), frameon=False, fontsize=9)
    figure.suptitle('full symbols: tracking; hollow: search without knowledge of the place; per cent: visible markers '
                    'found where not all; dotted: to reach', fontsize=9, y=0.97)
    figure.tight_layout(rect=(0, 0.07, 1, 0.99))
    figure.savefig(path, dpi=120)


def drawBlur(axes, found, rows):
    for method, (label, colour, marker) in METHODS.items():
        points = sorted((1e3 * row['exposure_s'], row) for row in rows if row['method'] == method)
        times = [time for time, _ in points]
        axes.plot(times, [row['rms_px'] for _, row in points], marker + '-', color=colour, label=label)
        found.plot(times, [100 * row['tracked'] / row['visible'] for _, row in points], marker + '-', color=colour)
        if method in ('ring', 'sleeve'):
            axes.plot(times, [row['bound_px'] for _, row in points], '--', color=colour, linewidth=1,
                      label=f'Cramér-Rao bound, {method}')


def plotBlur(rows, path):
    sweep = [row for row in rows if row['scene'] == 'moving' and row['exposure_s'] > 0 and row['method'] in METHODS]
    if not sweep:
        raise SystemExit('The table has no exposures: make it without --quick and --scene.')
    figure, (axes, found) = plt.subplots(1, 2, figsize=(11.5, 5.0))
    drawBlur(axes, found, sweep)
    axes.set_ylabel('RMS error along the axis [px]')
    axes.set_yscale('log')
    axes.yaxis.set_major_formatter(PLAIN)
    found.set_ylabel('visible markers found [%]')
    found.set_ylim(-3, 103)
    for panel in (axes, found):
        panel.set_xscale('log')
        panel.set_xlabel('exposure [ms]')
        panel.xaxis.set_major_formatter(PLAIN)
        panel.grid(alpha=0.3, which='both')
        pixels = panel.secondary_xaxis('top', functions=(lambda ms: ms * 1e-3 * PEAK * PIXELS_PER_METRE,
                                                         lambda px: px / (1e-3 * PEAK * PIXELS_PER_METRE)))
        pixels.xaxis.set_major_formatter(PLAIN)
        pixels.set_xlabel(f'blur at the peak speed of {PEAK:g} m/s [px]')
    handles, labels = legendOf([axes])
    figure.legend(handles, labels, loc='lower center', ncol=4, frameon=False, fontsize=9)
    figure.tight_layout(rect=(0, 0.11, 1, 1))
    figure.savefig(path, dpi=120)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('table', help='CSV of vibe_vision_bench')
    parser.add_argument('folder', help='where to write the pictures')
    arguments = parser.parse_args()
    rows = readRows(arguments.table)
    plotTimes(rows, os.path.join(arguments.folder, 'vision_error_time.png'))
    plotBlur(rows, os.path.join(arguments.folder, 'vision_error_blur.png'))


if __name__ == '__main__':
    main()
