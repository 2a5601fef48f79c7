#!/usr/bin/env python3
"""Trains a policy for a task of vibe.env with PPO (Schulman 2017, arXiv 1707.06347), and draws its curve:

    ppo.py train reached.npz --start cloned.npz    goes on where it was stopped; needs python3-torch
    ppo.py curve reached.npz curve.png             needs python3-matplotlib
    learn.py evaluate reached.npz                  as every policy

The policy has the form of learn.py, two layers of 64 numbers, and sees the same. Beside its mean it has one
standard deviation per action, which is for training only. Beside POLICY.npz there are POLICY.pt, from which training goes
on, and POLICY.jsonl with a line per round."""

import argparse
import json
import os
import sys
import time

import numpy as np

import learn
from vibe.env import BREATHING, TRAINING, VectorEnvironment

STEPS = 64  # actions of every episode per round
DISCOUNT, TRACE = 0.98, 0.95  # of rewards and of advantages, per action
CLIP = 0.2  # of the ratio of probabilities
EPOCHS, BATCH = 6, 256  # of the optimiser per round
POLICY_RATE, VALUE_RATE = 3e-4, 1e-3


def torch_or_exit():
    try:
        import torch
    except ImportError:
        sys.exit("Training needs PyTorch; install python3-torch.")
    torch.set_num_threads(1)
    return torch


class Learner:
    """Policy and value, their optimiser, and what a round has found."""

    def __init__(self, task, inputs, parts, begun, seed):
        """parts: of a policy. begun: whether it has learnt before"""
        torch = self.torch = torch_or_exit()
        torch.manual_seed(seed)
        self.task, self.inputs, self.scaling = task, inputs, parts[:2]
        self.mean = [torch.tensor(part, dtype=torch.float32, requires_grad=True) for part in parts[2:]]
        self.spread = torch.full((len(parts[-1]),), -1.2 if begun else -0.5, requires_grad=True)  # logarithm of the deviation
        sizes = (len(parts[0]), 64, 64, 1)
        layers = [torch.nn.Linear(*pair) for pair in zip(sizes, sizes[1:])]
        self.value = torch.nn.Sequential(layers[0], torch.nn.Tanh(), layers[1], torch.nn.Tanh(), layers[2])
        self.optimiser = torch.optim.Adam([{"params": [*self.mean, self.spread], "lr": POLICY_RATE},
                                           {"params": self.value.parameters(), "lr": VALUE_RATE}])

    def rows(self, observation, count):
        rows = learn.rows_of(observation, self.inputs, count)
        return self.torch.tensor((rows - self.scaling[0]) / self.scaling[1], dtype=self.torch.float32)

    def policy(self, rows):
        for k in range(0, len(self.mean), 2):
            rows = rows @ self.mean[k] + self.mean[k + 1]
            rows = self.torch.tanh(rows) if k + 2 < len(self.mean) else rows
        return self.torch.distributions.Normal(rows, self.spread.exp())

    def save(self, file, state):
        learn.store(file, self.task, self.inputs, [*self.scaling, *(part.detach().numpy() for part in self.mean)])
        self.torch.save({"mean": [part.detach() for part in self.mean], "spread": self.spread.detach(),
                         "value": self.value.state_dict(), "optimiser": self.optimiser.state_dict(),
                         "scaling": [self.torch.from_numpy(part) for part in self.scaling], **state}, file[:-4] + ".pt.new")
        os.replace(file[:-4] + ".pt.new", file[:-4] + ".pt")

    def load(self, file):
        state = self.torch.load(file[:-4] + ".pt")
        with self.torch.no_grad():
            for part, stored in zip([*self.mean, self.spread], [*state["mean"], state["spread"]]):
                part.copy_(stored)
        self.value.load_state_dict(state["value"])
        self.optimiser.load_state_dict(state["optimiser"])
        self.scaling = [part.numpy() for part in state["scaling"]]
        return state

    def improve(self, rows, actions, chances, advantages, returns, still_value):
        """Some epochs of the clipped objective over one round. still_value: only the value learns."""
        advantages = (advantages - advantages.mean()) / (advantages.std() + 1e-8)
        for _ in range(EPOCHS):
            for some in self.torch.randperm(len(rows)).split(BATCH):
                ratio = (self.policy(rows[some]).log_prob(actions[some]).sum(-1) - chances[some]).exp()
                gain = self.torch.min(ratio * advantages[some], ratio.clamp(1 - CLIP, 1 + CLIP) * advantages[some]).mean()
                loss = 0.5 * ((self.value(rows[some])[:, 0] - returns[some]) ** 2).mean()
                loss = loss if still_value else loss - gain
                self.optimiser.zero_grad()
                loss.backward()
                self.torch.nn.utils.clip_grad_norm_([*self.mean, self.spread], 0.5)
                self.optimiser.step()


