"""What LeRobot says of every feature: of an episode, and of all episodes so far."""

import numpy as np

QUANTILES = {"q01": 1, "q10": 10, "q50": 50, "q90": 90, "q99": 99}


def of_rows(rows):
    """Of an array with a row per sample."""
    rows = np.asarray(rows, float)
    found = {"min": rows.min(0), "max": rows.max(0), "mean": rows.mean(0), "std": rows.std(0)}
    found.update(zip(QUANTILES, np.percentile(rows, list(QUANTILES.values()), axis=0)))
    return {**{name: value.tolist() for name, value in found.items()}, "count": [len(rows)]}


def of_pictures(pictures):
    """Of colours from 0 to 1, shape (3, 1, 1); count is that of pictures."""
    found = of_rows(np.concatenate([picture.reshape(-1, 3) for picture in pictures]) / 255.0)
    return {**{name: [[[share]] for share in value] for name, value in found.items()}, "count": [len(pictures)]}


def together(a, b):
    """Of two sets of samples; quantiles are means by count, as LeRobot itself does it."""
    a, b = ({name: np.array(value, float) for name, value in part.items()} for part in (a, b))
    share = (b["count"] / (a["count"] + b["count"]))[0]
    found = {name: (1 - share) * a[name] + share * b[name] for name in ("mean", *QUANTILES)}
    variance = (1 - share) * (a["std"]**2 + (a["mean"] - found["mean"])**2) + share * (b["std"]**2 + (b["mean"] - found["mean"])**2)
    found.update(min=np.minimum(a["min"], b["min"]), max=np.maximum(a["max"], b["max"]), std=np.sqrt(variance))
    return {**{name: value.tolist() for name, value in found.items()}, "count": [int((a["count"] + b["count"])[0])]}
