"""Kinds of vibe_msgs/ProcedureEvent: name, words and how serious they are. The numbers never change."""

NOTE, DONE, CAUTION, HARM = "note", "done", "caution", "harm"
KINDS = {
    0: ("GRAB", "grab", DONE),
    1: ("GRAB_MISSED", "grab missed", CAUTION),
    2: ("RELEASE", "release", NOTE),
    3: ("SLIP", "slip", CAUTION),
    4: ("CONTACT_BEGIN", "contact", NOTE),
    5: ("CONTACT_END", "end of contact", NOTE),
    6: ("PRESSURE_REACHED", "pressure reached", DONE),
    7: ("WARNING", "warning", CAUTION),
    8: ("RECOVERY", "solver recovered", CAUTION),
    9: ("REJECTED", "command rejected", CAUTION),
    10: ("MARK", "mark", DONE),
    11: ("BURN", "burn", CAUTION),
    12: ("DEEP_BURN", "deep burn", HARM),
    13: ("HELIX_TURNED", "helix turned in", NOTE),
    14: ("BITE", "bite", DONE),
    15: ("BITE_MISSED", "bite missed", CAUTION),
    16: ("BITE_WITHDRAWN", "bite withdrawn", CAUTION),
    17: ("NEEDLE_EXCHANGED", "needle exchanged", NOTE),
    18: ("BLEEDING_MILD", "mild bleeding", CAUTION),
    19: ("BLEEDING_BRISK", "brisk bleeding", HARM),
    20: ("BLEEDING_STOPPED", "bleeding stopped", DONE),
    21: ("BLEEDING_OVERDUE", "bleeding overdue", HARM),
    22: ("TECHNIQUE_FOUND", "technique found", NOTE),
    23: ("T_TAG_DROPPED", "T-tag dropped", DONE),
    24: ("CINCH_PULLING", "cinch pulls", NOTE),
    25: ("CINCHED", "cinched", DONE),
    26: ("CINCH_LOOSE", "cinched loosely", CAUTION),
    27: ("TEAR_OUT", "bite torn out", HARM),
    28: ("THREAD_BROKE", "thread broke", HARM),
    29: ("PHASE_CHANGED", "phase changed", NOTE),
    30: ("PIERCED", "wall pierced", NOTE),
    31: ("ARM_CLOSED", "arm closed", NOTE),
    32: ("BLOCKED", "tool blocked", CAUTION),
    33: ("LEFT_LUMEN", "tip outside the organ", CAUTION),
}
PHASES = ("inspect", "mark", "suture", "pull", "done")
# what the timeline leaves out: it has the phases on its own line, and contacts are too many
UNDRAWN = {4, 5, 29}
WARNINGS = {7, 8}


def name_of(kind):
    return KINDS[kind][0] if kind in KINDS else "KIND_{}".format(kind)


def words_of(kind):
    return KINDS[kind][1] if kind in KINDS else "kind {}".format(kind)


def severity_of(kind):
    return KINDS[kind][2] if kind in KINDS else NOTE
