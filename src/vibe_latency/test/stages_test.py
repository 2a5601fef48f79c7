#!/usr/bin/env python3
"""Blinks followed through tables whose delays are known."""

import json
import os
import tempfile
import unittest

import numpy
from vibe_latency import figures, stages, summary
from vibe_latency.tables import Measurement, TableError, read_table

MS = 1_000_000  # [ns]
START = 1_700_000_000_000_000_000
PERIOD = 10 * MS
DELAYS = {"driver": 1, "message": 0.5, "solve": 4, "publish": 0.5, "received": 7, "rendered": 9, "pixel": 2}  # [ms]


def write(folder, name, columns, rows):
    with open(os.path.join(folder, name + ".csv"), "w", encoding="ascii") as file:
        file.write(columns + "\n")
        file.writelines(",".join(str(value) for value in row) + "\n" for row in rows)


def position_at(events, time):
    return 0.03 * (numpy.searchsorted(events, time, side="right") % 2)


class Session:
    """Devices at 100 Hz, steps at 100 Hz just after their messages, frames of rviz at once, with all delays constant."""

    def __init__(self, count=40, seed=3, jump=0.03, base=0.0):
        random = numpy.random.default_rng(seed)
        self.events = START + numpy.cumsum(random.integers(250 * MS, 500 * MS, count))
        self.jump, self.base = jump, base
        first = int(START - START % PERIOD)
        self.reports = numpy.arange(first, int(self.events[-1]) + 40 * PERIOD, PERIOD)
        self.lost_pixels = set()

    def report_of(self, event):
        return int(self.reports[numpy.searchsorted(self.reports, event)])

    def value(self, time):
        return self.base + position_at(self.events, time) * (self.jump / 0.03)

    def write(self, folder):
        delay = {name: int(value * MS) for name, value in DELAYS.items()}
        blinks = [(i, int(event), self.report_of(event)) for i, event in enumerate(self.events)]
        device, used, step, display, pixel, state = [], [], [], [], [], []
        for k, report in enumerate(int(r) for r in self.reports):
            arrival = report + delay["driver"] + delay["message"]
            device.append((arrival, report + delay["driver"], self.value(report)))
            begin = arrival + MS // 5
            stamp = begin + PERIOD
            used.append((begin + 1, stamp - PERIOD, k, self.value(report)))
            solved = begin + delay["solve"]
            step.append((solved, stamp, k, begin, begin, solved, solved + delay["publish"]))
            state.append((solved, stamp, self.value(report)))
        for i, event in enumerate(self.events):
            row = step[int(numpy.searchsorted(self.reports, event))]
            lit = int((i % 2 == 0) == (self.jump > 0))
            received = row[6] + delay["received"]
            rendered = received + delay["rendered"]
            display.append((rendered, row[1], lit, received, rendered))
            if i not in self.lost_pixels:
                pixel.append((rendered + delay["pixel"], lit))
        write(folder, "blinks", "blink,event,report", blinks)
        write(folder, "device", "wall,stamp,position", device)
        write(folder, "input", "wall,stamp,step,position", used)
        write(folder, "step", "wall,stamp,step,due,begin,solved,published", step)
        write(folder, "state", "wall,stamp,position", state)
        write(folder, "display", "wall,stamp,lit,received,rendered", display)
        write(folder, "pixel", "wall,lit", pixel)
        setup = {"base": self.base, "jump": self.jump, "title": "test", "periods": {"step": 0.01}}
        with open(os.path.join(folder, "setup.json"), "w", encoding="utf-8") as file:
            json.dump(setup, file)

    def measurement(self):
        with tempfile.TemporaryDirectory() as folder:
            self.write(folder)
            return Measurement(folder)

    def traced(self):
        return stages.trace_blinks(self.measurement())


def median(traced, begin, end):
    return 1e3 * float(numpy.nanmedian(stages.duration(traced, begin, end)))


class StagesTest(unittest.TestCase):
    def check_stages(self, traced):
        self.assertAlmostEqual(median(traced, "report", "driver"), 1, places=6)
        self.assertAlmostEqual(median(traced, "driver", "begin"), 0.7, places=6)
        self.assertAlmostEqual(median(traced, "begin", "solved"), 4, places=6)
        self.assertAlmostEqual(median(traced, "solved", "published"), 0.5, places=6)
        self.assertAlmostEqual(median(traced, "published", "received"), 7, places=6)
        self.assertAlmostEqual(median(traced, "received", "rendered"), 9, places=6)
        self.assertAlmostEqual(median(traced, "rendered", "pixel"), 2, places=6)

    def test_each_stage_has_its_delay(self):
        self.check_stages(Session().traced())

    def test_a_jump_downwards_and_a_base_are_no_other(self):
        self.check_stages(Session(jump=-0.02).traced())
        self.check_stages(Session(jump=1e-4, base=1e-3).traced())

    def test_the_wait_for_a_report_is_uniform(self):
        wait = stages.duration(Session(count=400).traced(), "event", "report")
        self.assertAlmostEqual(wait.mean(), 0.005, delta=0.0006)
        self.assertAlmostEqual(wait.std(), 0.01 / numpy.sqrt(12), delta=0.0004)

    def test_stages_add_up_to_the_whole(self):
        traced = Session().traced()
        whole = stages.duration(traced, "event", "pixel")
        parts = sum(stages.duration(traced, begin, end) for _, begin, end in stages.STAGES)
        numpy.testing.assert_allclose(parts, whole, atol=1e-12)
        self.assertGreater(whole.min(), 0.024)

    def test_a_blink_that_never_shows_is_lost_there_only(self):
        session = Session()
        session.lost_pixels = {4}
        traced = session.traced()
        self.assertEqual(traced["pixel"][4], stages.LOST)
        self.assertNotEqual(traced["rendered"][4], stages.LOST)
        self.assertEqual(int((traced["pixel"] == stages.LOST).sum()), 1)
        numbers = summary.stage_statistics(traced)["event to pixel"]
        self.assertEqual((numbers["count"], numbers["lost"]), (39, 1))


