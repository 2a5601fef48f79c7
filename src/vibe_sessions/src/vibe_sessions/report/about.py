"""What people say of a session: in the file NAME.about.yaml beside NAME.bag, which scripts/run writes and anyone may edit.
Beside the recording and not in it, so that a name can be taken away."""

import os
import re

import yaml

from .bag_file import BagError

KEYS = ("person", "notes")


def about_of(bag):
    """{"person", "notes"} of a recording; None where nothing is said. Raises BagError."""
    file = re.sub(r"(\.bag)?(\.active)?$", "", bag) + ".about.yaml"
    if not os.path.exists(file):
        return dict.fromkeys(KEYS)
    try:
        with open(file, encoding="utf-8") as text:
            said = yaml.safe_load(text) or {}
        if not isinstance(said, dict) or not set(said) <= set(KEYS):
            raise ValueError("it has other keys")
    except (OSError, ValueError, yaml.YAMLError) as problem:
        raise BagError("{}: cannot be read ({}); write 'person: NAME' and 'notes: TEXT', or remove it".format(
            file, " ".join(str(problem).split()))) from None
    return {key: str(said[key]) if said.get(key) is not None else None for key in KEYS}
