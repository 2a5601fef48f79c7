# scripts/cohort with the real simulator and a protocol of a tenth of a second: locally, through Dask, with a bad scene.
# kind: computing
# cost: 60
# packages: vibe_sessions
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

devel=$root/devel${VIBE_VARIANT:-}
[ -x "$devel/lib/vibe_core/vibe_headless" ] && [ -e "$devel/lib/vibe_sessions/cohort" ] ||
  skip 'cohorts (not built; scripts/build builds them)'
export PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin
export PYTHONWARNINGS=ignore
pids=()
trap '[ ${#pids[@]} -eq 0 ] || kill "${pids[@]}" 2>/dev/null; wait; rm -rf -- "$scratch"' EXIT

inWorkspace() {
  (set +u && source "$devel/setup.bash" && cd "$scratch" && exec "$@")
}

# cohort FOLDER [OPTION...]: four trainees of the short protocol
cohort() {
  inWorkspace "$devel/lib/vibe_sessions/cohort" --output "$scratch/$1" --script "$scratch/short.yaml" --count 2 \
    --novice 0 1 "${@:2}"
}

printf 'name: short\ngoals:\n  - wait: {for: 0.1 s}\n' >"$scratch/short.yaml"
printf 'colour: red\n' >"$scratch/bad.yaml"

aRowPerSession() {
  cohort local --jobs 1 && [ "$(cut -d, -f 3,4 "$scratch/local/cohort.csv" | tr '\n' ' ')" = \
    'novice,seed 0,1 0,2 1,1 1,2 ' ]
}

headless() {
  inWorkspace "$devel/lib/vibe_core/vibe_headless" --quiet "$@"
}

# Names and numbers are those of vibe_headless; another seed is another state.
theMeasuresOfHeadless() {
  headless --script "$scratch/short.yaml" --seed 2 --novice 1 --measures "$scratch/measures.json" &&
    /usr/bin/python3 - "$scratch" <<'PYTHON'
import csv, json, sys
outcome = json.load(open(sys.argv[1] + "/measures.json"))
values = {name: measure["value"] for name, measure in outcome["measures"].items()}
*_, other, row = csv.DictReader(open(sys.argv[1] + "/local/cohort.csv"))
assert list(row) == ["scene", "mesh", "novice", "seed", *values, "state_hash"], list(row)
wrong = {n: row[n] for n, v in values.items() if row[n] != ("" if v is None else f"{v:.6g}")}
assert not wrong and values["goals"] == 1, wrong
assert row["state_hash"] == outcome["state_hash"] != other["state_hash"], (row, other)
PYTHON
}

# What is done is not done again: rows keep their times.
goesOn() {
  local before
  rm "$scratch/local/rows/stomach_novice1_seed2.json" "$scratch/local/cohort.csv"
  before=$(stat -c %y "$scratch/local/rows/stomach_novice0_seed1.json")
  inWorkspace "$devel/lib/vibe_sessions/cohort" --output local &&
    [ "$(stat -c %y "$scratch/local/rows/stomach_novice0_seed1.json")" = "$before" ] &&
    [ "$(wc -l <"$scratch/local/cohort.csv")" = 5 ]
}