class SummaryTest(unittest.TestCase):
    def test_numbers_of_known_values(self):
        numbers = summary.statistics(numpy.array([1.0, 2.0, 3.0, 4.0, numpy.nan]))
        self.assertEqual((numbers["count"], numbers["lost"]), (4, 1))
        self.assertEqual((numbers["mean"], numbers["p50"], numbers["min"], numbers["max"]), (2.5, 2.5, 1.0, 4.0))
        self.assertAlmostEqual(numbers["sd"], numpy.sqrt(5 / 3))

    def test_nothing_known_has_no_mean(self):
        self.assertEqual(summary.statistics(numpy.array([numpy.nan])), {"count": 0, "lost": 1})

    def test_cross_correlation_finds_the_median_delay_without_pairs(self):
        session = Session(count=60)
        whole = stages.duration(session.traced(), "event", "pixel")
        lags, correlation = summary.cross_correlation(session.measurement(), "pixel")
        self.assertAlmostEqual(summary.peak_lag(lags, correlation), numpy.median(whole), delta=0.002)
        self.assertGreater(correlation.max(), 0.95)
        lags, correlation = summary.cross_correlation(session.measurement(), "published")
        self.assertLess(summary.peak_lag(lags, correlation), numpy.median(whole) - 0.015)

    def test_cross_correlation_does_not_depend_on_the_tracing(self):
        """Without the middle stages nothing can be traced; the two signals are still there."""
        measurement = Session(count=60).measurement()
        for name in ("input", "step", "display"):
            for column in getattr(measurement, name):
                getattr(measurement, name)[column] = getattr(measurement, name)[column][:0]
        self.assertTrue((stages.trace_blinks(measurement)["pixel"] == stages.LOST).all())
        lags, correlation = summary.cross_correlation(measurement, "pixel")
        self.assertAlmostEqual(summary.peak_lag(lags, correlation), 0.029, delta=0.004)

    def test_cross_correlation_survives_a_lost_blink(self):
        session = Session(count=60)
        session.lost_pixels = {7}
        lags, correlation = summary.cross_correlation(session.measurement(), "pixel")
        self.assertGreater(correlation.max(), 0.9)
        self.assertAlmostEqual(summary.peak_lag(lags, correlation), 0.029, delta=0.004)

    def test_waits_for_a_clock_are_uniform_and_others_not(self):
        traced = Session(count=400).traced()
        self.assertLess(summary.phase_coverage(stages.duration(traced, "event", "report"), 0.01), 1.63 / 20)
        self.assertGreater(summary.phase_coverage(stages.duration(traced, "driver", "begin"), 0.01), 0.5)

    def test_no_steps_are_no_error(self):
        nothing = {name: numpy.array([]) for name in ("due", "begin", "solved", "published")}
        self.assertEqual(summary.step_statistics(nothing, 0.01)["count"], 0)

    def test_a_step_that_takes_longer_than_a_period_misses_its_deadline(self):
        due = START + numpy.arange(5) * PERIOD
        work = numpy.array([4, 9, 11, 4, 4]) * MS
        begin = due + numpy.array([0, 0, 0, MS, 7 * MS])
        step = {"due": due, "begin": begin, "solved": begin + work - MS, "published": begin + work}
        numbers = summary.step_statistics(step, 0.01)
        self.assertEqual((numbers["count"], numbers["missed"]), (5, 2))  # the long one, and the one that began too late
        self.assertAlmostEqual(numbers["step"]["max"], 0.011)
        self.assertAlmostEqual(numbers["solve"]["p50"], 0.003)


class FileTest(unittest.TestCase):
    def test_a_broken_row_is_named(self):
        with tempfile.TemporaryDirectory() as folder:
            write(folder, "pixel", "wall,lit", [(1, 0), ("x",)])
            with self.assertRaisesRegex(TableError, "pixel.csv"):
                read_table(os.path.join(folder, "pixel.csv"))

    def test_the_figure_is_drawn_with_and_without_a_screen(self):
        for end in ("pixel", "published"):
            session = Session()
            measurement, traced = session.measurement(), session.traced()
            if end == "published":
                for name in ("received", "rendered", "pixel"):
                    traced[name][:] = stages.LOST
            self.assertEqual(figures.last_known(traced), end)
            with tempfile.TemporaryDirectory() as folder:
                path = os.path.join(folder, "latency.png")
                figures.draw(measurement, traced, path)
                self.assertGreater(os.path.getsize(path), 20_000)


if __name__ == "__main__":
    unittest.main()
