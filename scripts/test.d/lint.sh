# The form of the code is a test like any other.
# kind: computing
# cost: 60
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

for name in tracked door rooms names writers launch links pictures catkin bash python; do
  check "lint $name" "$root/scripts/lint" --only "$name"
done

findsBadFormat() {
  printf 'int   main( ){return 0;}\n' >"$scratch/bad.cpp"
  cp "$root/.clang-format" "$scratch/"
  ! "$root/scripts/lint" --only format "$scratch/bad.cpp"
}
if "$root/scripts/lint" --only format "$root/src/vibe_core/include/vibe_core/program/error.hpp" | grep -q '^format: skipped'; then
  echo 'skipped lint format (clang-format is not of the version that formats the code)'
else
  check 'lint format' "$root/scripts/lint" --only format
  check 'lint sees a file that is not formatted' findsBadFormat
fi

# refusesToFix: a clang-format of another version is not let loose on the code
refusesToFix() {
  local tree bin=$scratch/other_bin
  tree=$(copyOfTree)
  mkdir "$bin"
  printf '#!/bin/sh\n[ "$1" = --version ] && echo "clang-format version 99.1.0" || touch "%s/ran"\n' "$bin" >"$bin/clang-format"
  chmod +x "$bin/clang-format"
  sed -i "s#export PATH=#export PATH=$bin:#; s#^format_version=.*#format_version=98#" "$tree/scripts/lib/common.sh" "$tree/scripts/lint"
  "$tree/scripts/lint" --only format | grep -E '^format: skipped, .* clang-format 98, .*version 99' || return 1
  refuses 1 'not clean: format' bash -c '"$1" --only format --fix 2>&1 >/dev/null' - "$tree/scripts/lint" && [ ! -e "$bin/ran" ]
}

# passes CHECK TREE: nothing is found
passes() { "$2/scripts/lint" --only "$1" || { echo 'finds a problem where none is'; return 1; }; }

# sees CHECK TREE WORD...: lint finds something, and grep with these words finds it in what lint says
sees() {
  refuses 1 "not clean: $1" bash -c '"$1" --only "$2" 2>&1 >"$3"' - "$2/scripts/lint" "$1" "$2/said" && cat "$2/said" && grep -q "${@:3}" "$2/said"
}

# Makes a small workspace without a problem, in a folder with a space in its name, and prints the folder.
copyOfTree() {
  local tree
  tree=$(mktemp -d "$scratch/tree with space XXXXXX")
  mkdir -p "$tree/src/vibe_sim/node" "$tree/.ci" "$tree/docs"
  mkdir -p "$tree"/src/vibe_core/{include/vibe_core,src}/{program,state,solver}
  cp -r "$root/scripts" "$tree/"
  cp "$root/docs/architecture.md" "$tree/docs/"
  echo '#include "vibe_core/program/error.hpp"' >"$tree/src/vibe_core/include/vibe_core/state/state.hpp"
  echo '#include <stdexcept>' >"$tree/src/vibe_core/include/vibe_core/program/error.hpp"
  echo '#include "vibe_core/state/state.hpp"' >"$tree/src/vibe_core/src/solver/stepper.hpp"
  echo '#include "solver/stepper.hpp"' >"$tree/src/vibe_core/src/solver/stepper.cpp"
  echo "$tree"
}

check 'lint lets no other clang-format judge or rewrite the code' refusesToFix

# A file is added, changed and known; then there is one that only the work tree has.
seesAForgottenFile() {
  local tree
  tree=$(copyOfTree)
  "$tree/scripts/lint" --only tracked | grep -q '^tracked: skipped' || return 1
  git -C "$tree" init -q && git -C "$tree" add . && echo >>"$tree/src/vibe_core/src/solver/stepper.cpp" && passes tracked "$tree" || return 1
  echo '>>>>>>> other' >"$tree/docs/merged.md" && git -C "$tree" add docs && sees tracked "$tree" -F 'docs/merged.md:1:' || return 1
  rm "$tree/docs/merged.md"
  touch "$tree/src/vibe_core/src/solver/forgotten.hpp"
  sees tracked "$tree" -Fx 'src/vibe_core/src/solver/forgotten.hpp'
}
check 'lint sees a file that a clone would lack' seesAForgottenFile

