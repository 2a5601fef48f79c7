#!/usr/bin/env python3
"""Lets Stable-Baselines3 take the environments as they are: its checker, PPO side by side, SAC with hindsight. Says what each
took; what these libraries do not take raises. Needs stable-baselines3 and gymnasium."""

import argparse
import statistics
import time
import warnings

import gymnasium
import torch
from stable_baselines3 import PPO, SAC, HerReplayBuffer
from stable_baselines3.common.env_checker import check_env
from stable_baselines3.common.env_util import make_vec_env
from stable_baselines3.common.vec_env import VecNormalize

from vibe.env import HELD_OUT, TRAINING, Environment, GoalEnvironment

PARTS = 10  # of a training, after each of which it says how far it is


def ppo(settings, seed):
    """A model that learns, what it does, and the class of environments that it was made for."""
    slots = VecNormalize(make_vec_env("vibe/Reach-v0", 8, env_kwargs=settings, seed=seed), gamma=0.98)
    model = PPO("MultiInputPolicy", slots, n_steps=256, batch_size=256, gamma=0.98, seed=seed)
    return model, lambda seen: model.predict(slots.normalize_obs(seen), deterministic=True)[0], Environment


def sac(settings, seed):
    goals = gymnasium.make("vibe/ReachGoal-v0", **settings)
    model = SAC("MultiInputPolicy", goals, replay_buffer_class=HerReplayBuffer, learning_starts=400, gamma=0.95, seed=seed)
    return model, lambda seen: model.predict(seen, deterministic=True)[0], GoalEnvironment


LEARNERS = {"ppo": ppo, "sac": sac}


def success(act, environment, episodes):
    """Of how many episodes, with other seeds than those of the training, and the median time of those that succeed [s]."""
    times = []
    for seed in range(1000, 1000 + episodes):
        seen, over = environment.reset(seed=seed)[0], False
        while not over:
            seen, _, terminated, truncated, info = environment.step(act(seen))
            over = terminated or truncated
        times += [info["time"]] * terminated
    return len(times), statistics.median(times or [0])


def learn(model, actions):
    begin, before = time.process_time(), model.num_timesteps
    while model.num_timesteps < before + actions:
        model.learn(max(1, actions // PARTS), reset_num_timesteps=False)
        reached = statistics.fmean(model.ep_success_buffer or [0])
        print(f"{type(model).__name__}: {model.num_timesteps} actions, {time.process_time() - begin:.0f} s of CPU time; "
              f"{reached:.0%} of the last {len(model.ep_success_buffer)} episodes", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", choices=LEARNERS, help="one of the algorithms")
    parser.add_argument("--actions", type=int, default=2000, help="of each algorithm (default: %(default)s)")
    parser.add_argument("--episodes", type=int, default=20, help="of the evaluation after it (default: %(default)s)")
    parser.add_argument("--seed", type=int, default=1, help="of the training (default: %(default)s)")
    parser.add_argument("--all-organs", action="store_true", help="train on TRAINING and evaluate on HELD_OUT, instead of one stomach")
    options = parser.parse_args()
    torch.set_num_threads(1)
    settings = {"particles": 300, "organs": TRAINING if options.all_organs else [("sthenic", 1.0)], "action": "tip"}
    with warnings.catch_warnings():
        warnings.simplefilter("error", DeprecationWarning)
        for environment in (Environment(**settings), GoalEnvironment(**settings)):
            check_env(environment, warn=False)
    for name in [options.only] if options.only else LEARNERS:
        model, act, kind = LEARNERS[name](settings, options.seed)
        learn(model, options.actions)
        reached, median = success(act, kind(**{**settings, "organs": HELD_OUT if options.all_organs else settings["organs"]}), options.episodes)
        print(f"{type(model).__name__}: {reached} of {options.episodes} episodes succeed, in {median:.1f} s (median)")


if __name__ == "__main__":
    main()
