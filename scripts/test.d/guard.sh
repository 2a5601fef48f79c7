# Nothing that runs under scripts/lib/guard.py outlives it.
# kind: waiting
# cost: 20
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

guard() { /usr/bin/python3 "$root/scripts/lib/guard.py" "$@"; }

# A family with every bad habit: background jobs, sessions of their own, orphans, ignored signals.
mark=vibe-guard-test-$$
cat >"$scratch/family" <<'FAMILY'
#!/bin/bash
# family NAME SECONDS
sleep 300 &
setsid sleep 300 &
(setsid bash -c 'trap "" TERM INT HUP; while :; do sleep 1; done' &) &
sleep "$2"
FAMILY
chmod +x "$scratch/family"

# startFamily SECONDS: starts it under a guard, in the background; sets guard_pid.
startFamily() {
  VIBE_TEST_MARK=$mark /usr/bin/python3 "$root/scripts/lib/guard.py" "$scratch/family" "$mark" "$1" &
  guard_pid=$!
  local deadline=$((SECONDS + 10))
  while [ "$(processesWith "VIBE_TEST_MARK=$mark" | wc -l)" -lt 6 ]; do
    [ "$SECONDS" -lt "$deadline" ] || { echo 'the family did not start'; return 1; }
    sleep 0.1
  done
}

passesStatus() {
  guard true || return 1
  local status=0
  guard bash -c 'exit 7' || status=$?
  [ "$status" -eq 7 ] || { echo "status $status, not 7"; return 1; }
  status=0
  guard bash -c 'kill -SEGV $$' || status=$?
  [ "$status" -eq 139 ] || { echo "status $status, not 139"; return 1; }
}
check 'guard ends with the status of its command' passesStatus

endsAfterNormalEnd() {
  startFamily 5 && wait "$guard_pid" && nobodyLeft "$mark" 0
}
check 'nothing is left when the command has ended' endsAfterNormalEnd

endsAfter() {
  startFamily 300 && kill "-$1" "$guard_pid" && nobodyLeft "$mark" 15
}
check 'nothing is left after SIGKILL' endsAfter KILL
check 'nothing is left after SIGTERM' endsAfter TERM

forwardsInterrupt() {
  local status=0
  /usr/bin/python3 "$root/scripts/lib/guard.py" bash -c 'trap "exit 5" INT; touch "$1"; while :; do sleep 0.1; done' - "$scratch/ready" &
  local pid=$!
  while [ ! -e "$scratch/ready" ]; do sleep 0.1; done
  kill -INT "$pid"
  wait "$pid" || status=$?
  [ "$status" -eq 5 ] || { echo "status $status, not 5"; return 1; }
}
check 'guard passes SIGINT on' forwardsInterrupt

# An orphan that ends wakes the guard once, and not for ever.
sleepsMeanwhile() {
  VIBE_TEST_MARK=$mark-idle /usr/bin/python3 "$root/scripts/lib/guard.py" bash -c '(sleep 0.1 &); sleep 4' &
  local pid=$! used=0 one
  sleep 3
  for one in $(processesWith "VIBE_TEST_MARK=$mark-idle"); do
    used=$((used + $(awk '{print $14 + $15}' "/proc/$one/stat")))
  done
  wait "$pid"
  [ "$used" -lt 100 ] || { echo "guard and command took $used hundredths of a second while they slept for 3 s"; return 1; }
}
check 'a guard sleeps while its command does' sleepsMeanwhile