startDask() {
  local address='' k
  inWorkspace dask-scheduler --host 127.0.0.1 --port 0 --no-dashboard --scheduler-file "$scratch/dask.json" \
    >"$scratch/scheduler.log" 2>&1 &
  pids+=($!)
  for k in $(seq 100); do
    address=$(sed -nE 's/.*"address": "([^"]+)".*/\1/p' "$scratch/dask.json" 2>/dev/null || true)
    [ -z "$address" ] || break
    sleep 0.2
  done
  for k in 1 2; do
    inWorkspace dask-worker "$address" --host 127.0.0.1 --nthreads 1 --no-dashboard --local-directory "$scratch" \
      >"$scratch/worker$k.log" 2>&1 &
    pids+=($!)
  done
  scheduler=${address#tcp://}
}

throughDaskTheSame() {
  cohort dask --scheduler "$scheduler" && cmp "$scratch/dask/cohort.csv" "$scratch/local/cohort.csv"
}

aBadSceneIsListed() {
  gives 1 "$scratch/bad.txt" cohort bad --scene "$scratch/bad.yaml" package://vibe_core/scenes/stomach_j.yaml &&
    grep -q 'bad_novice0_seed1 and 3 more failed: .*bad.yaml:1.*colour' "$scratch/bad.txt" &&
    [ "$(wc -l <"$scratch/bad/cohort.csv")" = 5 ] && [ "$(wc -l <"$scratch/bad/failed.csv")" = 5 ]
}

drawsACurve() {
  inWorkspace "$devel/lib/vibe_sessions/cohort" --plot local && [ -s "$scratch/local/learning_curve.png" ]
}

# publishSet FOLDER [OPTION...]: seconds of four sessions, with pictures, on four organs
publishSet() {
  inWorkspace "$devel/lib/vibe_sessions/publish_set" --output "$scratch/$1" --count 4 --duration 2 "${@:2}"
}

# One that was interrupted goes on to the same bytes, too.
aSetIsTheSameBytes() {
  publishSet set --jobs 1 && (cd "$scratch/set" && sha256sum --quiet --check SHA256SUMS) || return 1
  publishSet set_dask --scheduler "$scheduler" && cmp "$scratch"/set{,_dask}/SHA256SUMS || return 1
  rm -r "$scratch/set_dask/rows/"000_* "$scratch/set_dask/sessions/"002_* "$scratch/set_dask/rows/"002_*
  publishSet set_dask --jobs 2 && cmp "$scratch"/set{,_dask}/SHA256SUMS
}

# Each recording of the set is repeated to the bit, in a process of its own, where nothing else of the set is.
aSessionIsRepeatedFromItsFile() {
  local folder
  mv "$scratch/set" "$scratch/set_away"
  for folder in "$scratch"/set_away/sessions/*; do
    mkdir "$scratch/alone" && cp "$folder/session.bag" "$scratch/alone" || return 1
    inWorkspace "$devel/lib/vibe_sim/vibe_replay" alone/session.bag | tee "$scratch/said.txt" &&
      grep -q '^the same: all 120 steps' "$scratch/said.txt" &&
      grep -qF "\"$(sed -n 's/^state hash: //p' "$scratch/said.txt")\"" "$folder/measures.json" || return 1
    rm -r "$scratch/alone"
  done
}

startDask
check 'cohorts: a row per session' aRowPerSession
check 'cohorts: the measures of vibe_headless' theMeasuresOfHeadless
check 'cohorts: go on where they ended' goesOn
check 'cohorts: through Dask the same table' throughDaskTheSame
check 'cohorts: a bad scene is listed, the others go on' aBadSceneIsListed
check 'cohorts: a learning curve' drawsACurve
if [ -n "${VIBE_SLOW_TESTS:-}" ]; then
  check 'published set: local and through Dask the same bytes' aSetIsTheSameBytes
  check 'published set: a session is repeated from its file alone' aSessionIsRepeatedFromItsFile
else
  echo 'skipped published set: the same bytes everywhere, and sessions from their files alone (scripts/test --slow makes it)'
fi
check 'cohorts: another plan is refused' refuses 2 'another plan: count was 2, not 3' cohort local --count 3
check 'vibe_headless: a skill that is none' refuses 2 '--novice' headless --novice 1.5
check 'vibe_headless: a skill without a protocol' refuses 2 '--novice' headless --novice 1
check 'vibe_headless: no such protocol' refuses 2 'none.yaml' headless --script "$scratch/none.yaml"
check 'vibe_headless: no such surface' refuses 2 'none.obj' headless --mesh "$scratch/none.obj"
check 'vibe_headless: no such folder' refuses 2 'none/a.json' \
  headless --script "$scratch/short.yaml" --measures "$scratch/none/a.json"
