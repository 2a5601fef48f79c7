"""The data card of a published set."""
import os

from vibe_sessions.published.baselines import COLUMNS
from vibe_sessions.published.member import CONTENT, SIZE
from vibe_sessions.published.plan import BREATHING, HELD_OUT_ORGAN, HELD_OUT_PERSONS, ORGANS, PERSONS, SPLITS, split_of

LICENCE = "Creative Commons Attribution 4.0 International (CC BY 4.0), https://creativecommons.org/licenses/by/4.0/legalcode\n"


def table(rows):
    lines = [COLUMNS, ["---"] * len(COLUMNS), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def card(plan, rows):
    count = len(plan)
    splits = [split_of(number) for number in range(count)]
    novices = sum(session.novice == 1 for session in plan.sessions())
    with open(os.path.join(os.path.dirname(__file__), "card.md"), encoding="utf-8") as file:
        text = file.read()
    return text.format(
        count=count, splits=", ".join(f"{splits.count(split)} {split}" for split in SPLITS), experts=count - novices,
        novices=novices, persons=min(PERSONS, count), organs=min(len(ORGANS), count), names=", ".join(ORGANS[:count]),
        grades=", ".join(map(str, BREATHING.values())), version=plan.content["versions"]["vibe_core"],
        build=plan.content["versions"]["build"], rate=plan.content["rate"], width=SIZE[1], height=SIZE[3], content=CONTENT,
        held_organ=HELD_OUT_ORGAN, held_persons=" and ".join(map(str, HELD_OUT_PERSONS)), neighbours=5, table=table(rows),
        licence=LICENCE)
