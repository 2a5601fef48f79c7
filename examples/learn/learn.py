#!/usr/bin/env python3
"""Baselines for the tasks of vibe.env, one command each; numpy is enough, demonstrations need python3-h5py:

    learn.py demonstrate reach.hdf5          the expert's episodes on the organs of training
    learn.py clone reach.hdf5 cloned.npz     a policy that imitates them
    learn.py evaluate random expert cloned.npz    all of them on 100 seeds and organs that nobody trained on, as a table

ppo.py goes on from there by reinforcement. policies/ has a policy of each of several tasks, made by these commands.

The task of `demonstrate` and of `evaluate random expert` is Reach, or that of --task; demonstrations and policies know
theirs. `demonstrate` and `evaluate` go on where they were stopped."""

import argparse
import hashlib
import json
import os
import sys
import zipfile

import numpy as np

import vibe
from vibe import Error
from vibe.env import BREATHING, HELD_OUT, TRAINING, Environment, Expert, demonstrations

STEP_PERIOD = 1 / 60  # [s], of the tables in docs/python.md; with 1/20, where it is the default, episodes take half the time
# Settings of the environment of a task, beside the step. Reach has no use for joints, and Inspect is learnt from pixels.
SETTINGS = {"Reach": {"action": "tip"}, "Inspect": {"step_period": 1 / 20, "camera": (16, 16, 2.0), "pictures": ["depth"]}}
# What policies see, as far as a task observes it, and what of each counts as one, at least: demonstrations hardly touch the
# wall, and by their own deviation a touch would be far away. [m], [N, N m], [m], [rad], ...
LEAST = {"to_goal": 0.01, "wrench": [1.0] * 3 + [0.05] * 3, "depth": 0.02, "joints": 0.05, "direction": 0.1, "holds": 0.5,
         "held": 0.5, "tension": 0.5, "blood": 1.0, "seen": 0.1}
UNSEEN = {"Reach": {"joints", "direction"}, "Cinch": {"to_goal", "wrench", "joints", "direction"}}


class Random:
    """Uniform actions, by the seed of the episode."""

    def __init__(self, environment):
        self.space = environment.action_space

    def reset(self, seed):
        self.random = np.random.default_rng([7, seed])

    def action(self, _):
        return self.random.uniform(self.space.low, self.space.high).astype(np.float32)


class Scripted:
    def __init__(self, environment):
        self.expert = Expert(environment)

    def reset(self, _):
        self.expert.reset()

    def action(self, observation):
        return self.expert.action(observation)


class Cloned:
    """Two hidden layers of 64 tanh between scaled inputs and the action."""

    def __init__(self, file):
        try:
            with np.load(file) as stored:
                self.task, self.inputs = str(stored["task"]), [str(name) for name in stored["inputs"]]
                self.parts = [stored[f"arr_{k}"].astype(float) for k in range(len(stored.files) - 2)]
        except KeyError:
            raise Error(f"{file} does not say its task, as policies of version 1.0 do not; make it again.") from None
        except (OSError, ValueError, zipfile.BadZipFile) as error:
            raise Error(f"{file} cannot be read as a policy ({error}); name a file of clone or ppo.py.") from None

    def reset(self, _):
        pass

    def action(self, observation):
        row = rows_of(observation, self.inputs, 1)
        return np.clip(forward(self.parts, row)[-1][0], -1, 1).astype(np.float32)


def inputs_of(task, observed):
    """The names of what a policy of a task sees, of those that are observed."""
    return [name for name in LEAST if name in observed and name not in UNSEEN.get(task, ())]


def rows_of(observation, inputs, count):
    """The inputs of a policy, one row for each of `count` observations."""
    return np.concatenate([np.reshape(observation[name], (count, -1)) for name in inputs], axis=1).astype(float)


def scaling(rows, least):
    """Mean and deviation of the inputs, the latter no less than what counts as one."""
    return [rows.mean(0), np.maximum(rows.std(0), least)]


def least_of(observation, inputs):
    """What counts as one of each number that a policy sees."""
    return np.concatenate([np.broadcast_to(LEAST[name], np.size(observation[name])) for name in inputs])


