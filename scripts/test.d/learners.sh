# Stable-Baselines3 takes the environments as they are: checker, PPO, SAC with hindsight, some hundred actions each.
# kind: computing
# timeout: 1800
# packages: vibe_core vibe_python
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

isSlowRun || skip 'Stable-Baselines3 (scripts/test --slow lets it learn)'
/usr/bin/python3 -c 'import torch, venv' 2>/dev/null ||
  skip 'Stable-Baselines3 (python3-torch or python3-venv is not installed)'
pythonEnvironment learners "$root/src/vibe_python/test/learners.txt" --no-deps >"$scratch/pip" 2>&1 ||
  skip 'Stable-Baselines3 (it cannot be downloaded)'

learns() {
  set +u && source "$root/devel/setup.bash"
  "$root/build/learners/bin/python" -B "$root/src/vibe_python/scripts/learners.py" --actions 1000 --episodes 2 >"$scratch/said" &&
    cat "$scratch/said" && [ "$(grep -c 'episodes succeed, in ' "$scratch/said")" -eq 2 ]
}
check 'PPO and SAC with hindsight of Stable-Baselines3' learns
