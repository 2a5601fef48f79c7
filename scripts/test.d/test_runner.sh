# scripts/lib/run_tests.py, which runs all tests, with made-up ones; and what scripts do in a workspace that is built.
# kind: waiting
# cost: 20
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

tests=$root/scripts/lib/run_tests_test.py
mapfile -t names < <(sed -nE 's/^    def test_([a-z_]+)\(self\):/\1/p' "$tests")

# runs NAME: one test of the runner; most of them sleep, so that several run at once.
runs() {
  local status=0
  /usr/bin/python3 -B "$tests" "RunnerTest.test_$1" >"$scratch/$1.out" 2>&1 </dev/null || status=$?
  echo "$status" >"$scratch/$1.status"
}

passed() {
  cat "$scratch/$1.out"
  [ "$(<"$scratch/$1.status")" -eq 0 ]
}

for name in "${names[@]}"; do
  while [ "$(jobs -rp | wc -l)" -ge 4 ]; do wait -n || true; done
  runs "$name" &
done
wait
for name in "${names[@]}"; do check "runner: ${name//_/ }" passed "$name"; done

# A workspace without packages: whatever looks for them fails.
tree=$scratch/tree
mkdir -p "$tree/src"
cp -r "$root/scripts" "$tree/"
check 'build does nothing in a workspace that is built' env VIBE_WORKSPACE_IS_BUILT="$tree" "$tree/scripts/build" --quiet
check 'control: it does in another one' refuses 1 'no package.xml' \
  env VIBE_WORKSPACE_IS_BUILT="$root/elsewhere" "$tree/scripts/build" --quiet
