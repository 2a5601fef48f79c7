# Two hours of simulated time: the memory of the simulator does not grow.
# kind: computing
# timeout: 10800
# packages: vibe_system_tests
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

onDemand 'two hours of the simulator'

soak() {
  builtSystemTest soak_sim "$@" >"$scratch/soak.txt" 2>&1 || { cat "$scratch/soak.txt"; return 1; }
}
check 'two hours of simulated time, and the memory of the simulator does not grow' soak --minutes 120
if [ -s "$scratch/soak.txt" ]; then sed 's/^/    /' "$scratch/soak.txt"; fi

# The control: that the check can fail.
failsOnGrowth() {
  local status=0
  soak --minutes 5 --most-growth -1000 || status=$?
  [ "$status" -eq 1 ] && grep -q '^soak: memory grows by' "$scratch/soak.txt"
}
check 'growth that is not allowed is an error' failsOnGrowth
