# The examples build against the workspace as packages of their own, their tests pass, and CONTRIBUTING.md shows them. Those
# that need no more than what is installed, `install` builds on the install space, and not here.
# kind: computing
# cost: 200
# packages: docs examples CONTRIBUTING.md vibe_core vibe_hardware vibe_python vibe_rviz_plugins
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

examples=$root/examples

# contributing FILE: every block of code of a page below a line `<!-- file: PATH -->` is that file, its recipe or
# what `<!-- file: PATH from: TEXT to: TEXT -->` cuts out of it; see check_code_blocks.py.
contributing() {
  /usr/bin/python3 "$root/scripts/lib/check_code_blocks.py" "$1" "$root"
}

showsTheFiles() {
  contributing "$root/CONTRIBUTING.md" && contributing "$root/docs/tutorials/steer_to_a_particle.md"
}
check 'code in CONTRIBUTING.md and in the tutorial is that of the files it names' showsTheFiles

# Controls: a block that differs, a file that is missing and a page without blocks are noticed.
noticesADifference() {
  sed '0,/registerMaterialLaw/s//registerMaterialLaws/' "$root/CONTRIBUTING.md" >"$scratch/changed.md"
  ! cmp -s "$root/CONTRIBUTING.md" "$scratch/changed.md" || return 1
  ! contributing "$scratch/changed.md" || return 1
  sed 's#<!-- file: examples/#<!-- file: nowhere/#' "$root/CONTRIBUTING.md" >"$scratch/missing.md"
  ! contributing "$scratch/missing.md" || return 1
  echo 'no code' >"$scratch/none.md"
  ! contributing "$scratch/none.md"
}
check 'a difference to the files is noticed' noticesADifference

[ -f "$root/devel/setup.bash" ] || skip 'examples (not built; scripts/build builds what they need)'
isOrdinary || skip 'examples with sanitizers (they are built as users build them)'
set +u
# shellcheck disable=SC1091
source "$root/devel/setup.bash"
set -u

# build NAME: a catkin workspace that holds this example alone, on top of the built one.
build() {
  local space=$scratch/$1
  mkdir -p "$space/src"
  ln -s /usr/share/catkin/cmake/toplevel.cmake "$space/src/CMakeLists.txt"
  ln -s "$examples/$1" "$space/src/$1"
  cmake -S "$space/src" -B "$space/build" -DCATKIN_DEVEL_PREFIX="$space/devel" -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE='-O1 -DNDEBUG' \
    -DPYTHON_EXECUTABLE=/usr/bin/python3 -DPython3_EXECUTABLE=/usr/bin/python3 || return 1
  cmake --build "$space/build" -j1 || return 1
  ! grep -q '^tests:' <(cmake --build "$space/build" --target help | sed -E 's/^\.\.\. ([a-z]+).*/\1:/') ||
    cmake --build "$space/build" --target tests -j1
}

runTests() {
  (cd "$scratch/$1/build" && ctest --output-on-failure --no-tests=error --timeout 600)
}

# atMost COUNT NAME: the example needs no more files, tests and what makes it a package (CMakeLists.txt, package.xml)
# aside; a limit for how many places an extension touches.
atMost() {
  local files
  files=$(cd "$examples/$2" && find . -type f ! -path './test/*' ! -name CMakeLists.txt ! -name package.xml)
  printf '%s\n' "$files"
  [ "$(wc -l <<<"$files")" -le "$1" ]
}

declare -A limit=([law]=1 [constraint]=2 [display]=3 [task]=1)
for folder in "$examples"/*/; do
  name=$(basename "$folder")
  [ -z "${limit[$name]:-}" ] || check "examples/$name needs at most ${limit[$name]} files" atMost "${limit[$name]}" "$name"
  case $name in law|constraint|lab) continue ;; esac
  check "examples/$name builds outside the workspace" build "$name"
  check "examples/$name passes its tests" runTests "$name"
done