def first_parts(environments, inputs, seed):
    """A policy that has learnt nothing. Its inputs are scaled by those of some random actions."""
    random, count = np.random.default_rng(seed), environments.num_envs
    observation, rows = environments.reset(seed=seed)[0], []
    for _ in range(STEPS):
        action = random.uniform(-1, 1, environments.action_space.shape).astype(np.float32)
        rows.append(learn.rows_of(environments.step(action)[0], inputs, count))
    parts = learn.scaling(np.concatenate(rows), learn.least_of({name: observation[name][0] for name in inputs}, inputs))
    for inner, outer, gain in ((len(parts[0]), 64, 1.0), (64, 64, 1.0), (64, environments.action_space.shape[1], 0.01)):
        parts += [random.normal(0, gain * inner**-0.5, (inner, outer)), np.zeros(outer)]
    return parts


def one_round(environments, learner, observation):
    """STEPS actions in every slot. Returns what was seen, done and gained, and (successes, episodes) that ended."""
    torch, kept, over, count = learner.torch, [], [0, 0], environments.num_envs
    for _ in range(STEPS):
        rows = learner.rows(observation, count)
        with torch.no_grad():
            chance = learner.policy(rows)
            action = chance.sample()
            value = learner.value(rows)[:, 0]
        observation, reward, success, truncated, info = environments.step(action.clamp(-1, 1).numpy())
        reward = reward.copy()
        for slot in np.flatnonzero(truncated):  # the time was up, not the task: what would have followed counts
            with torch.no_grad():
                row = learner.rows(info["final_obs"][slot], 1)
                reward[slot] += DISCOUNT * float(learner.value(row))
        over[0] += int(success.sum())
        over[1] += int((success | truncated).sum())
        kept.append((rows, action, chance.log_prob(action).sum(-1), value, torch.tensor(reward, dtype=torch.float32),
                     torch.tensor(success | truncated)))
    with torch.no_grad():
        after = learner.value(learner.rows(observation, count))[:, 0]
    return observation, kept, after, over


def advantages_of(kept, after):
    """Generalised advantage estimation (Schulman 2016, arXiv 1506.02438): (advantages, returns), a list per action."""
    trace, found = 0, []
    for _, _, _, value, reward, ended in reversed(kept):
        goes_on = (~ended).float()
        trace = reward + DISCOUNT * goes_on * after - value + DISCOUNT * TRACE * goes_on * trace
        found.append((trace, trace + value))
        after = value
    return tuple(zip(*reversed(found)))


