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

# pythonEnvironment NAME FILE OPTION...: build/NAME, a virtual environment with what FILE names, from the registry of Python by
# pip with these options. It stays as long as FILE is the same.
pythonEnvironment() {
  local folder=$root/build/$1 names=$2
  shift 2
  cmp -s "$names" "$folder/installed.txt" && return
  rm -rf "$folder" && /usr/bin/python3 -m venv --system-site-packages "$folder" &&
    "$folder/bin/pip" install --quiet --retries 1 --timeout 10 "$@" --requirement "$names" && cp "$names" "$folder/installed.txt"
}

# systemTest MODULE OPTION...: a module of vibe_system_tests
systemTest() (
  export PYTHONPATH=$root/src/vibe_system_tests/src${PYTHONPATH:+:$PYTHONPATH} PYTHONDONTWRITEBYTECODE=1
  exec /usr/bin/python3 -P -m "vibe_system_tests.$1" "${@:2}"
)

# builtSystemTest MODULE OPTION...: the same for one that needs what is built
builtSystemTest() { (set +u && source "$root/devel/setup.bash" && systemTest "$@"); }

# processesWith NAME=VALUE: the processes that were started with this in their environment.
processesWith() {
  grep -lzxF -- "$1" /proc/[0-9]*/environ 2>/dev/null | sed -E 's#/proc/([0-9]+)/.*#\1#' || true
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
