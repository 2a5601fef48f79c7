"""Pages from numbers and pictures. Everything that a recording says is escaped; nothing is loaded from elsewhere."""

import os

import jinja2

from . import overlay, tables
from .curves import curves, solver_curves, trajectory
from .organ import organ_picture
from .timeline import timeline
from .viewer import organ_data, viewer_script

TEMPLATES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "templates")


def rendered(template, **values):
    made = jinja2.Environment(loader=jinja2.FileSystemLoader(TEMPLATES), autoescape=True, undefined=jinja2.StrictUndefined,
                              trim_blocks=True, lstrip_blocks=True)  # fmt: skip
    made.filters["shown"] = tables.shown
    return made.get_template(template).render(**values)


def session_page(recording, numbers, name, back=""):
    """HTML of one session. `back`: name of the page of all sessions, if there is one."""
    organ = organ_picture(recording)
    return rendered(
        "session.html",
        name=name,
        back=back,
        numbers=numbers,
        facts=tables.facts(numbers),
        tiles=tables.tiles(numbers),
        references=tables.reference_rows(numbers),
        coverage=tables.coverage_rows(numbers),
        phases=tables.phase_rows(numbers),
        sets=tables.set_rows(numbers),
        solver=tables.solver_rows(numbers),
        latency=tables.latency_rows(numbers),
        dropped=tables.dropped_rows(numbers),
        topics=recording.topics,
        all_numbers=tables.all_numbers(numbers),
        timeline=timeline(recording),
        organ=organ[0] if organ else None,
        organ_is_rest=organ[1] if organ else False,
        organ_data=organ_data(recording),
        viewer=viewer_script(),
        curves=curves(recording),
        force_rate=rate_of(recording.force_curve()),
        trajectory=trajectory(recording),
        solver_curves=solver_curves(recording),
    )


def rate_of(samples):
    """Samples per second of a curve."""
    seconds = samples[-1, 0] - samples[0, 0] if len(samples) > 1 else 0
    return (len(samples) - 1) / seconds if seconds > 0 else 0


def index_page(rows, failures, groups, distributions, drawn_groups, traces):
    """HTML of many sessions. The picture `distributions` has the first `drawn_groups` of the groups; `traces` are compared
    in the same axes."""
    return rendered(
        "index.html",
        rows=tables.index_rows(rows),
        columns=tables.index_columns(rows),
        measures=tables.MAIN_MEASURES,
        failures=failures,
        groups=groups,
        drawn_groups=drawn_groups,
        summary=tables.group_summary(rows) if rows else [],
        distributions=distributions,
        forces=overlay.forces(traces),
        paths=overlay.paths(traces),
        count=len(rows),
    )
