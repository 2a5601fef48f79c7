# The core without ROS: plain CMake builds and installs a copy of it in an empty environment, a program outside the
# workspace links it, and both give the same states as the catkin build.
# kind: computing
# cost: 120
# timeout: 3600
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

catkin_build=$root/build${VIBE_VARIANT:-}
catkin_devel=$root/devel${VIBE_VARIANT:-}
if [ -n "${VIBE_VARIANT:-}" ] || [ ! -x "$catkin_devel/lib/vibe_core/vibe_headless" ]; then
  echo 'skipped plain CMake (needs the Release build; scripts/build makes it)'
  exit 0
fi

scratch=$(readlink -f -- "$scratch")
source=$scratch/source/vibe_core
build=$scratch/build
prefix=$scratch/first_place
moved=$scratch/second_place
mkdir -p "$scratch/source"
cp -r "$root/src/vibe_core" "$root/src/vibe_description" "$scratch/source/"

# bare COMMAND...: without ROS, without CMake's search paths, from a folder where nothing lies
bare() {
  (cd / && env -i PATH=/usr/bin:/bin HOME="$scratch" LANG=C.UTF-8 "$@")
}

ros_words='catkin|roscpp|rosconsole|roslib|librostime|xmlrpcpp|_msgs|/opt/ros|/include/ros'

# namesNoRos FILE...: fails with the lines in which a file names a part of ROS
namesNoRos() {
  ! grep -HniE "$ros_words" "$@"
}

configures() {
  bare cmake -S "$source" -B "$build" -DCMAKE_INSTALL_PREFIX="$prefix" -DCMAKE_DISABLE_FIND_PACKAGE_catkin=ON
}

# Compiling everything again takes five minutes. What catkin has compiled from equal files with equal commands is taken
# over; VIBE_SLOW_TESTS compiles all of it.
builds() {
  [ -n "${VIBE_SLOW_TESTS:-}" ] ||
    /usr/bin/python3 "$root/scripts/lib/reuse_objects.py" "$catkin_build" "$root/src/vibe_core" "$build" "$source"
  bare cmake --build "$build" -j1
}

linksNoRos() {
  local file
  for file in "$prefix"/lib/*.so "$prefix"/lib/*/*.so "$prefix"/bin/*; do
    [ ! -f "$file" ] || bare ldd "$file" >>"$scratch/linked" || return 1
  done
  grep -q libvibe_core "$scratch/linked" && namesNoRos "$scratch/linked"
}

# installedHash OPTION..., catkinHash OPTION...: the line `state hash: ...` of either program
installedHash() {
  bare "$moved/bin/vibe_headless" --quiet "$@"
}

catkinHash() {
  ROS_PACKAGE_PATH=$root/src "$catkin_devel/lib/vibe_core/vibe_headless" --quiet "$@"
}

# givesTheHashOfCatkin COMMAND... -- OPTION...: both print the same `state hash: ...`
givesTheHashOfCatkin() {
  local command=() found expected
  while [ "$1" != -- ]; do command+=("$1"); shift; done
  shift
  found=$("${command[@]}") && expected=$(catkinHash "$@") || return 1
  printf 'plain:  %s\ncatkin: %s\n' "$found" "$expected"
  [ "$found" = "$expected" ] && [[ $found =~ ^'state hash: '[0-9a-f]+$ ]]
}

readsAMeshByARelativePath() {
  mkdir -p "$scratch/meshes"
  /usr/bin/python3 - "$scratch/meshes/ball.obj" <<'PYTHON'
import math, sys
rows, columns, radius = 12, 20, 60
points = [(0, 0, radius)] + [(radius * math.sin(t) * math.cos(p), radius * math.sin(t) * math.sin(p), radius * math.cos(t))
          for t in (math.pi * r / rows for r in range(1, rows)) for p in (2 * math.pi * c / columns for c in range(columns))]
points.append((0, 0, -radius))
at = lambda r, c: 2 + (r - 1) * columns + c % columns
faces = [f for c in range(columns) for f in [(1, at(1, c), at(1, c + 1)), (len(points), at(rows - 1, c + 1), at(rows - 1, c))]]
for r in range(1, rows - 1):
    for c in range(columns):
        faces += [(at(r, c), at(r + 1, c), at(r + 1, c + 1)), (at(r, c), at(r + 1, c + 1), at(r, c + 1))]
with open(sys.argv[1], 'w') as file:
    file.writelines('v %.6f %.6f %.6f\n' % p for p in points)
    file.writelines('f %d %d %d\n' % f for f in faces)
PYTHON
  cat >"$scratch/meshes/ball.obj.landmarks.yaml" <<'YAML'
unit: 1 mm
landmarks: {oesophagus: [0, 42, 42], fundus: [0, 0, 60], incisura: [0, 60, 0], pylorus: [0, 0, -60]}
YAML
  (cd "$scratch" && env -i PATH=/usr/bin:/bin "$moved/bin/vibe_headless" --quiet --duration 0.1 \
    --scene package://vibe_core/scenes/sphere.yaml --mesh meshes/ball.obj)
}

check 'plain CMake configures the core in an empty environment' configures
grep -v '^CMAKE_DISABLE_FIND_PACKAGE_catkin:' "$build/CMakeCache.txt" >"$scratch/cache"
check 'plain CMake names no part of ROS when it compiles' namesNoRos "$build/compile_commands.json" "$scratch/cache"
namesCatkin() { ! namesNoRos "$catkin_build/CMakeCache.txt"; }
check 'control: the catkin build does name ROS' namesCatkin
check 'plain CMake builds the core' builds
check 'plain CMake installs the core' bare cmake --install "$build"
check 'what is installed links no part of ROS' linksNoRos
exported=("$prefix"/lib*/cmake/vibe_core/*.cmake "$prefix"/lib/*/cmake/vibe_core/*.cmake)
for file in "${!exported[@]}"; do [ -f "${exported[file]}" ] || unset "exported[file]"; done
check 'the exported CMake files name no part of ROS' namesNoRos "${exported[@]}"

# from here on every check also shows that an installation may be moved
mv "$prefix" "$moved"
seconds=0.2
check 'the installed vibe_headless finds its scene and gives the state of the catkin build' \
  givesTheHashOfCatkin installedHash --duration "$seconds" -- --duration "$seconds"
check 'the installed vibe_headless reads a mesh by a relative path' readsAMeshByARelativePath
cp -r "$root/src/vibe_core/test/install" "$scratch/consumer"
check 'a program elsewhere finds the installed library' \
  bare cmake -S "$scratch/consumer" -B "$scratch/consumer_build" -DCMAKE_PREFIX_PATH="$moved"
check 'a program elsewhere links the installed library' bare cmake --build "$scratch/consumer_build"
check 'a program elsewhere gives the state of the catkin build' givesTheHashOfCatkin \
  bare "$scratch/consumer_build/run_scene" package://vibe_core/scenes/stomach.yaml "$seconds" -- --duration "$seconds"
unknownPackage() {
  refuses 2 "There is no package 'vibe_elsewhere'" bare "$moved/bin/vibe_headless" --scene package://vibe_elsewhere/a.yaml
}
check 'control: a package that is not installed is not found' unknownPackage