# findsRosIn FILE LINE: adds a file with this line below src/ of a tree that passes; lint must name the file
findsRosIn() {
  local tree
  tree=$(copyOfTree)
  echo '#include <ros/time.h>' >"$tree/src/vibe_sim/node/allowed.cpp"
  passes door "$tree" || return 1
  mkdir -p "$(dirname "$tree/src/$1")"
  echo "$2" >"$tree/src/$1"
  sees door "$tree" -F "$1:1:"
}
check 'lint sees ROS in the core' findsRosIn vibe_core/src/program/a.cpp '#include <ros/ros.h>'
check 'lint sees a message in a public header' findsRosIn vibe_core/include/vibe_core/program/a.hpp \
  '#include "std_msgs/Header.h"'
check 'lint sees ROS in a program of the core' findsRosIn vibe_core/programs/a.cpp '#  include <tf2_ros/buffer.h>'
check 'lint sees ROS in a test of the core' findsRosIn vibe_core/test/program/a_test.cpp '#include <rosbag/bag.h>'
check 'lint sees ROS in the benchmarks' findsRosIn vibe_benchmarks/src/fem/a.cpp '#include "vibe_msgs/TissueState.h"'
for header in cv_bridge/cv_bridge image_transport/image_transport camera_info_manager/camera_info_manager \
  diagnostic_updater/diagnostic_updater; do
  check "lint sees ${header%%/*} in the library of the cameras" findsRosIn vibe_vision/src/camera/a.cpp \
    "#include <$header.h>"
done
check 'lint sees ROS in a library of the displays' findsRosIn vibe_graphics/src/geometry/a.hpp \
  '#include <rviz/display.h>'

# A picture of a tree that passes; then what it shows changes, it has no row, or its row has no picture.
seesAnOldPicture() {
  local tree rows
  tree=$(copyOfTree) rows=docs/pictures/made.csv
  mkdir "$tree/docs/pictures" "$tree/plot" && cd "$tree" && echo 1 >plot/data.csv && touch docs/pictures/plot.png
  printf 'picture,date,digest,command,shows\nplot.png,2020-01-01,0,draw,plot\n' >$rows
  scripts/lib/check_pictures.py . --made plot.png && scripts/lint --only pictures || return 1
  says() { scripts/lint --only pictures | grep -F "docs/pictures/$1"; }
  echo 2 >>plot/data.csv && says 'plot.png: is of 20' && sed -i 's/,[0-9a-f]*,draw/,older,draw/' $rows && scripts/lint --only pictures &&
    touch docs/pictures/other.svg && says 'other.svg: has 0 rows' && rm docs/pictures/plot.png && says 'plot.png: is in made.csv and not'
}
check 'lint sees a picture that is older than what it shows' seesAnOldPicture

# findsRoomProblem FILE LINE PATTERN: adds a line to a file of an orderly tree; lint must name file, line and problem
findsRoomProblem() {
  local tree
  tree=$(copyOfTree)
  passes rooms "$tree" || return 1
  mkdir -p "$(dirname "$tree/src/vibe_core/$1")"
  printf '#include <vector>\n%s\n' "$2" >>"$tree/src/vibe_core/$1"
  sees rooms "$tree" -E "^src/vibe_core/$1:[0-9]+: .*$3"
}
check 'lint sees a circle between rooms' \
  findsRoomProblem src/state/a.cpp '#include "solver/stepper.hpp"' 'solver comes after state'
check 'lint sees a public include that goes up' findsRoomProblem include/vibe_core/program/error.hpp \
  '#include "vibe_core/state/state.hpp"' 'state comes after program'
