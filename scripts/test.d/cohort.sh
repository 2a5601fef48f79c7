# vibe_cohort as a lab meets it: a row per trainee, the same rows for the same seeds, one sentence for bad input.
# kind: computing
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

program=$root/devel${VIBE_VARIANT:-}/lib/vibe_core/vibe_cohort
if [ ! -x "$program" ]; then
  echo 'skipped vibe_cohort (not built; scripts/build builds it)'
  exit 0
fi

# It finds the default scene through the environment of the workspace.
cohort() {
  (set +u && source "$root/devel${VIBE_VARIANT:-}/setup.bash" && exec "$program" "$@")
}

printf 'name: short\ngoals:\n  - wait: {for: 0.1 s}\n' >"$scratch/short.yaml"

columns() {
  head -n 1 "$1" | tr , '\n' | wc -l
}

aRowPerTrainee() {
  cohort --script "$scratch/short.yaml" --count 2 --novice 0 1 --csv "$scratch/a.csv"
  [ "$(wc -l <"$scratch/a.csv")" = 5 ] && [ "$(cut -d, -f 1,2 "$scratch/a.csv" | tr '\n' ' ')" = \
    'novice,seed 0,1 1,1 0,2 1,2 ' ] && awk -F, -v n="$(columns "$scratch/a.csv")" 'NF != n { exit 1 }' "$scratch/a.csv"
}

# Rows are appended without names of columns; those of the same seed are the same, whatever ran before.
sameSeedSameRow() {
  cohort --script "$scratch/short.yaml" --count 1 --first-seed 2 --novice 1 --csv "$scratch/a.csv"
  [ "$(tail -n 1 "$scratch/a.csv")" = "$(sed -n 5p "$scratch/a.csv")" ] && [ "$(wc -l <"$scratch/a.csv")" = 6 ] &&
    [ "$(sed -n 5p "$scratch/a.csv")" != "$(sed -n 4p "$scratch/a.csv")" ]
}

check 'vibe_cohort: a row per trainee' aRowPerTrainee
check 'vibe_cohort: the same seed, the same row' sameSeedSameRow
check 'vibe_cohort --help' cohort --help
check 'vibe_cohort: no such protocol' refuses 2 'none.yaml' cohort --script "$scratch/none.yaml"
check 'vibe_cohort: no such surface' refuses 2 'none.obj' \
  cohort --script "$scratch/short.yaml" --mesh "$scratch/none.obj"
check 'vibe_cohort: a skill that is none' refuses 2 '--novice' cohort --novice 1.5
check 'vibe_cohort: no trainee' refuses 2 '--count' cohort --count 0
check 'vibe_cohort: no such folder' refuses 2 'Cannot write' \
  cohort --script "$scratch/short.yaml" --csv "$scratch/none/a.csv"
