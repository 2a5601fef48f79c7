# scripts/run --drive: a session that somebody drives in wall time is recorded and repeats. What goes with whom is tested in
# src/vibe_bringup/test.
# kind: waiting
# cost: 120
# alone-with: fake-camera
# packages: vibe_bringup vibe_system_tests
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

unset DISPLAY
run=$root/scripts/run
scene=$root/src/vibe_sim/test/node/scenes/light.yaml
recording=$root/src/vibe_hardware/test/node/pad_session.evemu
hand=script:$root/src/vibe_core/trainees/demo/smoke.yaml

isOrdinary || skip 'sessions (scripts/run uses the ordinary build, not this one)'

# drives NAME OPTION...: a session on the light scene ends well, is complete, and repeats to the same state.
drives() {
  local name=$1
  gives 0 "$scratch/$name.txt" "$run" --scene "$scene" --headless --output "$scratch/$name" "${@:2}" &&
    grep -q '^state hash: ' "$scratch/$name/summary.txt" || return 1
  [ "$(grep -c 'x real time' "$scratch/$name.txt")" -ge 3 ] || { echo 'not a line a second'; return 1; }
  gives 0 "$scratch/$name.replay" "$root/scripts/replay" "$scratch/$name/session.bag" && grep -q '^the same: all ' "$scratch/$name.replay"
}

# reaches NAME DEPTH SPREAD: the deepest insertion that a step has used [m], and by how much it may differ.
reaches() {
  withMessages - "$scratch/$1/session.bag" "$2" "$3" <<'PYTHON'
import sys
import rosbag
inputs = [message for _, message, _ in rosbag.Bag(sys.argv[1]).read_messages(topics=["/applied_input"])]
depth, wanted, spread = max(message.joints[0] for message in inputs), float(sys.argv[2]), float(sys.argv[3])
assert abs(depth - wanted) < spread, "{:.4f} m deep, not {}".format(depth, wanted)
assert any(any(message.buttons) for message in inputs), "no button was pressed"
assert inputs[0].header.stamp.to_sec() > 1e9, "not the wall clock"
PYTHON
}

emulatorDrives() {
  drives emulator --drive emulator --hand "$hand" --duration 6 && reaches emulator 0.08 0.02
}
check 'emulated devices drive a session that repeats' emulatorDrives

gamepadDrives() {
  drives gamepad --drive gamepad --replay-pad "$recording" --duration 5 && reaches gamepad 0.08 0.004 &&
    grep -q 'press BTN_START to insufflate' "$scratch/gamepad.txt"
}
check 'a recorded gamepad drives a session that repeats' gamepadDrives

padIsRecorded() {
  drives again --drive gamepad --replay-pad "$scratch/gamepad/pad.evemu" --duration 5 && reaches again 0.08 0.004
}
check 'a session leaves a recording of its gamepad' padIsRecorded

# instrumentsMove NAME: the camera, and nobody else, has moved helix and needle driver by centimetres.
instrumentsMove() {
  withMessages - "$scratch/$1/session.bag" <<'PYTHON'
import sys
import rosbag
bag = rosbag.Bag(sys.argv[1])
measured = [m for _, m, _ in bag.read_messages(topics=["/suturing_device/input/joint_states"])]
assert len(measured) > 50, "{} messages of the camera".format(len(measured))
assert all(len(m.velocity) == 3 for m in measured), "buttons move the instruments, too"
inputs = [message for _, message, _ in bag.read_messages(topics=["/applied_input"])]
for joint in (4, 6):
    used = [message.joints[joint] for message in inputs]
    assert max(used) - min(used) > 0.012, "joint {} moved by {} m".format(joint, max(used) - min(used))
PYTHON
}

cameraMoves() {
  drives camera --drive emulator --hand "$hand" --duration 12 --instruments camera --camera fake && instrumentsMove camera
}
check 'a camera moves the instruments of a session' cameraMoves

waitsForPad() {
  drives nobody --drive gamepad --pad 'no such gamepad' --duration 4 || return 1
  [ "$(grep -c "No device found with 'no such gamepad'.*Waiting for it" "$scratch/nobody.txt")" -eq 1 ]
}
check 'a session without its gamepad says what it looked for and goes on' waitsForPad

namesBadMapping() {
  printf 'name: wrong\njoints:\n  insertion: {axis: ABS_Y, mode: rate, rte: 1 cm/s}\n' >"$scratch/wrong.yaml"
  gives 1 "$scratch/wrong.txt" "$run" --drive gamepad --scene "$scene" --headless --mapping "$scratch/wrong.yaml" --duration 3 \
    --output "$scratch/wrong" && grep -q "wrong.yaml:3: joints.insertion.rte: .*did you mean 'rate'" "$scratch/wrong.txt" &&
    grep -q '^run: gamepad_node died' "$scratch/wrong.txt"
}
check 'a wrong mapping is one clear error' namesBadMapping

# start NAME OPTION...: a session without an end
start() { startSession "$1" --scene "$scene" "${@:2}"; }

