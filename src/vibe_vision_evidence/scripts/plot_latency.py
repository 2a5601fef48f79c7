#!/usr/bin/env python3
"""Draws where the time between the middle of an exposure and a datagram goes, stage by stage.

Reads a table with one row per frame: a column for each stage [s], named by it, in their order. Columns called frame or
sequence are left out, and so is one called total. Bars reach from the 1st to the 99th percentile.
"""
import argparse
import csv

import matplotlib

matplotlib.use('Agg')
import matplotlib.pyplot as plt

SKIPPED = {'frame', 'sequence', 'frame_sequence', 'total'}
COLOURS = ['#1b6ca8', '#2b7a3d', '#d98c1f', '#c23b22', '#7a4fa3', '#5f6b6d', '#3fa7a0', '#9c6b30']


def readStages(path):
    """{stage: [ms, ...]} in the order of the columns."""
    with open(path, newline='') as file:
        rows = list(csv.DictReader(file))
    if not rows:
        raise SystemExit(f"'{path}' has no rows; record some frames first.")
    return {name: [1e3 * float(row[name]) for row in rows] for name in rows[0] if name not in SKIPPED}


def quantile(values, share):
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(share * len(ordered)))]


def drawStages(axes, stages):
    names = [name.removesuffix('_s').replace('_', ' ') for name in stages]
    for row, (values, colour) in enumerate(zip(stages.values(), COLOURS * len(stages))):
        low, middle, high = (quantile(values, share) for share in (0.01, 0.5, 0.99))
        axes.barh(row, high - low, left=low, height=0.5, color=colour, alpha=0.35)
        axes.plot([middle], [row], 'o', color=colour)
        axes.annotate(f'{middle:.3g} ms', (high, row), xytext=(6, 0), textcoords='offset points', va='center', fontsize=9)
    axes.set_yticks(range(len(names)), names)
    axes.invert_yaxis()
    axes.set_xscale('symlog', linthresh=0.01)
    axes.set_xlim(0, 8 * max(quantile(values, 0.99) for values in stages.values()))
    axes.xaxis.set_major_formatter(lambda value, _: f'{value:g}')
    axes.set_xlabel('time per stage [ms]: median, 1st to 99th percentile')
    axes.grid(alpha=0.3, axis='x')


def drawTotal(axes, stages):
    totals = sorted(map(sum, zip(*stages.values())))
    axes.plot(totals, [100 * (i + 1) / len(totals) for i in range(len(totals))], color='#1b6ca8')
    median = quantile(totals, 0.5)
    axes.axvline(median, color='black', linestyle=':', linewidth=1)
    axes.annotate(f'median {median:.2f} ms', (median, 30), xytext=(8, 0), textcoords='offset points', va='center')
    axes.set_xlim(0, 1.1 * quantile(totals, 0.99))
    axes.set_xlabel('middle of the exposure to datagram [ms]')
    axes.set_ylabel('frames within this time [%]')
    axes.grid(alpha=0.3)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('table', help='CSV with one row per frame')
    parser.add_argument('picture', help='PNG to write')
    arguments = parser.parse_args()
    stages = readStages(arguments.table)
    figure, (left, right) = plt.subplots(1, 2, figsize=(11.5, 1.4 + 0.45 * max(len(stages), 5)),
                                         gridspec_kw={'width_ratios': [3, 2]})
    drawStages(left, stages)
    drawTotal(right, stages)
    figure.tight_layout()
    figure.savefig(arguments.picture, dpi=120)


if __name__ == '__main__':
    main()
