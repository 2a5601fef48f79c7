# The main job whole and twice, without ROS, and from its recording: one hash. Minutes long.
# kind: computing
# timeout: 3600
# packages: vibe_bringup
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

onDemand 'the whole main job'
unset DISPLAY

hashOf() { sed -n 's/^state hash: //p' "$1"; }

session() {
  "$root/scripts/run" --headless --fast --duration 60 --output "$scratch/$1" >"$scratch/$1.txt" 2>&1 ||
    { cat "$scratch/$1.txt"; return 1; }
}

sameHash() {
  local first second
  first=$(hashOf "$scratch/first.txt") second=$(hashOf "$1")
  [ -n "$first" ] && [ "$first" = "$second" ] || { echo "hashes '$first' and '$second'"; return 1; }
}

headless() {
  (set +u && source "$root/devel/setup.bash" && rosrun vibe_core vibe_headless --quiet --duration 60 \
    --script package://vibe_core/trainees/first.yaml) >"$scratch/headless.txt"
  sameHash "$scratch/headless.txt"
}

replayed() {
  "$root/scripts/replay" "$scratch/first/session.bag" >"$scratch/replay.txt" || { cat "$scratch/replay.txt"; return 1; }
  sameHash "$scratch/replay.txt"
}

noWarning() { grep -qE '^warnings +0$' "$scratch/first.txt"; }

check 'the main job runs' session first
check 'it warns of nothing' noWarning
check 'it runs again' session second
check 'both runs have one hash' sameHash "$scratch/second.txt"
check 'without ROS the hash is the same' headless
check 'the recording repeats to the same hash' replayed
