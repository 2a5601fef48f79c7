# What every script of this folder shares; sourced, never run.

# the workspace, wherever the caller stands and however the script was reached (a link to it works too)
vibe_root=$(dirname -- "$(dirname -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")")")

# Ends the script: something went wrong while it ran.
die() {
  printf '%s: %s\n' "${0##*/}" "$*" >&2
  exit 1
}

# Ends the script: it was called in a way it does not understand.
usageError() {
  printf '%s: %s (%s --help lists what there is)\n' "${0##*/}" "$*" "$0" >&2
  exit 2
}

# helpOnly "$@": of a script that has no option but --help.
helpOnly() {
  [ $# -gt 0 ] || return 0
  [ "$1" = --help ] || usageError "unknown option '$1'"
  usage
  exit 0
}

# requireValue OPTION COUNT: an option that takes a value must be followed by one.
requireValue() {
  [ "$2" -ge 2 ] || usageError "$1 needs a value"
}

# useRos: the ROS 1 that the workspace stands on alone. One that the caller has sourced is used (/opt/ros/..., a conda
# environment: a prefix that contains roscpp), and vibe_ros names it; otherwise it is that of Debian in /usr, which is
# built for /usr/bin/python3: a python3 of pyenv or conda earlier in PATH breaks CMake and every node script. Other
# workspaces that the caller has sourced do not shine through.
useRos() {
  local prefix prefixes=() found=()
  IFS=: read -ra prefixes <<<"${CMAKE_PREFIX_PATH:-}"
  for prefix in "${prefixes[@]}"; do
    if [ "${prefix%/}" != /usr ] && [ -f "$prefix/share/roscpp/package.xml" ]; then found+=("${prefix%/}"); fi
  done
  [ ${#found[@]} -le 1 ] || die "two ROS are sourced, ${found[0]} and ${found[1]}; open a new terminal and source one of them"
  vibe_ros=${found[0]:-}
  vibe_python=/usr/bin/python3
  export PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin
  unset PYTHONPATH PYTHONHOME CMAKE_PREFIX_PATH ROS_PACKAGE_PATH
  [ -n "$vibe_ros" ] || return 0
  PATH=$vibe_ros/bin:$PATH
  [ ! -x "$vibe_ros/bin/python3" ] || vibe_python=$vibe_ros/bin/python3
  [ -f "$vibe_ros/setup.bash" ] || die "the ROS in $vibe_ros has no setup.bash; install its catkin"
  set +u
  # shellcheck disable=SC1091
  source "$vibe_ros/setup.bash"
  set -u
}
useRos

# Brings the workspace's environment into this shell; call it before set -u, which ROS's own files do not survive.
sourceWorkspace() {
  local devel=$1
  [ -f "$devel/setup.bash" ] || die "$devel/setup.bash is missing; run scripts/build"
  set +u
  # shellcheck disable=SC1091
  source "$devel/setup.bash" || die "could not read $devel/setup.bash; remove $devel and run scripts/build"
  set -u
}

# runGuarded "$@": from here on nothing the script starts outlives it, not even when it is killed with SIGKILL. The
# script begins anew as a child of scripts/lib/guard.py; needs python3, so call it once setup is through.
runGuarded() {
  [ "${VIBE_GUARDED:-}" != "$PPID" ] || return 0
  exec "$vibe_python" "$vibe_root/scripts/lib/guard.py" "$BASH" "$0" "$@"
}

# scripts/test names the workspace in VIBE_WORKSPACE_IS_BUILT once it has installed and built everything. The scripts that
# tests call, several at once, then check and build nothing.
isBuilt() {
  [ "${VIBE_WORKSPACE_IS_BUILT:-}" = "$vibe_root" ]
}

# installMissing [PART...]: installs what these parts of the workspace need (none: everything) and is missing, without a
# word and without sudo when nothing is. What a ROS that the caller has sourced needs, rosdep knows and setup does not.
installMissing() {
  local missing flags=() part
  if isBuilt || [ -n "$vibe_ros" ]; then return 0; fi
  for part in "$@"; do flags+=(--part "$part"); done
  missing=$("$vibe_root/scripts/setup" --missing "${flags[@]}") || exit 1
  [ -z "$missing" ] || "$vibe_root/scripts/setup" "${flags[@]}" || exit 1
}

# workIn PART "$@": installs and builds this part of the workspace, brings it into this shell, and guards what comes
workIn() {
  installMissing "$1"
  runGuarded "${@:2}"
  isBuilt || "$vibe_root/scripts/build" --quiet --part "$1"
  sourceWorkspace "$vibe_root/devel"
}

# changedFiles REV: what the commits since REV and the working tree have changed, as paths below the workspace. Without
# a REV: since this branch left main.
changedFiles() {
  local since=$1
  [ -n "$since" ] || since=$(git -C "$vibe_root" merge-base main HEAD 2>/dev/null) ||
    { usageError "--changed: there is no branch 'main' to compare with; name a revision"; }
  git -C "$vibe_root" rev-parse --quiet --verify "$since^{commit}" >/dev/null || usageError "--changed: there is no revision '$since'"
  { git -C "$vibe_root" diff --name-only "$since" && git -C "$vibe_root" ls-files --others --exclude-standard; } | sort -u
}
