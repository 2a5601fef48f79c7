# scripts/run as a user meets it: it ends well, says why when it does not, and leaves nothing behind.
# kind: waiting
# cost: 100
# packages: vibe_bringup vibe_web
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

isOrdinary || skip 'sessions (scripts/run uses the ordinary build, not this one)'
unset DISPLAY
run=$root/scripts/run

# start NAME [OPTION...]: a session of an hour
start() { startSession "$1" --headless --duration 3600 "${@:2}"; }

isRecorded() {
  [ -s "$1/session.bag" ] && [ -z "$(find "$1" -name '*.active')" ] || { ls "$1"; return 1; }
}

# The recording holds every step and, of every numbered topic of the simulator, every message.
nothingIsLost() {
  withMessages - "$1/session.bag" "$2" <<'PYTHON'
import collections, sys
import rosbag
numbers = collections.defaultdict(list)
for topic, message, _, header in rosbag.Bag(sys.argv[1]).read_messages(return_connection_header=True):
    if header["callerid"] == b"/sim_node" and hasattr(message, "header"):
        numbers[topic].append(message.header.seq)
steps = len(numbers["/applied_input"])
assert steps == int(sys.argv[2]), "{} steps recorded, not {}".format(steps, sys.argv[2])
for topic, found in numbers.items():
    assert found == list(range(found[0], found[0] + len(found))), "gaps in " + topic
PYTHON
}

endsWell() {
  local folder="$scratch/first session"
  gives 0 "$scratch/first.txt" env -C / "$run" --headless --fast --record-all --duration 2 --output "$folder" &&
    [ -n "$(hashOf "$folder/summary.txt")" ] && grep -qxF "state hash: $(hashOf "$folder/summary.txt")" "$scratch/first.txt" &&
    isRecorded "$folder" && nothingIsLost "$folder" 120
}
check 'a session ends well, summed up and recorded without a loss' endsWell

repeats() {
  "$run" --headless --fast --duration 2 --output "$scratch/second" || return 1
  [ "$(hashOf "$scratch/second/summary.txt")" = "$(hashOf "$scratch/first session/summary.txt")" ]
}
check 'the same session ends in the same state' repeats

# The second session is recorded as by default. Of what the simulator sent nothing may differ from the first, in which
# every message was recorded, once a replay has filled it in: stamps, order and all bytes, but for the sequence numbers.
isFilledIn() {
  "$root/scripts/replay" --fill "$scratch/filled.bag" "$scratch/second/session.bag" | tee "$scratch/replay.txt" || return 1
  grep -q '^the same: all 120 steps' "$scratch/replay.txt" || return 1
  withMessages - "$scratch/first session/session.bag" "$scratch/filled.bag" "$scratch/second/session.bag" <<'PYTHON'
import collections, io, sys
import rosbag
UNREPEATABLE = ("/solver_statistics", "/step_timing", "/clock", "/session_info")  # times of the machine; pauses
def messages(path):
    found = collections.defaultdict(list)
    for topic, message, _, header in rosbag.Bag(path).read_messages(return_connection_header=True):
        if header.get("callerid", b"/sim_node") != b"/sim_node": continue  # what was filled in has no sender
        if hasattr(message, "header"): message.header.seq = 0
        if hasattr(message, "session"): message.session = 0  # which start of the simulator
        text = io.BytesIO()
        message.serialize(text)
        found[topic].append(text.getvalue())
    return found
def simulators(path):
    return {t for t, _, _, h in rosbag.Bag(path).read_messages(return_connection_header=True) if h.get("callerid") == b"/sim_node"}
whole, filled, thin = (messages(path) for path in sys.argv[1:])
topics = simulators(sys.argv[1]) - set(UNREPEATABLE) - {"/rosout", "/tf_static"}
assert len(topics) > 20, topics
latched = {t for t, _, _, h in rosbag.Bag(sys.argv[1]).read_messages(return_connection_header=True) if h.get("latching") == b"1"}
assert len(latched) > 5, latched
# of the other topics the first message may come before the recorder listens
missed = {t for t in topics - latched if whole[t] == filled[t][1:]}
different = [t for t in sorted(topics - missed) if whole[t] != filled[t]]
assert not different, {t: (len(whole[t]), len(filled[t])) for t in different}
assert [t for t in topics if whole[t] != thin[t]], "nothing was left out"
PYTHON
}
check 'a recording that was filled in has every message of the session' isFilledIn

