# Two hours of simulated time: the memory of the simulator does not grow.
# kind: computing
# timeout: 10800
# packages: vibe_system_tests
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

isSlowRun || skip 'two hours of the simulator (scripts/test --slow makes them)'

check 'two hours of simulated time, and the memory of the simulator does not grow' \
  gives 0 "$scratch/soak.txt" builtSystemTest soak_sim --minutes 120
if [ -s "$scratch/soak.txt" ]; then sed 's/^/    /' "$scratch/soak.txt"; fi

# The control: that the check can fail.
failsOnGrowth() {
  gives 1 "$scratch/soak.txt" builtSystemTest soak_sim --minutes 5 --most-growth -1000 && grep -q '^soak: memory grows by' "$scratch/soak.txt"
}
check 'growth that is not allowed is an error' failsOnGrowth
