#!/usr/bin/env python3
"""Draws the region of stiffness and damping that the haptic device renders passively.

Reads what `rosrun vibe_firmware vibe_passivity` prints (transmission, kind, damping, stiffness, gain) and writes a PNG.
"""
import argparse
import csv
import sys

import matplotlib

matplotlib.use('Agg')
import matplotlib.pyplot as plt

TITLES = {'capstan': 'capstan, n = 10', 'direct': 'direct drive'}


def readPoints(path):
    """{transmission: {kind: [(damping, stiffness, gain), ...]}}"""
    points = {}
    with open(path, newline='') if path != '-' else sys.stdin as file:
        for row in csv.DictReader(file):
            kinds = points.setdefault(row['transmission'], {})
            values = float(row['damping']), float(row['stiffness']), float(row['gain'])
            kinds.setdefault(row['kind'], []).append(values)
    return points


def drawTransmission(axes, name, kinds):
    """Damping in mN m s/rad and stiffness in mN m/rad."""
    line = {kind: ([1e3 * p[0] for p in kinds[kind]], [1e3 * p[1] for p in kinds[kind]]) for kind in ('limit', 'accepted')}
    axes.fill_between(*line['accepted'], color='#dbe9f6', label='accepted (safety factor 1.25, delay 0.05 ms)')
    axes.plot(*line['limit'], color='black', linewidth=1.2, label='limit of the conditions (factor 1, no delay)')
    for active, colour, marker, label in ((False, '#2b7a3d', 'o', 'search: no hand gains energy'),
                                          (True, '#c23b22', 'x', 'search: a hand gains energy')):
        found = [p for p in kinds['search'] if (p[2] > 0) == active]
        axes.scatter([1e3 * p[0] for p in found], [1e3 * p[1] for p in found], s=16, c=colour, marker=marker,
                     linewidths=1.1, label=label, zorder=3, clip_on=False)
    axes.set_title(TITLES.get(name, name))
    axes.set_xlabel('damping B [mN m s/rad]')
    axes.set_ylabel('stiffness K [mN m/rad]')
    axes.set_xlim(left=0)
    axes.set_ylim(bottom=0)
    axes.grid(alpha=0.3)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('points', help="output of vibe_passivity; '-': standard input")
    parser.add_argument('picture', help='PNG to write')
    arguments = parser.parse_args()
    points = readPoints(arguments.points)
    figure, panels = plt.subplots(1, len(points), figsize=(5.2 * len(points), 4.6), squeeze=False)
    for axes, (name, kinds) in zip(panels[0], points.items()):
        drawTransmission(axes, name, kinds)
    handles, labels = panels[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc='lower center', ncol=2, frameon=False, fontsize=9)
    figure.tight_layout(rect=(0, 0.11, 1, 1))
    figure.savefig(arguments.picture, dpi=120)


if __name__ == '__main__':
    main()
