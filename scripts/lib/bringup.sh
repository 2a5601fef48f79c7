# The program of vibe_bringup that bears the name of the script that sources this file, in this workspace: a wrong call
# and --help are answered at once; then what is missing is installed and built, and the program starts.
set -euo pipefail
source "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/common.sh"

name=$(basename -- "$(readlink -f -- "$0")")
export VIBE_WORKSPACE=$vibe_root # where the program writes by default

# checkCall OPTION...: prints the help, or `needs: PART...` for a call that is right. Works without ROS and before there is
# a build.
checkCall() {
  PYTHONPATH=$vibe_root/src/vibe_bringup/src:$vibe_root/src/vibe_sessions/src ROS_PACKAGE_PATH=$vibe_root/src \
    "$vibe_python" -B "$vibe_root/src/vibe_bringup/programs/$name" --check "$@"
}

# useScratchHome: ROS and matplotlib keep logs and caches in the home, which `nobody` and containers may not have.
useScratchHome() {
  [ -z "${ROS_HOME:-}${ROS_LOG_DIR:-}" ] || return 0
  ! mkdir -p -- "${HOME:-/nonexistent}/.ros" 2>/dev/null || [ ! -w "$HOME/.ros" ] || return 0
  ROS_HOME=$(mktemp -d "${TMPDIR:-/tmp}/vibe_home.XXXXXX") || die "no folder for logs can be made, neither in the home nor in ${TMPDIR:-/tmp}; set ROS_HOME to a folder that you may write to, with room on its disk"
  export ROS_HOME MPLCONFIGDIR=$ROS_HOME
}

# takeForce WORD...: --force means in each of these scripts what it means in setup; the programs do not know it.
takeForce() {
  local word
  arguments=()
  for word in "$@"; do
    if [ "$word" = --force ]; then export VIBE_ANY_SYSTEM=true; else arguments+=("$word"); fi
  done
}

main() {
  local said parts part flags=() arguments=()
  takeForce "$@"
  set -- "${arguments[@]}"
  "$vibe_python" -c 'import argparse' 2>/dev/null || installMissing session # a bare Debian has no Python
  said=$(checkCall "$@") || exit $?
  if [[ $said != 'needs: '* ]]; then printf '%s\n' "$said"; exit 0; fi
  read -ra parts <<<"${said#needs: }"
  useScratchHome
  installMissing "${parts[@]}"
  runGuarded "$@"
  for part in "${parts[@]}"; do flags+=(--part "$part"); done
  "$vibe_root/scripts/build" --quiet "${flags[@]}"
  sourceWorkspace "$vibe_root/devel"
  exec "$vibe_root/devel/lib/vibe_bringup/$name" "$@"
}

main "$@"
