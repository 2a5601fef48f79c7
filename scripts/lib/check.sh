# The smallest test harness: sourced by scripts/test.d/*.sh. Every check prints one line, `ok NAME` or `not ok NAME`;
# scripts/test counts these lines. What a failed check wrote follows its line, indented.

# shellcheck disable=SC2154
root=$(dirname -- "$(dirname -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")")")
scratch=$(mktemp -d)
trap 'rm -rf -- "$scratch"' EXIT

# check NAME COMMAND...: passes when the command succeeds.
check() {
  local name=$1
  shift
  if ("$@") >"$scratch/.output" 2>&1 </dev/null; then
    echo "ok $name"
  else
    echo "not ok $name"
    sed 's/^/    /' "$scratch/.output"
  fi
}

# fails COMMAND...: succeeds when the command does not
fails() { ! "$@"; }

# refuses CODE PATTERN COMMAND...: succeeds when the command ends with CODE, says one line, and that line matches.
refuses() {
  local code=$1 pattern=$2 status=0 said
  shift 2
  said=$("$@" 2>&1) || status=$?
  printf '%s\n' "$said"
  [ "$status" -eq "$code" ] || { echo "exit status $status, not $code"; return 1; }
  [ "$(grep -c . <<<"$said")" -eq 1 ] || { echo 'not one line'; return 1; }
  grep -qE -- "$pattern" <<<"$said" || { echo "does not match: $pattern"; return 1; }
}

# skip SENTENCE: ends the script, with a sentence on what is not tested and why
skip() {
  echo "skipped $1"
  exit 0
}

# isOrdinary [PACKAGE/PROGRAM...]: the build that is tested has no sanitizers, and these programs are in it
isOrdinary() {
  local program
  [ -z "${VIBE_VARIANT:-}" ] || return 1
  for program in "$@"; do [ -x "$root/devel/lib/$program" ] || return 1; done
}

# isSlowRun [PACKAGE/PROGRAM...]: the same, and tests that take minutes are wanted
isSlowRun() { [ -n "${VIBE_SLOW_TESTS:-}" ] && isOrdinary "$@"; }

# hashOf FILE: that of the state with which a session has ended
hashOf() { sed -n 's/^state hash: //p' "$1"; }

# pythonEnvironment NAME FILE OPTION...: build/NAME, a virtual environment with what FILE names, from the registry of Python by
# pip with these options; without Debian's where SITE_PACKAGES is empty. It stays as long as FILE is the same.
pythonEnvironment() {
  local folder=$root/build/$1 names=$2
  shift 2
  cmp -s "$names" "$folder/installed.txt" && return
  rm -rf "$folder" && /usr/bin/python3 -m venv ${SITE_PACKAGES---system-site-packages} "$folder" &&
    "$folder/bin/pip" install --quiet --retries 1 --timeout 10 "$@" --requirement "$names" && cp "$names" "$folder/installed.txt"
}

# systemTest MODULE OPTION...: a module of vibe_system_tests
systemTest() (
  export PYTHONPATH=$root/src/vibe_system_tests/src${PYTHONPATH:+:$PYTHONPATH} PYTHONDONTWRITEBYTECODE=1
  exec /usr/bin/python3 -P -m "vibe_system_tests.$1" "${@:2}"
)

# builtSystemTest MODULE OPTION...: the same for one that needs what is built
builtSystemTest() { (set +u && source "$root/devel/setup.bash" && systemTest "$@"); }

# withMessages FILE|- ARGUMENT...: Python that knows the messages of the workspace
withMessages() { PYTHONPATH=$root/devel/lib/python3/dist-packages /usr/bin/python3 "$@"; }

# processesWith NAME=VALUE: the processes that were started with this in their environment.
processesWith() {
  grep -lzxF -- "$1" /proc/[0-9]*/environ 2>/dev/null | sed -E 's#/proc/([0-9]+)/.*#\1#' || true
}

# startSession NAME OPTION...: scripts/run in the background, with the folder $scratch/NAME, its output in NAME.txt; sets
# session_pid. Returns once it takes steps or, a short one, has taken all. Ends with the check.
startSession() {
  local name=$1 deadline=$((SECONDS + 120))
  # bash starts background jobs deaf to SIGINT; the user's terminal does not
  VIBE_TEST_MARK=$name-$$ /usr/bin/python3 -c 'import os, signal, sys
signal.signal(signal.SIGINT, signal.SIG_DFL)
os.execv(sys.argv[1], sys.argv[1:])' "$root/scripts/run" --output "$scratch/$name" "${@:2}" >"$scratch/$name.txt" 2>&1 &
  session_pid=$!
  trap 'kill $(jobs -rp) 2>/dev/null; wait' EXIT
  until grep -qsE '^state hash: | ([1-9][0-9]*\.[0-9]+|0\.0?[1-9][0-9]*) x real time' "$scratch/$name.txt"; do
    kill -0 "$session_pid" && [ "$SECONDS" -lt "$deadline" ] || { cat "$scratch/$name.txt"; return 1; }
    sleep 0.2
  done
}

# programsOf NAME: the processes of this session
programsOf() { processesWith "VIBE_TEST_MARK=$1-$$"; }

# nobodyLeft MARK SECONDS: within this time all that was started with VIBE_TEST_MARK=MARK has ended
nobodyLeft() {
  local deadline=$((SECONDS + $2))
  while [ -n "$(processesWith "VIBE_TEST_MARK=$1")" ]; do
    [ "$SECONDS" -lt "$deadline" ] || { processesWith "VIBE_TEST_MARK=$1" | xargs -r ps -o pid,ppid,args -p; return 1; }
    sleep 0.1
  done
}

# ends STATUS FILE: what was begun ends so; shows its output
ends() {
  local status=0
  wait "$session_pid" || status=$?
  cat "$2"
  [ "$status" -eq "$1" ]
}

# gives STATUS FILE COMMAND...: the command ends so; shows its output, which FILE keeps
gives() {
  local status=0
  "${@:3}" >"$2" 2>&1 || status=$?
  cat "$2"
  [ "$status" -eq "$1" ] || { echo "exit status $status, not $1"; return 1; }
}

# prints PATTERN COMMAND...: the command succeeds, and one of its lines matches
prints() {
  local said
  said=$("${@:2}" 2>&1) || { printf '%s\n' "$said"; return 1; }
  printf '%s\n' "$said"
  grep -qE -- "$1" <<<"$said"
}

# freePort: a port that is free and stays so: below those that Linux gives to other tests, which run beside this one
freePort() {
  /usr/bin/python3 -c 'import random, socket
while True:
    port = random.randrange(20000, 32000)
    with socket.socket() as door:
        if door.connect_ex(("127.0.0.1", port)) != 0:
            break
print(port)'
}