check 'a session is not recorded over another' refuses 2 'already holds a session' "$run" --headless --output "$scratch/second"

failsOnBadScene() {
  sed 's/^\([a-z]*\):/\1_of_no_meaning:/' "$root/src/vibe_core/scenes/stomach.yaml" >"$scratch/bad.yaml"
  gives 1 "$scratch/bad.txt" "$run" --headless --fast --duration 1 --scene "$scratch/bad.yaml" --output "$scratch/bad" &&
    grep -q 'bad.yaml:[0-9]*' "$scratch/bad.txt" && grep -q 'run: sim_node ended with status' "$scratch/bad.txt"
}
check 'a bad scene is one clear error' failsOnBadScene

# doors NAME: ADDRESS:PORT of every TCP port that the programs of a session listen on, as in /proc/net/tcp: 0100007F is
# 127.0.0.1, and ports are hexadecimal.
doors() {
  local inode pid sockets=' ' address state rest
  for pid in $(programsOf "$1"); do
    sockets+=$(find "/proc/$pid/fd" -lname 'socket:*' -printf '%l ' 2>/dev/null)
  done
  while read -r _ address _ state _ _ _ _ _ inode rest; do
    if [ "$state" = 0A ] && [[ $sockets == *"socket:[$inode]"* ]]; then echo "$address"; fi
  done < <(cat /proc/net/tcp /proc/net/tcp6 2>/dev/null)
}

# listensOnlyTo NAME ADDRESS: at least six ports, all of them on this address
listensOnlyTo() {
  local found
  found=$(doors "$1")
  printf '%s\n' "$found"
  [ "$(wc -l <<<"$found")" -ge 6 ] && ! grep -v "^$2:" <<<"$found"
}

# One session for both: control of the address, that another one is told apart.
isClosedAndSurvivesInterrupt() {
  local mark=interrupted status=0
  start "$mark" || return 1
  listensOnlyTo "$mark" 0100007F || { echo 'listens to the network'; return 1; }
  ! listensOnlyTo "$mark" 00000000 >/dev/null || { echo 'tells no address apart'; return 1; }
  kill -INT "$session_pid"
  wait "$session_pid" || status=$?
  cat "$scratch/$mark.txt"
  [ "$status" -eq 0 ] && grep -q '^state hash: ' "$scratch/$mark.txt" && isRecorded "$scratch/$mark" && nobodyLeft "$mark-$$" 0
}
check 'a session listens on the loopback interface only; interrupted, it is summed up and leaves nothing' isClosedAndSurvivesInterrupt

# signalProgram NAME SIGNAL PATTERN: sends the signal to the program of a session whose command line matches.
signalProgram() {
  local pid
  for pid in $(programsOf "$1"); do
    if grep -qaz "$3" "/proc/$pid/cmdline"; then kill "-$2" "$pid" && return; fi
  done
  echo "no process $3"
  return 1
}

cleansUpAfterKill() {
  local mark=killed
  start "$mark" || return 1
  # a program that hangs does not hear that it should end
  signalProgram "$mark" STOP 'robot_state_publisher/robot_state_publisher$' || return 1
  kill -KILL "$session_pid"
  nobodyLeft "$mark-$$" 60 && isRecorded "$scratch/$mark"
}
check 'a killed session leaves no process and a complete recording' cleansUpAfterKill

