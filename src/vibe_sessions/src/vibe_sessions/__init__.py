"""Recorded sessions: reports, cohorts, regressions."""