check 'lint sees an internal include in a public header' findsRoomProblem include/vibe_core/solver/a.hpp \
  '#include "solver/stepper.hpp"' 'public header includes the internal'
check 'lint sees an include by bare name' findsRoomProblem src/solver/a.cpp '#include "stepper.hpp"' 'does not name its room'
check 'lint sees a room that is not in the table' findsRoomProblem src/attic/a.cpp '' 'lies in no room'
check 'lint sees an include of a header that is not there' findsRoomProblem src/solver/a.cpp \
  '#include "vibe_core/state/lost.hpp"' 'is no public header'

seesRoomsOfTheCameras() {
  local tree
  tree=$(copyOfTree)
  mkdir -p "$tree"/src/vibe_vision/src/{tag,track}
  touch "$tree/src/vibe_vision/src/track/a.hpp"
  passes rooms "$tree" || return 1
  echo '#include "track/a.hpp"' >"$tree/src/vibe_vision/src/tag/a.cpp"
  sees rooms "$tree" -F 'src/vibe_vision/src/tag/a.cpp:1: tag includes "track/a.hpp", but track comes after tag'
}
check 'lint sees a circle between rooms of the cameras' seesRoomsOfTheCameras

# findsName FILE TEXT PATTERN: two sources of a folder and a header pass; with TEXT in FILE lint must name the problem
findsName() {
  local tree core
  tree=$(copyOfTree) core=$tree/src/vibe_core
  printf '#pragma once\nnamespace vibe {\nenum Kind { kFirst, kSecond };\n}  // namespace vibe\n' >"$core/include/vibe_core/solver/kind.hpp"
  printf 'namespace vibe {\nnamespace {\nint used() {\n  return kFirst;\n}\n}  // namespace\n}  // namespace vibe\n' >"$core/src/solver/use.cpp"
  passes names "$tree" || return 1
  printf 'namespace vibe {\nnamespace {\n%s\n}  // namespace\n}  // namespace vibe\n' "$2" >"$core/src/solver/$1"
  sees names "$tree" -E "^src/vibe_core/src/solver/[a-z]+.[ch]pp:[34]: .*$3"
}
check 'lint sees a value that hides that of a header' findsName other.cpp 'enum Item { kFirst = 7 };' \
  "'kFirst' hides that of .*kind.hpp in use.cpp"
check 'lint sees a constant that hides a value of a header' findsName other.cpp 'constexpr int kFirst = 7;' \
  "'kFirst' hides that of .*kind.hpp in use.cpp"
check 'lint sees a function in two sources of a folder' findsName very.cpp 'double used(double x) {
  return x;
}' "'used' stands in use.cpp, too"
check 'lint sees a comment on a parameter that has another name' findsName very.hpp '/// @param lack  [m]
double tension(double residual);' "'@param lack' is no parameter of what follows"

# findsWriter FILE LINE: a file passes whose writer is whole or says why not; with another line lint must name it
findsWriter() {
  local tree
  tree=$(copyOfTree)
  printf 'with whole(path) as part, open(part, "w") as file:\n    pass\nopen(log, "a")  # not whole: a log\nopen(path)\n' >"$tree/src/vibe_core/good.py"
  printf 'WholeFile whole(file, "Table");\nstd::ofstream out(whole.part());\nstd::ifstream in(file);\n' >"$tree/src/vibe_core/src/good.cpp"
  passes writers "$tree" || return 1
  printf '\n\n%s\n' "$2" >"$tree/src/vibe_core/src/$1"
  sees writers "$tree" -F "src/vibe_core/src/$1:3:$2"
}
seesWriters() {
  findsWriter bad.py 'with open(path, "w", encoding="utf-8") as file:' && findsWriter bad.py 'figure.savefig(picture)' &&
    findsWriter bad.py 'np.savez(file, *parts)' && findsWriter bad.py 'file.write_text(text)' &&
    findsWriter bad.cpp '  std::ofstream out(file);' && findsWriter bad.hpp '  std::ofstream out_;' &&
    findsWriter bad.cpp '  video_.open(file, codec, rate, size);' && findsWriter bad.cpp 'const int to = ::open(file, O_CREAT, 0600);' &&
    findsWriter bad.cpp '  if (!cv::imwrite(file, image)) fail();' && findsWriter bad.cpp 'FILE* f = std::fopen(name, mode);'
}
check 'lint sees files that may be left half' seesWriters

