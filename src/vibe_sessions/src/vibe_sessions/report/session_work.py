"""The work on one recording: from its file to its page, its numbers and its row."""

import gc
import json
import os
import re
from dataclasses import dataclass

from ..whole_file import open_whole
from .bag_file import BagError
from .numbers import numbers_of, row_of
from .recording import read_recording


@dataclass(frozen=True)
class Task:
    """What a worker is told about a recording."""

    path: str
    name: str
    group: str
    namespace: str  # None: of the first session
    page: str  # path of the page to write; empty: none
    back: str  # name of the page of all sessions; empty: none
    session: str = None  # number or identity; None: the first one
    compared: bool = False  # with the other sessions, in the same axes


def report_on(task):
    """(row, numbers as JSON, problem, trace): all are None if there is a problem, which is one sentence; so is a trace that
    is not asked for."""
    try:
        recording = read_recording(task.path, task.namespace, task.session)
        numbers = numbers_of(recording)
    except BagError as problem:
        return None, None, str(problem), None
    if task.page:
        from .page import session_page  # matplotlib is slow to load and not needed without pages

        write_text(task.page, session_page(recording, numbers, task.name, task.back))
        gc.collect()  # figures are cycles of references
    row = row_of(numbers, task.name, task.group)
    row["page"] = os.path.basename(task.page)
    about = {"name": task.name, "group": task.group, "page": row["page"]}
    trace = None
    if task.compared:
        from .overlay import trace_of

        trace = trace_of(recording, task.name)
    return row, json.dumps({**about, **numbers}, allow_nan=False), None, trace


def write_text(path, text):
    with open_whole(path, errors="replace") as file:
        file.write(text)


def names_of(paths):
    """Short names that differ: the paths without what all have in common, or the folder of a single session.bag."""
    full = [os.path.abspath(path) for path in paths]
    common = os.path.commonpath([os.path.dirname(path) for path in full])
    if len(full) == 1:
        common = os.path.dirname(common)
    names = [re.sub(r"(\.bag)?(\.active)?$", "", os.path.relpath(path, common)) for path in full]
    if len(set(names)) == len(names):
        shorter = [re.sub(r"/session$", "", name) for name in names]
        return shorter if len(set(shorter)) == len(shorter) else names
    return [os.path.relpath(path, common) for path in full]


def page_names(names):
    """File names for pages: letters, digits, dots, dashes; numbered where two would be the same."""
    used, pages = {"index"}, []
    for name in names:
        plain = re.sub(r"[^A-Za-z0-9._-]+", "_", name).strip("._")[:100] or "session"
        candidate, count = plain, 1
        while candidate.lower() in used:
            count += 1
            candidate = "{}_{}".format(plain, count)
        used.add(candidate.lower())
        pages.append(candidate + ".html")
    return pages