def balanced(wanted, share=0.2):
    """Indices of the rows of `wanted` actions, those repeated in which buttons are pressed as in few others, until each
    combination of buttons is this share of all rows, about: a button that is pressed once in an episode would else be noise."""
    buttons = np.all(np.isin(wanted, (-1, 1)), axis=0)
    _, of, count = np.unique(wanted[:, buttons] > 0, axis=0, return_inverse=True, return_counts=True)
    return np.repeat(np.arange(len(wanted)), np.maximum(1, share * len(wanted) / count).astype(int)[of.ravel()])


def store(file, task, inputs, parts):
    np.savez(file + ".part.npz", *[np.asarray(part, np.float32) for part in parts], task=task, inputs=inputs)
    os.replace(file + ".part.npz", file)


def forward(parts, rows):
    """The values of every layer. parts: mean and scale of the inputs, then weights and offsets of each layer."""
    values = [(rows - parts[0]) / parts[1]]
    for k in range(2, len(parts), 2):
        sums = values[-1] @ parts[k] + parts[k + 1]
        values.append(np.tanh(sums) if k + 2 < len(parts) else sums)
    return values


def gradients(parts, values, error):
    """Of half the mean square of `error`, by weights and offsets."""
    found, slope = [], error / len(error)
    for k in range(len(parts) - 2, 1, -2):
        below = values[k // 2 - 1]
        found = [below.T @ slope, slope.sum(0)] + found
        slope = (slope @ parts[k].T) * (1 - below**2)
    return found


def fit(rows, wanted, epochs, seed=0, batch=256, rate=1e-3, least=1e-9):
    """Adam (Kingma and Ba 2015) on the mean square error. least: see least_of()"""
    random = np.random.default_rng(seed)
    sizes = [rows.shape[1], 64, 64, wanted.shape[1]]
    parts = scaling(rows, least)
    for inner, outer in zip(sizes, sizes[1:]):
        parts += [random.normal(0, inner**-0.5, (inner, outer)), np.zeros(outer)]
    first, second, step = [0.0] * (len(parts) - 2), [0.0] * (len(parts) - 2), 0
    for epoch in range(epochs):
        loss = 0.0
        for some in np.array_split(random.permutation(len(rows)), max(1, len(rows) // batch)):
            values = forward(parts, rows[some])
            error = values[-1] - wanted[some]
            loss += (error**2).sum() / wanted.size
            step += 1
            for k, slope in enumerate(gradients(parts, values, error)):
                first[k] = 0.9 * first[k] + 0.1 * slope
                second[k] = 0.999 * second[k] + 0.001 * slope**2
                parts[k + 2] -= rate * (first[k] / (1 - 0.9**step)) / (np.sqrt(second[k] / (1 - 0.999**step)) + 1e-8)
        show(f"epoch {epoch + 1} of {epochs}, mean square error {loss:.4f}")
    return parts


def show(text):
    print(f"\r{text} ", end="", file=sys.stderr, flush=True)


def environment_of(task, organs, **settings):
    return Environment(task, organs=organs, **{"step_period": STEP_PERIOD, **SETTINGS.get(task, {}), **settings})


def demonstrate(options):
    environment = environment_of(options.task or "Reach", TRAINING)
    kept, of = demonstrations.record(environment, Expert(environment), options.file, options.episodes, seed=options.seed,
                                     progress=lambda done, of, kept: show(f"episode {done} of {of}, {kept} succeeded"))
    print(f"\n{kept} of {of} episodes succeeded and are in {options.file}")


def clone(options):
    import h5py
    if os.path.exists(options.policy):
        sys.exit(f"{options.policy} exists and is not overwritten; name another file.")
    with h5py.File(options.file, "r") as file:
        demos = list(file["data"].values())
        task = json.loads(file.attrs["begun"])["task"]["class"]
        task = task.removeprefix("vibe.env.tasks:")
        inputs = inputs_of(task, demos[0]["obs"])
        rows = np.concatenate([rows_of(demo["obs"], inputs, len(demo["actions"])) for demo in demos])
        wanted = np.concatenate([demo["actions"] for demo in demos]).astype(float)
        least = least_of({name: demos[0]["obs"][name][0] for name in inputs}, inputs)
    some = balanced(wanted)
    store(options.policy, task, inputs, fit(rows[some], wanted[some], options.epochs, options.seed, least=least))
    print(f"\n{len(demos)} episodes, {len(rows)} actions: {options.policy}")


def policy_of(name, task):
    """What a worker needs of a policy, its task, and the words by which its episodes are kept."""
    if name == "random":
        return name, task or "Reach", name
    if name == "expert":
        environment = environment_of(task or "Reach", HELD_OUT)
        Expert(environment)  # refuses a task that has none
        return name, task or "Reach", f"expert {digest_of(environment.task.expert(1))}"
    policy = Cloned(name)
    if task not in (None, policy.task):
        raise Error(f"{name} is a policy of {policy.task}, and --task is {task}; leave --task out.")
    with open(name, "rb") as file:
        return policy, policy.task, f"file {hashlib.sha1(file.read()).hexdigest()}"


def digest_of(thing):
    """Of the modules that define the classes of an object, whole, since methods use what stands beside them, and of what the
    class holds, which may come from elsewhere."""
    kind = type(thing)
    modules = dict.fromkeys(sys.modules.get(base.__module__) for base in kind.__mro__)
    held = {name: getattr(kind, name) for name in dir(kind)}
    said = json.dumps([[demonstrations.source_of([module]) for module in modules], held], skipkeys=True,
                      default=lambda value: value.tolist() if isinstance(value, (np.ndarray, np.generic)) else type(value).__name__)
    return hashlib.sha1(said.encode()).hexdigest()


def conditions(options, name):
    """What besides the policy decides an episode of a task, in words; the digest is of settings, of the task's source, and of
    some actions, so that episodes of another version of the simulator are not taken for those of this one."""
    environment = environment_of(name, HELD_OUT, breathing=options.breathing)
    environment.reset(seed=0)
    over = False
    for _ in range(3):
        if not over:
            _, _, terminated, truncated, _ = environment.step(np.full(environment.action_space.shape, 0.5, np.float32))
            over = terminated or truncated
    task = environment.task
    said = json.dumps(demonstrations.made_of(environment), sort_keys=True), digest_of(task), environment.simulation.hash()
    return (f"{name}, {options.breathing or 'still'}, {task.particles} particles, steps of {task.step_period:.6g} s, "
            f"vibe {vibe.__version__} {hashlib.sha1(repr(said).encode()).hexdigest()[:16]}")


def kept_episodes(file):
    """Rows by what they are of; a line that was cut while it was written is left out."""
    known = {}
    if not os.path.exists(file):
        return known
    with open(file, encoding="utf-8") as lines:
        for line in lines:
            try:
                row = json.loads(line)
                known[row["policy"], row.get("conditions"), row["seed"]] = row
            except (ValueError, KeyError, TypeError):
                print(f"{file}: a line that is no episode is left out: {line[:40]!r}", file=sys.stderr)
    return known


def episode(policy, task, breathing, seed):
    """The outcome of one episode on the organs that nobody trained on."""
    environment = environment_of(task, HELD_OUT, breathing=breathing)
    acting = {"random": Random, "expert": Scripted}[policy](environment) if isinstance(policy, str) else policy
    observation, info = environment.reset(seed=seed)
    acting.reset(seed)
    over = False
    while not over:
        observation, _, terminated, truncated, info = environment.step(acting.action(observation))
        over = terminated or truncated
    environment.close()  # the simulation serves the next one
    return {name: info.get(name) for name in ("is_success", "time", "max_force", "distance", "organ")}


def on_workers(address, policy, task, breathing, seeds):
    """(seed, outcome) from the workers of a Dask scheduler, in the order in which episodes end. They need vibe."""
    try:
        from distributed import as_completed
        from vibe_sessions.cohort_dask import connect
        from vibe_sessions.headless import SessionError
    except ImportError as error:
        sys.exit(f"--scheduler needs python3-distributed and the workspace: {error}.")
    try:
        client = connect(address)
    except SessionError as error:
        sys.exit(str(error))
    with client:
        futures = {client.submit(episode, policy, task, breathing, seed, pure=False): seed for seed in seeds}
        for future in as_completed(futures, loop=client.loop):
            yield futures[future], future.result()


def evaluate(options):
    policies = [(name, *policy_of(name, options.task)) for name in options.policies]
    known = kept_episodes(options.episodes)
    with open(options.episodes, "a+", encoding="utf-8") as file:  # before anything is computed
        file.seek(max(0, file.tell() - 1))
        if file.read() not in ("", "\n"):  # a line that was cut
            file.write("\n")
    words = {}
    print("| policy | task | success | 95 % | time [s] | greatest force [N], median |\n|---|---|---|---|---|---|")
    for name, policy, task, key in policies:
        if task not in words:
            words[task] = conditions(options, task)
            print(f"{words[task]}; kept in {options.episodes}", file=sys.stderr)
        under = words[task]
        seeds = range(options.first, options.first + options.seeds)
        missing = [seed for seed in seeds if (key, under, seed) not in known]
        found = on_workers(options.scheduler, policy, task, options.breathing, missing) if options.scheduler \
            else ((seed, episode(policy, task, options.breathing, seed)) for seed in missing)
        for done, (seed, outcome) in enumerate(found):
            row = known[key, under, seed] = {"policy": key, "conditions": under, "seed": seed, **outcome}
            with open(options.episodes, "a", encoding="utf-8") as file:
                file.write(json.dumps(row) + "\n")
            show(f"{name}: {done + 1} of {len(missing)} episodes")
        show(f"{'':60}\r")
        print(table_row(f"{os.path.basename(name)} | {task}", [known[key, under, seed] for seed in seeds]), flush=True)


def table_row(name, rows):
    n, share = len(rows), np.mean([row["is_success"] for row in rows])
    z = 1.96  # interval of Wilson (1927)
    middle, half = share + z**2 / (2 * n), z * np.sqrt(share * (1 - share) / n + z**2 / (4 * n**2))
    low, high = max(0.0, middle - half) / (1 + z**2 / n), (middle + half) / (1 + z**2 / n)
    time = np.median([row["time"] for row in rows])
    force = np.median([row["max_force"] for row in rows])
    return f"| {name} | {100 * share:.0f} % | {100 * low:.0f} to {100 * high:.0f} % | {time:.1f} | {force:.1f} |"


def positive(text):
    number = int(text)
    if number < 1:
        raise argparse.ArgumentTypeError(f"{text} is below 1")
    return number


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    one = commands.add_parser("demonstrate", help="writes the expert's episodes")
    one.add_argument("file")
    one.add_argument("--episodes", type=positive, default=200)
    one.add_argument("--seed", type=int, default=10000, help="of the first episode")
    one.set_defaults(run=demonstrate)
    one = commands.add_parser("clone", help="trains a policy on demonstrations")
    one.add_argument("file")
    one.add_argument("policy")
    one.add_argument("--epochs", type=positive, default=60)
    one.add_argument("--seed", type=int, default=0, help="of the first weights and of the order")
    one.set_defaults(run=clone)
    one = commands.add_parser("evaluate", help="prints the table")
    one.add_argument("policies", nargs="+", metavar="policy", help="random, expert, or a file of clone or ppo.py")
    one.add_argument("--seeds", type=positive, default=100)
    one.add_argument("--first", type=int, default=0)
    one.add_argument("--breathing", choices=tuple(BREATHING), help="of the stomachs (default: still)")
    one.add_argument("--scheduler", metavar="HOST:PORT", help="let the workers of this Dask scheduler perform the episodes")
    one.add_argument("--episodes", default="episodes.jsonl", help="file that keeps them (default: %(default)s)")
    one.set_defaults(run=evaluate)
    for one in (commands.choices["demonstrate"], commands.choices["evaluate"]):
        one.add_argument("--task", help="of vibe.env, or MODULE:NAME of your own (default: Reach, or that of a policy)")
    run(parser.parse_args())


def run(options):
    """The command that was asked for; what is wrong ends it with a sentence."""
    try:
        options.run(options)
    except (Error, OSError) as error:
        sys.exit(str(error))
    except KeyboardInterrupt:
        sys.exit("\nStopped; the same command goes on.")


if __name__ == "__main__":
    main()
