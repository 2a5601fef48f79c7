#!/usr/bin/env python3
"""Lets Stable-Baselines3 take the environments as they are: its checker, PPO side by side, SAC with hindsight. Says what each
took; what these libraries do not take raises. Needs stable-baselines3 and gymnasium."""

import argparse
import time
import warnings

import gymnasium
import torch
from stable_baselines3 import PPO, SAC, HerReplayBuffer
from stable_baselines3.common.env_checker import check_env
from stable_baselines3.common.env_util import make_vec_env

from vibe.env import Environment, GoalEnvironment


def success(model, environment, episodes):
    """Share of episodes with other seeds than those of the training."""
    reached = 0
    for seed in range(1000, 1000 + episodes):
        seen, over = environment.reset(seed=seed)[0], False
        while not over:
            seen, _, terminated, truncated, _ = environment.step(model.predict(seen, deterministic=True)[0])
            over = terminated or truncated
        reached += terminated
    return reached / episodes


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--actions", type=int, default=2000, help="of each algorithm (default: %(default)s)")
    parser.add_argument("--episodes", type=int, default=20, help="of the evaluation after it (default: %(default)s)")
    options = parser.parse_args()
    torch.set_num_threads(1)
    settings = {"particles": 300, "organs": [("sthenic", 1.0)], "action": "tip"}
    with warnings.catch_warnings():
        warnings.simplefilter("error", DeprecationWarning)
        for environment in (Environment(**settings), GoalEnvironment(**settings)):
            check_env(environment, warn=False)
    ppo = PPO("MultiInputPolicy", make_vec_env("vibe/Reach-v0", 4, env_kwargs=settings), n_steps=250, seed=1)
    goals = gymnasium.make("vibe/ReachGoal-v0", **settings)
    sac = SAC("MultiInputPolicy", goals, replay_buffer_class=HerReplayBuffer, learning_starts=400, gamma=0.95, seed=1)
    for model, environment in ((ppo, Environment(**settings)), (sac, GoalEnvironment(**settings))):
        begin = time.process_time()
        model.learn(options.actions)
        print(f"{type(model).__name__}: {model.num_timesteps} actions in {time.process_time() - begin:.0f} s of CPU time; "
              f"{success(model, environment, options.episodes):.0%} of {options.episodes} episodes succeed")


if __name__ == "__main__":
    main()
