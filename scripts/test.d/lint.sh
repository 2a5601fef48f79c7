# The form of the code is a test like any other.
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

for name in format door launch bash python; do
  check "lint $name" "$root/scripts/lint" --only "$name"
done

findsBadFormat() {
  printf 'int   main( ){return 0;}\n' >"$scratch/bad.cpp"
  cp "$root/.clang-format" "$scratch/"
  ! "$root/scripts/lint" --only format "$scratch/bad.cpp"
}
check 'lint sees a file that is not formatted' findsBadFormat

seesRosInLibrary() {
  local tree="$scratch/tree with space"
  mkdir -p "$tree/src/vibe_sim/src" "$tree/src/vibe_sim/node" "$tree/.ci"
  cp -r "$root/scripts" "$tree/"
  echo '#include <ros/time.h>' >"$tree/src/vibe_sim/node/allowed.cpp"
  "$tree/scripts/lint" --only door || return 1
  echo '#include "std_msgs/Header.h"' >"$tree/src/vibe_sim/src/forbidden.cpp"
  ! "$tree/scripts/lint" --only door
}
check 'lint sees ROS in a library' seesRosInLibrary
