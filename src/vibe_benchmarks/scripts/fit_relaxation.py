#!/usr/bin/env python3
"""Fits tissue.relaxation of a scene to a curve of stress relaxation.

usage: fit_relaxation.py [--terms N] [CURVE.csv]
CURVE.csv: a line per point of a test with a strain that is held: time [s], share of the peak stress. Without a file the
curve is that of Yang 2006 (doi 10.1115/1.2372473), porcine oesophagus: by 20 to 30 % lower after 10 s, stable at about
50 % at 300 s. Its figures in between are not available: they are those of Fung's reduced relaxation function, whose
spectrum 1/tau from tau1 to tau2 is between these points. Stable at 300 s: tau2 is 100 s, so that 2 % of the stress is to
go. N is 2 by default. Prints the section, and the error as a share of the peak stress.
"""
import argparse
import itertools

import numpy as np

KNOWN = {10: 0.75, 300: 0.50}  # share of the peak stress by time [s]
LONGEST = 100  # tau2 [s]
GRID = 40  # times that are tried, evenly in their logarithm


def fung(times, weight, shortest):
    """[1 + C int exp(-t/tau)/tau dtau] / [1 + C ln(tau2/tau1)]: Fung 1993, Biomechanics, section 7.6."""
    log_tau = np.linspace(np.log(shortest), np.log(LONGEST), 400)
    decay = np.exp(-np.outer(np.atleast_1d(times), np.exp(-log_tau)))
    middle = (decay[:, 1:] + decay[:, :-1]) / 2
    span = log_tau[-1] - log_tau[0]
    return (1 + weight * middle.mean(axis=1) * span) / (1 + weight * span)


def published():
    """The curve through the known points, from 0.3 to 300 s."""
    grid = [(np.abs(fung(list(KNOWN), c, t) - list(KNOWN.values())).max(), c, t)
            for c in np.geomspace(0.02, 2, 120) for t in np.geomspace(0.01, 50, 120)]
    _, weight, shortest = min(grid)
    times = np.geomspace(0.3, 300, 61)
    print(f"# Fung: C {weight:.3g}, tau1 {shortest:.2g} s, tau2 {LONGEST} s; at 10 and 300 s "
          + " and ".join(f"{v:.3f}" for v in fung(list(KNOWN), weight, shortest)))
    return times, fung(times, weight, shortest)


def fit(times, share, terms):
    """Ratios and times of the series of the least mean square error, over all choices of times from the grid."""
    best = (np.inf, None, None)
    for taus in itertools.combinations(np.geomspace(times.min(), times.max(), GRID), terms):
        columns = 1 - np.exp(-np.outer(times, 1 / np.array(taus)))
        ratios = np.linalg.lstsq(columns, 1 - share, rcond=None)[0]
        error = np.square(columns @ ratios - (1 - share)).mean()
        if (ratios > 5e-4).all() and ratios.sum() < 1 and error < best[0]:
            best = error, ratios, np.array(taus)
    return best[1:]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("curve", nargs="?")
    parser.add_argument("--terms", type=int, default=2, choices=(1, 2, 3))
    arguments = parser.parse_args()
    try:
        times, share = np.loadtxt(arguments.curve, delimiter=",", ndmin=2).T if arguments.curve else published()
    except (OSError, ValueError) as error:
        parser.error(f"{arguments.curve} cannot be read ({error}); give lines of two numbers, time [s] and share, without a heading")
    times, share = times[times > 0], share[times > 0]  # at 0 it is 1 by definition
    if len(times) < 2 * arguments.terms or not np.isfinite([times, share]).all():
        parser.error(f"{arguments.curve} has {len(times)} points after time 0; give at least {2 * arguments.terms}, all of them numbers")
    ratios, taus = fit(times, share, arguments.terms)
    if ratios is None:
        parser.error("no series of this many terms with ratios above 0 fits the curve; try fewer --terms")
    ratios, taus = np.round(ratios, 3), np.array([float(f"{tau:.2g}") for tau in taus])

    def series(at):
        return 1 - (1 - np.exp(-np.outer(at, 1 / taus))) @ ratios

    off = series(times) - share
    print(f"tissue:\n  relaxation: {{ratios: {ratios.tolist()}, times: {taus.tolist()}}}")
    print(f"# error: {100 * np.sqrt(np.square(off).mean()):.1f} % of the peak stress (rms), "
          f"{100 * np.abs(off).max():.1f} % at most, at {times[np.abs(off).argmax()]:.2g} s")
    print("# stress left: " + ", ".join(f"{100 * value:.0f} % after {at} s" for at, value in
                                         zip((10, 60, 300), series(np.array([10, 60, 300])))))


if __name__ == "__main__":
    main()
