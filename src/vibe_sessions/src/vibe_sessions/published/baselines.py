"""Baselines of a published set: linear models and nearest neighbours, each beside a predictor that looks at nothing."""
import os

import numpy
import pandas
from PIL import Image

from vibe_sessions.imports.map_file import JOINTS
from vibe_sessions.published.plan import SPLITS, key_of, split_of

WINDOWS = (6, 30)  # steps back over which motion is looked at
RIDGE = 1.0
NEIGHBOURS = 5
COLUMNS = ("task", "baseline", "measure", *SPLITS[1:])


def read(folder):
    """Of one session at the stamps of its pictures: features of motion and of pictures, force [N], phase, particles [m]."""
    steps = pandas.read_csv(os.path.join(folder, "steps.csv"))
    times = numpy.loadtxt(os.path.join(folder, "images", "times.txt"), ndmin=2)
    rows = numpy.clip(numpy.searchsorted(steps["time"], times[:, 1] - 1 - 1e-6), 0, len(steps) - 1)  # time begins at 1 s
    motion = steps[[*JOINTS, "tip_x", "tip_y", "tip_z"]].to_numpy()
    moved = [motion[rows] - motion[numpy.maximum(rows - back, 0)] for back in WINDOWS]
    images = os.path.join(folder, "images")
    names = ["{:06.0f}".format(number) for number in times[:, 0]]
    pixels = [numpy.asarray(Image.open(os.path.join(images, "image", name + ".png")).resize((16, 12))).ravel() for name in names]
    particles = [numpy.load(os.path.join(images, "particles", name + ".npy")) for name in names]
    force = numpy.linalg.norm(steps[["force_x", "force_y", "force_z"]].to_numpy()[rows], axis=1)
    return {"motion": numpy.hstack([motion[rows], *moved, *map(numpy.abs, moved)]), "pictures": numpy.array(pixels) / 255.0,
            "force": force, "phase": steps["phase"].to_numpy()[rows], "particles": particles}


def pooled(sessions, name):
    return numpy.concatenate([session[name] for session in sessions]) if sessions else numpy.zeros(0)


def scaled(train, *others):
    """With mean 0 and deviation 1 in the training."""
    mean, spread = train.mean(axis=0), train.std(axis=0) + 1e-9
    return [(values - mean) / spread for values in (train, *others)]


def ridge(train, wanted, test):
    train, test = scaled(train, test)
    middle = wanted.mean()
    weights = numpy.linalg.solve(train.T @ train + RIDGE * len(train) / 100 * numpy.eye(train.shape[1]), train.T @ (wanted - middle))
    return test @ weights + middle


def nearest(train, wanted, test):
    """The class that most of the nearest have."""
    train, test = scaled(train, test)
    classes, numbers = numpy.unique(wanted, return_inverse=True)
    found = []
    for row in test:
        near = numbers[numpy.argsort(((train - row) ** 2).sum(axis=1), kind="stable")[:NEIGHBOURS]]
        found.append(classes[numpy.bincount(near).argmax()])
    return numpy.array(found)


def deformation(train, test):
    """RMS errors [mm] of where the particles are at the next picture: where they are; and moved on by a part of their last
    motion, which the training gives."""
    moves = [numpy.diff(session["particles"], axis=0) for session in (*train, *test)]
    before, after = ([part for move in moves[:len(train)] for part in move[a:b]] for a, b in ((None, -1), (1, None)))
    part = sum((a * b).sum() for a, b in zip(before, after)) / max(sum((a * a).sum() for a in before), 1e-30)
    still, moved = ([float(((move[1:] - share * move[:-1]) ** 2).sum(axis=2).mean()) for move in moves[len(train):]] for share in (0, part))
    return 1e3 * numpy.sqrt(numpy.mean(still)), 1e3 * numpy.sqrt(numpy.mean(moved))


def scores(train, test):
    """{(task, baseline, measure): value} on one split."""
    if not train or not test:
        return {}
    force, wanted = pooled(train, "force"), pooled(test, "force")
    rmse = lambda found: float(numpy.sqrt(((found - wanted) ** 2).mean()))  # noqa: E731
    found = {("force", "mean of the training", "RMSE [N]"): rmse(force.mean())}
    for source in ("motion", "pictures"):
        found["force", f"ridge on {source}", "RMSE [N]"] = rmse(ridge(pooled(train, source), force, pooled(test, source)))
    phase, there = pooled(train, "phase"), pooled(test, "phase")
    classes, counts = numpy.unique(phase, return_counts=True)
    found["phase", "most frequent", "right"] = float((there == classes[counts.argmax()]).mean())
    by_motion = nearest(pooled(train, "motion"), phase, pooled(test, "motion"))
    found["phase", f"{NEIGHBOURS} nearest in motion", "right"] = float((there == by_motion).mean())
    still, moved = deformation(train, test)
    found["next deformation", "as it is", "RMSE [mm]"] = float(still)
    found["next deformation", "moves on", "RMSE [mm]"] = float(moved)
    return found


def baselines(folder, count):
    """Rows of COLUMNS."""
    sets = {split: [] for split in SPLITS}
    for number in range(count):
        sets[split_of(number)].append(read(os.path.join(folder, "sessions", key_of(number))))
    by_split = {split: scores(sets["train"], sets[split]) for split in SPLITS[1:]}
    keys = dict.fromkeys(key for found in by_split.values() for key in found)
    return [(*key, *("{:.4g}".format(found[key]) if key in found else "" for found in by_split.values())) for key in keys]