endsOnInterrupt() {
  local status=0
  start endless --drive emulator --hand "$hand" --headless || return 1
  kill -INT "$session_pid"
  wait "$session_pid" || status=$?
  cat "$scratch/endless.txt"
  [ "$status" -eq 0 ] && grep -q '^state hash: ' "$scratch/endless.txt" && [ -s "$scratch/endless/session.bag" ] &&
    [ -z "$(programsOf endless)" ]
}
check 'a session without an end is summed up when it is interrupted' endsOnInterrupt

command -v Xvfb >/dev/null || skip 'driving with the keyboard (there is no Xvfb; scripts/setup installs it)'

# startDisplay: a virtual display, in DISPLAY; ends with the check, as the session does.
startDisplay() {
  exec {display_pipe}<> <(:)
  Xvfb -displayfd "$display_pipe" -screen 0 1280x800x24 >/dev/null 2>&1 &
  local number
  read -r -t 60 -u "$display_pipe" number || { echo 'no virtual display'; return 1; }
  export DISPLAY=:$number
}

# commands NAME: how many commands of rviz the recording of a session holds.
commands() {
  withMessages - "$scratch/$1/session.bag" <<'PYTHON'
import sys
import rosbag
topics = rosbag.Bag(sys.argv[1]).read_messages(topics=["/scope/servo_jp"], return_connection_header=True)
print(sum(header["callerid"].startswith(b"/rviz") for _, _, _, header in topics))
PYTHON
}

# closesRviz COMPLAINT DEADLINE: closes the window of the session until that has ended
closesRviz() {
  while kill -0 "$session_pid" 2>/dev/null; do
    [ "$SECONDS" -lt "$2" ] || { kill -INT "$session_pid"; echo "$1"; return 1; }
    systemTest close_window || true
    sleep 2
  done
}

keyboardDrives() {
  startDisplay && start keyboard --drive keyboard || return 1
  local deadline=$((SECONDS + 180)) status=0
  # rviz asks the tool to drive when it has drawn its first pictures
  until grep -qs '^t =   1[0-9]\.' "$scratch/keyboard.txt" || ! kill -0 "$session_pid" 2>/dev/null; do sleep 0.5; done
  closesRviz 'the session goes on without rviz' "$deadline" || return 1
  ends 0 "$scratch/keyboard.txt" && grep -q '^rviz was closed: the session ends.' "$scratch/keyboard.txt" &&
    grep -q '^state hash: ' "$scratch/keyboard.txt" && [ "$(commands keyboard)" -gt 0 ]
}
check 'rviz drives with the keyboard from its start, and closing it ends the session' keyboardDrives

# windowOf NAME: the process of rviz of a session, once it is that program
windowOf() {
  local pid deadline=$((SECONDS + 60))
  while [ "$SECONDS" -lt "$deadline" ]; do
    for pid in $(programsOf "$1"); do
      if [[ $(readlink "/proc/$pid/exe") == */rviz ]]; then echo "$pid"; return; fi
    done
    sleep 0.2
  done
  return 1
}

staysWithTheResult() {
  local status=0 deadline=$((SECONDS + 180))
  startDisplay && start result --drive emulator --hand "$hand" --duration 6 || return 1
  until grep -q '^The session has ended. It is still shown by rviz, until it is closed, or Ctrl-C.' "$scratch/result.txt"; do
    [ "$SECONDS" -lt "$deadline" ] && kill -0 "$session_pid" || { cat "$scratch/result.txt"; return 1; }
    sleep 0.2
  done
  closesRviz 'rviz cannot be closed' "$deadline" || return 1
  ends 0 "$scratch/result.txt" && grep -q '^recorded: ' "$scratch/result.txt"
}
check 'rviz shows how a session ended until it is closed' staysWithTheResult

saysThatRvizDied() {
  local status=0 rviz deadline=$((SECONDS + 180))
  startDisplay && QT_QPA_PLATFORM=wayland start died --drive emulator --hand "$hand" && rviz=$(windowOf died) || return 1
  grep -qz '^QT_QPA_PLATFORM=xcb$' "/proc/$rviz/environ" && kill -KILL "$rviz" || return 1
  until grep -q '^rviz died; the session goes on without it.' "$scratch/died.txt" || [ "$SECONDS" -gt "$deadline" ]; do kill -0 "$session_pid" || break; sleep 0.2; done
  kill -INT "$session_pid"
  wait "$session_pid" || status=$?
  cat "$scratch/died.txt"
  [ "$status" -eq 1 ] && grep -q '^On this Wayland desktop rviz runs through Xwayland' "$scratch/died.txt" &&
    grep -q '^rviz died; the session goes on without it.' "$scratch/died.txt" && grep -q '^state hash: ' "$scratch/died.txt" &&
    grep -q '^run: rviz died with status -9' "$scratch/died.txt" && grep -q '^rviz died' "$scratch/died/log/rviz.log"
}
check 'rviz is an X client under Wayland, and a session says when it died' saysThatRvizDied
