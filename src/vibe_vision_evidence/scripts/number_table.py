#!/usr/bin/env python3
"""Makes the table of the tracker's numbers in docs/vision.md from a table of vibe_tracker_numbers.

Prints it as Markdown, or with --update writes it between the marks <!-- bench: numbers --> and <!-- end --> of a page.
"""
import argparse
import csv
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from benchmark_rows import updatePage

NOTICEABLE = 0.005  # change of an error, relative


def effect(row):
    """What a shift moves, in frames more or less than with the defaults."""
    parts = [f'{float(row[key]):+.0f} {name}' for key, name in
             (('tracked', 'tracked'), ('search_found', 'found by a search'), ('wrong', 'wrong'), ('phantom', 'phantom'),
              ('doubted', 'doubted')) if float(row[key])]
    if abs(float(row['error'])) >= NOTICEABLE:
        parts.append(f"error {100 * float(row['error']):+.0f} % ({row['error_where']})")
    return ', '.join(parts) or '–'


def line(*cells):
    return '| ' + ' | '.join(cells) + ' |'


def table(rows):
    """Without a factor, rows only say what the numbers are."""
    factors = list(dict.fromkeys(row['factor'] for row in rows if row['factor']))
    lines = [line('number', 'default', 'what it is', 'why', *(f'× {factor}' for factor in factors)),
             '|---' * (4 + len(factors)) + '|']
    section = None
    for name in dict.fromkeys(row['number'] for row in rows):
        own = [row for row in rows if row['number'] == name]
        row = own[0]
        if row['section'] != section:
            section = row['section']
            lines.append(line(f'**{section}**', *[''] * (3 + len(factors))))
        default = f"{row['default']} {row['unit']}".strip()
        lines.append(line(f'`{name}`', default, row['meaning'], row['reason'], *(effect(row) for row in own if row['factor'])))
    return '\n'.join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('table', help='CSV of vibe_tracker_numbers')
    parser.add_argument('--update', metavar='PAGE', help='Markdown file to write the table into')
    arguments = parser.parse_args()
    with open(arguments.table, newline='', encoding='utf-8') as file:
        text = table(list(csv.DictReader(file)))
    if not arguments.update:
        print(text)
        return
    updatePage(arguments.update, {'numbers': text})


if __name__ == '__main__':
    main()
