#!/usr/bin/env bash
# kind: computing
# cost: 10
# packages: vibe_core vibe_hardware vibe_benchmarks
# Every program that takes a scene either works with one that has no tool, or ends with one sentence that says what is
# missing.
source "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/../lib/check.sh"
set +u; source "$root/devel/setup.bash"; set -u

cat >"$scratch/bare.yaml" <<'END'
name: bare
geometry: {kind: sphere, particles: 162, radius: 5 cm}
tissue: {model: shell}
END
printf 'name: hand\nactions:\n  - {wait: 0.1 s}\n' >"$scratch/hand.yaml"

program() { (cd "$scratch" && "$root/devel/lib/$1" "${@:2}" --scene bare.yaml); }

check 'no tool: vibe_headless runs' program vibe_core/vibe_headless --script hand.yaml
check 'no tool: vibe_headless refuses a protocol' refuses 2 "has no scope" program vibe_core/vibe_headless \
  --script "$root/src/vibe_core/trainees/first.yaml"
check 'no tool: vibe_haptic_loop' refuses 2 "has no scope" program vibe_hardware/vibe_haptic_loop --script hand.yaml
for mode in scenarios outcomes; do
  check "no tool: vibe_sutures $mode" refuses 2 "needs the sections" program vibe_benchmarks/vibe_sutures $mode --quick
done
for mode in states hard refinement; do
  check "no tool: vibe_contact $mode" refuses 2 "needs the sections" program vibe_benchmarks/vibe_contact $mode
done
check 'no tool: vibe_policy' refuses 2 "needs the sections" program vibe_benchmarks/vibe_policy

# a program that is new here needs a line above
onlyThese() {
  local found
  found=$(cd "$root/src" && grep -l 'loadScene(' ./*/programs/*.cpp | sed -E 's#.*/##; s/(_main)?\.cpp$//' | sort)
  echo "$found"
  [ "$(xargs <<<"$found")" = 'vibe_contact vibe_haptic_loop vibe_headless vibe_policy vibe_sutures' ]
}
check 'no tool: these are all programs that take a scene' onlyThese