def train(options):
    file = options.policy
    if not file.endswith(".npz"):
        sys.exit(f"The policy is {file}; give it a name that ends with .npz.")
    goes_on = os.path.exists(file[:-4] + ".pt")
    if os.path.exists(file) and not goes_on:
        sys.exit(f"{file} exists and was not made here; it is not overwritten, name another file.")
    start = learn.Cloned(options.start) if options.start else None
    known = learn.Cloned(file) if goes_on else start
    if known and options.task not in (None, known.task):
        sys.exit(f"The policy is one of {known.task}, and --task is {options.task}; leave --task out.")
    task = known.task if known else options.task or "Reach"
    environments = VectorEnvironment(task, options.slots, threads=options.threads, organs=TRAINING, particles=options.particles,
                                     breathing=options.breathing, autoreset="same_step",
                                     **{"step_period": learn.STEP_PERIOD, **learn.SETTINGS.get(task, {})})
    inputs = known.inputs if known else learn.inputs_of(task, environments.single_observation_space)
    parts = known.parts if known else first_parts(environments, inputs, options.seed)
    learner = Learner(task, inputs, parts, bool(start), options.seed)
    state = learner.load(file) if goes_on else {"round": 0, "actions": 0, "seconds": 0.0}
    observation, _ = environments.reset(seed=20000 + 1000 * state["round"])
    begun, before = time.monotonic(), state["seconds"]
    while state["seconds"] < 60 * options.minutes:
        observation, kept, after, (successes, episodes) = one_round(environments, learner, observation)
        advantages, returns = advantages_of(kept, after)
        rows, actions, chances = (learner.torch.cat([row[k] for row in kept]) for k in range(3))
        learner.improve(rows, actions, chances, learner.torch.cat(advantages), learner.torch.cat(returns),
                        bool(options.start) and state["round"] < 3)
        state["round"] += 1
        state["actions"] += len(rows)
        state["seconds"] = before + time.monotonic() - begun
        learner.save(file, {name: state[name] for name in ("round", "actions", "seconds")})
        line = {**{name: state[name] for name in ("round", "actions", "seconds")}, "successes": successes,
                "episodes": episodes, "reward": float(sum(row[4].mean() for row in kept) / len(kept)),
                "deviation": float(learner.spread.exp().mean().detach())}
        with open(file[:-4] + ".jsonl", "a") as out:
            out.write(json.dumps(line) + "\n")
        learn.show(f"round {line['round']}, {line['seconds'] / 60:.1f} of {options.minutes:g} min, {line['actions']} actions, "
                   f"{successes} of {episodes} episodes succeeded, deviation {line['deviation']:.2f}")
    print(f"\n{state['actions']} actions in {state['seconds'] / 60:.1f} minutes: {file}")


def curve(options):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot

    with open(options.policy[:-4] + ".jsonl") as lines:
        rows = [json.loads(line) for line in lines]
    width = max(1, len(rows) // 30)
    groups = [rows[k:k + width] for k in range(0, len(rows), width)]
    groups = [group for group in groups if sum(row["episodes"] for row in group)]
    share = [100 * sum(row["successes"] for row in group) / sum(row["episodes"] for row in group) for group in groups]
    figure, axes = pyplot.subplots(figsize=(6.4, 3.6), constrained_layout=True)
    axes.plot([group[-1]["actions"] / 1000 for group in groups], share, marker="o", markersize=3, color="tab:blue")
    axes.set(xlabel="actions [thousands]", ylabel="episodes that succeed [%]", ylim=(0, 102), xlim=(0, None))
    axes.secondary_xaxis("top", functions=_minutes(rows)).set_xlabel("wall time [min]")
    axes.grid(alpha=0.3)
    figure.savefig(options.picture, dpi=150)


def _minutes(rows):
    per = rows[-1]["seconds"] / 60 / (rows[-1]["actions"] / 1000)
    return lambda thousands: thousands * per, lambda minutes: minutes / per


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    one = commands.add_parser("train", help="trains, or goes on")
    one.add_argument("policy", help="file to write, .npz")
    one.add_argument("--task", help="of vibe.env (default: Reach, or that of --start)")
    one.add_argument("--start", help="a policy of learn.py clone to begin with (default: none)")
    one.add_argument("--minutes", type=float, default=20, help="of wall time in all (default: %(default)s)")
    one.add_argument("--slots", type=int, default=16, help="episodes side by side (default: %(default)s)")
    one.add_argument("--threads", type=int, default=None, help="that step them (default: one per core)")
    one.add_argument("--particles", type=int, default=1000, help="of the wall; fewer are faster (default: %(default)s)")
    one.add_argument("--breathing", choices=tuple(BREATHING), default=None, help="of the stomachs (default: still)")
    one.add_argument("--seed", type=int, default=1)
    one.set_defaults(run=train)
    one = commands.add_parser("curve", help="draws the share of episodes that succeed")
    one.add_argument("policy")
    one.add_argument("picture", help="file to write, .png")
    one.set_defaults(run=curve)
    learn.run(parser.parse_args())


if __name__ == "__main__":
    main()
