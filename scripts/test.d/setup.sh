# scripts/setup reads package.xml files without Python and says what it does not understand.
# kind: computing
# cost: 60
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

setup=$root/scripts/setup

workspaceWith() {
  mkdir -p "$scratch/$1/pkg"
  printf '%s\n' "$2" >"$scratch/$1/pkg/package.xml"
}

listsNeeds() {
  workspaceWith good '<package format="2"><name>pkg</name><!-- <depend>no_such_key</depend>
    <depend>neither_this</depend> --><depend>std_msgs</depend><exec_depend>pkg</exec_depend>
    <test_depend version_gte="1">
      yaml-cpp </test_depend></package>'
  local said
  said=$("$setup" --list --source "$scratch/good") || return 1
  local package
  for package in libstd-msgs-dev ros-std-msgs python3-std-msgs libyaml-cpp-dev g++; do
    grep -qxF "$package" <<<"$said" || { echo "$package is not listed"; return 1; }
  done
  ! grep -qxF libassimp-dev <<<"$said"
}
check 'setup translates every kind of dependency' listsNeeds

workspaceWith unknown '<package format="2"><name>pkg</name><depend>no_such_key</depend></package>'
check 'setup names an unknown key, its file and the table' \
  refuses 1 "'no_such_key' in .*/unknown/pkg/package.xml.*apt_packages.txt" "$setup" --list --source "$scratch/unknown"

mkdir "$scratch/empty"
check 'setup says when there is no package' refuses 1 'no package.xml' "$setup" --list --source "$scratch/empty"

printf 'ID=debian\nVERSION_CODENAME=bullseye\nPRETTY_NAME="Debian 11"\n' >"$scratch/os-release"
for system in bookworm trixie; do printf 'ID=debian\nVERSION_CODENAME=%s\n' "$system" >"$scratch/$system"; done
# the scripts look for what is missing only where the tests have not built already, and refuse unless the caller has forced
elsewhere() { env -u VIBE_WORKSPACE_IS_BUILT -u VIBE_ANY_SYSTEM VIBE_OS_RELEASE="$scratch/os-release" "$@"; }
for script in setup build test run; do
  check "$script refuses another Debian" refuses 1 'Debian 12 .bookworm. or 13 .trixie.*Debian 11' elsewhere "$root/scripts/$script"
done
check 'setup goes on when forced' elsewhere "$setup" --force --missing
listOn() { VIBE_OS_RELEASE=$scratch/$1 "$setup" --list; }
check 'setup takes the line of the system' bash -c '
  grep -qx qt6-base-dev <<<"$1" && ! grep -qx qtbase5-dev <<<"$1" && grep -qx qtbase5-dev <<<"$2"' - "$(listOn trixie)" "$(listOn bookworm)"

providedIsInstalled() {
  mkdir -p "$scratch/provided/bin"
  cp -r "$root/scripts" "$scratch/provided/"
  printf '#!/bin/sh\nprintf "installed nodejs nodejs-dev, npm (= 9)\ndeinstall yarn npx\n"\n' >"$scratch/provided/bin/dpkg-query"
  chmod +x "$scratch/provided/bin/dpkg-query"
  sed -i "s#export PATH=#export PATH=$scratch/provided/bin:#" "$scratch/provided/scripts/lib/common.sh"
  echo 'odd nodejs npm npx' >>"$scratch/provided/scripts/apt_packages.txt"
  workspaceWith provided '<package format="2"><name>pkg</name><depend>odd</depend></package>'
  [ "$("$scratch/provided/scripts/setup" --missing --source "$scratch/provided" | grep -x 'nodejs\|npm\|npx')" = npx ]
}
check 'setup takes what an installed package provides' providedIsInstalled

# --- an apt that gets its lists and then fails
saysThatAptFailed() {
  local copy=$scratch/failing
  mkdir -p "$copy/bin" "$copy/src/pkg"
  cp -r "$root/scripts" "$copy/"
  printf '#!/bin/sh\ncase "$*" in *update*) ;; *) exit 100 ;; esac\n' >"$copy/bin/apt-get"
  printf '#!/bin/sh\nexec "$@"\n' >"$copy/bin/sudo"
  chmod +x "$copy/bin/apt-get" "$copy/bin/sudo"
  sed -i "s#export PATH=#export PATH=$copy/bin:#" "$copy/scripts/lib/common.sh"
  echo 'odd vibe-no-such-package' >>"$copy/scripts/apt_packages.txt"
  echo '<package format="2"><name>pkg</name><depend>odd</depend></package>' >"$copy/src/pkg/package.xml"
  gives 1 "$scratch/said" "$copy/scripts/setup" --yes && grep -q 'apt-get install failed' "$scratch/said" &&
    ! grep -q 'apt succeeded' "$scratch/said"
}
check 'setup says that apt failed' saysThatAptFailed

# --- a ROS that is sourced is used alone, and none of another kind is installed beside it
for ros in one two; do
  mkdir -p "$scratch/$ros/share/roscpp" && touch "$scratch/$ros/share/roscpp/package.xml"
  printf 'export CMAKE_PREFIX_PATH=%s ROS_PACKAGE_PATH=%s/share\n' "$scratch/$ros" "$scratch/$ros" >"$scratch/$ros/setup.bash"
done
mkdir "$scratch/devel"
withRos() { env CMAKE_PREFIX_PATH="$1" bash -c 'set -u; source "$1/scripts/lib/common.sh"; echo "$vibe_ros:${CMAKE_PREFIX_PATH:-}"' - "$root"; }
check 'a sourced ROS is used' bash -c '[ "$1" = "$2:$2" ]' - "$(withRos "$scratch/devel:$scratch/one")" "$scratch/one"
check 'a sourced workspace is hidden' bash -c '[ "$1" = : ]' - "$(withRos "$scratch/devel:/usr")"
check 'two sourced ROS are refused' refuses 1 'two ROS are sourced' withRos "$scratch/one:$scratch/two"
check 'setup installs nothing beside a sourced ROS' refuses 1 'rosdep install' env CMAKE_PREFIX_PATH="$scratch/one" "$setup" --yes

check 'nothing is missing once the tests run' bash -c '[ -z "$("$1" --missing)" ]' - "$setup"
check 'setup has nothing to do twice' bash -c '"$1" --yes | grep -qx "Everything is installed."' - "$setup"

everyPackageExists() { # of this system: a line KEY/CODENAME is about that one
  local unknown codename
  codename=$(. /etc/os-release && echo "$VERSION_CODENAME")
  unknown=$(comm -23 <(sed -nE "s#^[@a-z][^ /]*(/$codename)? +##p" "$root/scripts/apt_packages.txt" | tr -s ' ' '\n' | sort -u) \
    <(apt-cache pkgnames | sort -u))
  [ -z "$unknown" ] || { echo "no Debian package" $unknown; return 1; }
}
if apt-cache show libroscpp-dev >/dev/null 2>&1; then
  check 'the table names packages that exist' everyPackageExists
else
  echo 'skipped the table names packages that exist (no package lists on this machine)'
fi