keepsRecording() {
  local mark=slow status=0
  # at the pace of the wall clock: as fast as it can, a quick machine sends more clouds in that time than wait (kCloudQueue)
  start "$mark" --record-all --duration 6 || return 1
  signalProgram "$mark" STOP 'lib/vibe_sim/vibe_record$' && sleep 2 &&
    signalProgram "$mark" CONT 'lib/vibe_sim/vibe_record$' || return 1
  ends 0 "$scratch/$mark.txt" && nothingIsLost "$scratch/$mark" 360
}
check 'a recorder that stands still for two seconds loses nothing' keepsRecording

namesTheDead() {
  local mark=dead status=0
  start "$mark" || return 1
  signalProgram "$mark" KILL 'lib/vibe_sim/vibe_trainee$' || return 1
  wait "$session_pid" || status=$?
  cat "$scratch/$mark.txt"
  [ "$status" -eq 1 ] && grep -q '^run: vibe_trainee died' "$scratch/$mark.txt" && nobodyLeft "$mark-$$" 0
}
check 'a session names the program that died' namesTheDead

[ -f "$root/devel/share/vibe_web/page/index.html" ] ||
  skip 'the page of a session (the build left it out: it needs nodejs and npm)'
# a port, and a home for certificates
port=$(freePort)
export ROS_HOME=$scratch/home
# answers SCHEME TEXT: something on the port does, with a page that contains this
answers() {
  /usr/bin/python3 -c 'import ssl, sys, urllib.request
page = urllib.request.urlopen(sys.argv[1], context=ssl._create_unverified_context() if sys.argv[1][4] == "s" else None, timeout=60)
sys.exit(sys.argv[2] not in page.read().decode())' "$1://127.0.0.1:$port/" "$2"
}

showsItsEnd() {
  local mark=shown status=0 deadline=$((SECONDS + 120))
  start "$mark" --web --port "$port" --fast --duration 2 || return 1
  until grep -q '^The session has ended. It is still shown by the page, until Ctrl-C.' "$scratch/$mark.txt"; do
    [ "$SECONDS" -lt "$deadline" ] || return 1
    sleep 0.2
  done
  isRecorded "$scratch/$mark" && grep -q '^state hash: ' "$scratch/$mark.txt" && answers http '<canvas' || return 1
  kill -INT "$session_pid"
  wait "$session_pid" || status=$?
  cat "$scratch/$mark.txt"
  [ "$status" -eq 0 ] && nobodyLeft "$mark-$$" 0
}
check 'a page shows how a session ended, until Ctrl-C' showsItsEnd

opensThePageAlone() {
  local mark=lan status=0 open
  start "$mark" --drive web --lan --port "$port" || return 1
  grep -q "https://.*:$port/#token=" "$scratch/$mark.txt" && answers https '<canvas' || { cat "$scratch/$mark.txt"; return 1; }
  open=$(doors "$mark" | grep -Ev '^(0100007F|00000000000000000000000001000000):')
  printf '%s\n' "$open"
  kill -INT "$session_pid"
  ends 0 "$scratch/$mark.txt" && [ -n "$open" ] && ! grep -v ":$(printf %04X "$port")$" <<<"$open"
}
check 'with --lan the port of the page alone is open to the network' opensThePageAlone

namesTakenPort() {
  /usr/bin/python3 -m http.server --bind 127.0.0.1 "$port" >"$scratch/http.txt" 2>&1 &
  local server=$! status=0
  until answers http Directory 2>/dev/null; do kill -0 "$server" || return 1; sleep 0.1; done
  gives 1 "$scratch/taken.txt" "$run" --headless --web --port "$port" --duration 3600 --output "$scratch/taken" || status=1
  kill "$server"
  [ "$status" -eq 0 ] && grep -q "port $port of 127.0.0.1 cannot be had .*; choose another one with .*--port" "$scratch/taken.txt"
}
check 'a port that is taken is said with its remedy' namesTakenPort
