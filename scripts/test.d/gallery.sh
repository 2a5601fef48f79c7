# The examples of docs/gallery.md run as they are, and the pages show them as they are.
# kind: computing
# cost: 90
# timeout: 600
# packages: docs README.md vibe_bringup vibe_python
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

gallery=$root/docs/gallery
showsTheFiles() { /usr/bin/python3 -B "$root/scripts/lib/check_code_blocks.py" "$1" "$root"; }
check 'code in README.md is that of the file it names' showsTheFiles "$root/README.md"
check 'code in docs/gallery.md is that of the files it names' showsTheFiles "$root/docs/gallery.md"
isShort() { [ -z "$(find "$gallery" -type f -exec awk 'END { if (NR > 60) print FILENAME }' {} \;)" ]; }
check 'no example of the gallery has more than 60 lines' isShort
isShown() {
  local file
  for file in "$gallery"/*; do grep -qF "<!-- file: docs/gallery/${file##*/} -->" "$root/docs/gallery.md" || { echo "$file"; return 1; }; done
}
check 'every file of the gallery is in its page' isShown

isOrdinary vibe_sim/sim_node || skip 'the examples (they need the ordinary build)'
set +u
# shellcheck disable=SC1091
source "$root/devel/setup.bash"
set -u

isPicture() { [ "$(head -c 4 "$1" | tail -c 3)" = PNG ]; }

# A graph of its own: a master and the simulator, as the page says, and a recorder. In simulated time, so that a busy
# machine is slower and nothing else.
options=() # of the simulator, beside these
recording=session
withSimulator() {
  local port status=0
  port=$(freePort)
  export ROS_MASTER_URI=http://127.0.0.1:$port ROS_HOSTNAME=127.0.0.1
  rosmaster --core -p "$port" >/dev/null 2>&1 &
  until rosparam set /use_sim_time true >/dev/null 2>&1; do sleep 0.2; done
  rosrun vibe_sim vibe_record "$scratch/$recording.bag" >"$scratch/record.log" 2>&1 &
  local recorder=$!
  rosrun vibe_sim sim_node _scene:=package://vibe_core/scenes/stomach.yaml _time_source:=sim _await_recorder:=true \
    "${options[@]}" >"$scratch/sim.log" 2>&1 &
  "$@" || status=$?
  kill "$recorder" && wait "$recorder" || true
  # shellcheck disable=SC2046
  kill $(jobs -p) 2>/dev/null && wait || true
  [ "$status" -eq 0 ] || cat "$scratch/sim.log"
  return "$status"
}
drivesAndReads() {
  "$gallery/forces.py" 8 "$scratch/forces.csv" "$scratch/forces.png" >"$scratch/forces.txt" 2>&1 &
  local reader=$!
  prints 'mm deep, 0\.[5-9]' timeout 120 "$gallery/drive_and_read.py" && wait "$reader"
}
check 'gallery: a program drives and reads' withSimulator drivesAndReads
readsForces() {
  cat "$scratch/forces.txt"
  grep -qE '^[0-9]+ samples, [01]\.[0-9]+ N at most$' "$scratch/forces.txt" && isPicture "$scratch/forces.png" &&
    [ "$(wc -l <"$scratch/forces.csv")" -gt 100 ]
}
check 'gallery: forces of a session' readsForces
decidesEachStep() {
  options=(_lockstep:=true _fast:=true) recording=$1
  withSimulator prints '^10\.0 s: 0\.3000 N at 1[0-9.]+ mm$' timeout 300 "$gallery/lockstep.py" 10 >"$scratch/$1.txt"
}
decidesTheSameAgain() { decidesEachStep again && cmp "$scratch/once.txt" "$scratch/again.txt"; }
findsTheEdit() {
  local said
  said=$("$gallery/edited.py" "$scratch/session.bag" "$scratch/copy.bag")
  printf '%s\n' "$said"
  grep -q '^status 0: the same: ' <<<"$said" && grep -q '^status 1: NOT the same' <<<"$said"
}
check 'gallery: a controller in lock-step' decidesEachStep once
check 'gallery: the same controller gives the same digits' decidesTheSameAgain
check 'gallery: a replay, and one of a recording that was edited' findsTheEdit

readsASurface() { prints '^[0-9]+ mL, [0-9]+ mL at (9\.9|10\.0|10\.1) mmHg$' "$gallery/own_mesh.py" "$scratch/flat.obj" "$scratch/own.png" && isPicture "$scratch/own.png"; }
check 'gallery: your own mesh' readsASurface
sees() { prints '^body +[7-9][0-9]\.[0-9] % seen$' "$gallery/inspection.py" "$scratch/inspection.png" && isPicture "$scratch/inspection.png"; }
check 'gallery: what was not seen' sees
sweeps() { prints '^110 kPa: 3[0-9]\.[0-9] mL/mmHg$' "$gallery/sweep.py" "$scratch/sweep.png" && isPicture "$scratch/sweep.png"; }
check 'gallery: a sweep' sweeps
makesACohort() { prints ',1,1$' "$gallery/cohort.sh" "$scratch/cohort" 1 && isPicture "$scratch/cohort/cohort.png"; }
check 'gallery: a cohort' makesACohort
holds() { prints 'ok$' rosrun vibe_sessions regression "$gallery/balloon.regression.yaml"; }
check 'gallery: a regression holds' holds
tracks() { prints 'frames, error of the slide [0-9]\.[0-9]+ um RMS' "$gallery/camera.sh" "$scratch/camera" && isPicture "$scratch/camera/error.png"; }
check 'gallery: instruments are tracked' tracks
emulates() {
  local port
  port=$(freePort)
  export ROS_MASTER_URI=http://127.0.0.1:$port ROS_HOSTNAME=127.0.0.1
  rosmaster --core -p "$port" >/dev/null 2>&1 &
  local master=$! status=0
  until rosparam list >/dev/null 2>&1; do sleep 0.2; done
  prints '^[0-9]+,' "$gallery/emulator.sh" 8 || status=$?
  kill "$master" && wait "$master" || true
  return "$status"
}
check 'gallery: the emulated devices send their joints' emulates
