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

printf 'ID=debian\nVERSION_CODENAME=trixie\nPRETTY_NAME="Debian 13"\n' >"$scratch/os-release"
check 'setup refuses another Debian' env VIBE_OS_RELEASE="$scratch/os-release" bash -c \
  "$(declare -f refuses); refuses 1 'Debian 12 .bookworm.*Debian 13' \"\$1\" --missing" - "$setup"
check 'setup goes on when forced' env VIBE_OS_RELEASE="$scratch/os-release" "$setup" --force --missing

check 'nothing is missing once the tests run' bash -c '[ -z "$("$1" --missing)" ]' - "$setup"
check 'setup has nothing to do twice' bash -c '"$1" --yes | grep -qx "Everything is installed."' - "$setup"

everyPackageExists() {
  local unknown
  unknown=$(comm -23 <(sed -nE 's/^[@a-z][^ ]* +//p' "$root/scripts/apt_packages.txt" | tr -s ' ' '\n' | sort -u) \
    <(apt-cache pkgnames | sort -u))
  [ -z "$unknown" ] || { echo "no Debian package" $unknown; return 1; }
}
if apt-cache show libroscpp-dev >/dev/null 2>&1; then
  check 'the table names packages that exist' everyPackageExists
else
  echo 'skipped the table names packages that exist (no package lists on this machine)'
fi
