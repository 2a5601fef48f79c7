# scripts/dataset: data sets of a short session, and what is refused. What the numbers of the files are is tested in
# src/vibe_endoscope/test/dataset, with a recording of which everything is known.
# kind: computing
# cost: 60
# packages: vibe_bringup vibe_system_tests
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

ordinaryBuild 'data sets of a session' lib/vibe_endoscope/vibe_dataset

bag=$scratch/session/session.bag
dataset() { "$root/scripts/dataset" "$bag" --width 160 --height 120 --rate 2 "$@"; }
checkFiles() { systemTest check_dataset "$@"; }
# refusesNew CODE PATTERN WORDS...: one line on stderr, and no folder is left, neither the new one nor the one around it.
refusesNew() {
  refuses "$1" "$2" errorsOf "$root/scripts/dataset" "${@:3}" --output "$scratch/new/folder" || return 1
  [ ! -e "$scratch/new" ] || { echo 'a folder is left'; return 1; }
}
errorsOf() { "$@" 2>&1 >/dev/null; }

runsASession() { "$root/scripts/run" --headless --fast --script eye --duration 3 --output "$scratch/session"; }
check 'dataset: a short session is recorded' runsASession

check 'dataset: a data set with everything is made' dataset --output "$scratch/all" \
  --content depth,normals,labels,flow,particles,sutures
check 'dataset: files, shapes and types are as documented' checkFiles files "$scratch/all"
check 'dataset: the data sheet is complete' checkFiles sheet "$scratch/all"

check 'dataset: seed 7 is drawn' dataset --output "$scratch/seven" --seed 7
check 'dataset: its data sheet names the values of the seed' checkFiles sheet "$scratch/seven"
check 'dataset: seed 7 is drawn again' dataset --output "$scratch/again" --seed 7
check 'dataset: the same call gives the same bytes' diff -r "$scratch/seven" "$scratch/again"
check 'control, must fail: the bytes of another seed' fails diff -rq "$scratch/seven" "$scratch/all"

check 'dataset: mucosa and light of seed 7 are drawn' dataset --output "$scratch/look" --seed 7 --vary mucosa,light
check 'dataset: they change every image and no truth' checkFiles look "$scratch/all" "$scratch/look"
check 'control, must fail: the lens changes the truth' fails checkFiles look "$scratch/all" "$scratch/seven"
rm "$scratch/look/depth/000003.npy"
check 'control, must fail: a data set with a missing file' fails checkFiles files "$scratch/look"
sed -i 's/temperature [0-9.]*//' "$scratch/again/README.md"
check 'control, must fail: a data sheet with a missing value' fails checkFiles sheet "$scratch/again"

# A call that is killed while it writes leaves nothing that looks like a data set, and the next one takes its folder.
killedLeavesNothing() {
  local folder=$scratch/killed pid
  setsid "$root/scripts/dataset" "$bag" --width 160 --height 120 --rate 0 --output "$folder" >"$scratch/killed.txt" 2>&1 &
  pid=$!
  for _ in $(seq 1800); do [ ! -e "$folder/.part-dataset/image/000001.png" ] || break; sleep 0.1; done
  kill -KILL -- "-$pid" || { cat "$scratch/killed.txt"; return 1; }
  wait "$pid" || true
  sleep 1
  [ -z "$(ls "$folder")" ] && [ -e "$folder/.part-dataset" ] || { ls -A "$folder"; return 1; }
  dataset --output "$folder" && diff -r "$folder/image" "$scratch/all/image" && [ -z "$(find "$folder" -name '.*' -mindepth 1)" ]
}
check 'dataset: a call that is killed leaves nothing that looks whole' killedLeavesNothing

check 'dataset asks for a recording' refuses 2 'which recording' "$root/scripts/dataset" --output "$scratch/new"
check 'dataset asks for a folder' refuses 2 'where to' "$root/scripts/dataset" "$bag"
check 'dataset names a recording that is not there' refusesNew 2 "no file 'nowhere.bag'" nowhere.bag
check 'dataset does not overwrite' refuses 2 'is not empty' "$root/scripts/dataset" "$bag" --output "$scratch/all"
# some of what the program tells before and after the recording is repeated; the rest is in dataset_test.py
check 'dataset refuses times after the end' refusesNew 1 "--from: '.*session.bag' ends at .* give a time" "$bag" --from 500
head -c 100000 "$bag" >"$scratch/half.bag"
check 'dataset refuses half of a recording' refusesNew 1 "half.bag' cannot be read as a recording" "$scratch/half.bag"
check 'dataset refuses times without a state' refusesNew 1 'no state between --from and --to; give other' "$bag" \
  --from 2.001 --to 2.002