# findsLink LINE PATTERN: two pages pass; with a line in one of them lint must name the problem
findsLink() {
  local tree
  tree=$(copyOfTree)
  rm "$tree/docs/architecture.md"
  printf '# Title\n\n## A `name` here\n\n`[no](link.md)`\n\n```\n[no](link.md)\n```\n' >"$tree/docs/a.md"
  printf '# Other\n\n[a](a.md#a-name-here), [folder](../src), [web](https://example.org/x.md)\n' >"$tree/docs/b.md"
  passes links "$tree" || return 1
  printf '\n%s\n' "$1" >>"$tree/docs/b.md"
  sees links "$tree" -E "^docs/b.md: $2"
}
check 'lint sees a link to a file that is not there' findsLink '[x](c.md)' "'c.md' is not there"
check 'lint sees a link to a heading that is not there' findsLink '[x](a.md#a-name)' "'a.md#a-name': that page has no such heading"

seesAProgramThatDoesNotParse() {
  local tree
  tree=$(copyOfTree)
  printf '#!/usr/bin/env %s\n%s\n' "$1" "$2" >"$tree/src/vibe_sim/program"
  "$tree/scripts/lint" --only "${1%3}" && { echo 'sees nothing'; return 1; }
  sed -i 2d "$tree/src/vibe_sim/program"
  "$tree/scripts/lint" --only "${1%3}"
}
check 'lint sees a program in Python that does not parse' seesAProgramThatDoesNotParse python3 'if:'
check 'lint sees a program in bash that does not parse' seesAProgramThatDoesNotParse bash 'if then'

seesThatThereIsNothing() {
  local tree
  tree=$(copyOfTree)
  rm -r "$tree/src"
  mkdir "$tree/src"
  "$tree/scripts/lint" --only format && return 1
  "$tree/scripts/lint" --only format | grep -x 'format: FAILED, there is no file to look at'
}
check 'lint fails where there is no file to look at' seesThatThereIsNothing

# tidies LINE: clang-tidy on a source with this line, for which CMake has a command
tidies() {
  local tree source
  tree=$(copyOfTree)
  cp "$root/.clang-tidy" "$tree/"
  printf '#!/bin/sh\n' >"$tree/scripts/build"
  source=$(readlink -f "$tree")/src/vibe_core/src/state/a.cpp
  mkdir -p "$tree/build-separate" "${source%/*}"
  rm "$tree"/src/vibe_core/src/solver/stepper.cpp
  printf '%s\n' "$1" >"$source"
  printf '[\n{\n  "directory": "%s",\n  "command": "c++ -c %s",\n  "file": "%s"\n}\n]\n' / "'$source'" "$source" \
    >"$tree/build-separate/compile_commands.json"
  [ -z "${2:-}" ] || cp "$source" "${source%/*}/$2"
  "$tree/scripts/lint" --only tidy
}
tidyFinds() {
  tidies 'int* f() { return nullptr; }' | grep -x 'tidy: ok, 1 files' && ! tidies 'int* f() { return 0; }'
}
seesASourceWithoutCommand() {
  local said
  said=$(tidies 'int* f() { return nullptr; }' b.cpp) && return 1
  printf '%s\n' "$said"
  grep -q '^clang-tidy cannot check these' <<<"$said" && grep -q '/b.cpp$' <<<"$said"
}
check 'lint makes clang-tidy look at a source' tidyFinds
check 'lint sees a source that CMake does not compile' seesASourceWithoutCommand
