# Training sets before LeRobot (0.4.4 for v3.0, 0.3.3 for v2.1), robomimic and Minari, from the registry of Python with torch, 6 GB.
# kind: computing
# cost: 300
# timeout: 3600
# packages: vibe_core vibe_python
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

onDemand 'the loaders of training sets'
readonly tests=$root/src/vibe_python/test environment=$root/build/judges
getPackages() { "$environment/bin/pip" install --quiet --retries 1 --timeout 10 "$@"; }
makeEnvironment() {
  cmp -s "$tests/judges.txt" "$environment/installed.txt" && return
  rm -rf "$environment" && /usr/bin/python3 -m venv "$environment" && getPackages --requirement "$tests/judges.txt" &&
    getPackages --no-deps robomimic==0.3.0 && getPackages --no-deps --target "$environment/v2.1" lerobot==0.3.3 datasets==3.6.0 &&
    getPackages --no-deps --require-hashes --target "$environment/writer" --requirement "$tests/reader_tools.txt" &&
    cp "$tests/judges.txt" "$environment/installed.txt"
}
if ! makeEnvironment >"$scratch/pip.txt" 2>&1; then
  echo "skipped the loaders of training sets (pip could not install what judges.txt names: $(tail -n 1 "$scratch/pip.txt"))"
  exit 0
fi

writes() { (set +u && source "$root/devel/setup.bash" && PYTHONPATH=$PYTHONPATH:$environment/writer exec /usr/bin/python3 -B "$tests/judge_sets.py" write "$scratch"); }
reads() { HF_HUB_OFFLINE=1 HF_HOME=$scratch/cache "$environment/bin/python" -B "$tests/judge_sets.py" "$@"; }
check 'sets of every format' writes
check 'LeRobot reads every row of v3.0, with pictures' reads read_lerobot "$scratch" v3.0
PYTHONPATH=$environment/v2.1 check 'LeRobot 0.3.3 reads every row of v2.1, with pictures' reads read_lerobot "$scratch" v2.1
check 'robomimic reads the demonstrations and their masks' reads read_robomimic "$scratch"
check 'Minari reads every episode' reads read_minari "$scratch"
