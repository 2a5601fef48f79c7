# The workspace works from its install space (catkin_make install), and packages of others build against that alone.
# kind: computing
# cost: 250
# packages: examples vibe_bringup vibe_benchmarks vibe_python vibe_rviz_plugins vibe_testing
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

ordinaryBuild install lib/vibe_core/vibe_headless
prefix=$(sed -n 's/^CMAKE_INSTALL_PREFIX:PATH=//p' "$root/build/CMakeCache.txt")
space=$scratch$prefix # catkin writes the setup files to this prefix, whatever `cmake --install --prefix` says

installs() {
  DESTDIR=$scratch cmake --install "$root/build" >"$scratch/install.txt" || { tail "$scratch/install.txt"; return 1; }
  [ -f "$space/setup.bash" ]
}
check 'the workspace is installed' installs

# inSpace PROGRAM ARGUMENT...: with the environment of the install space alone.
inSpace() {
  env -i HOME="$HOME" PATH="/usr/local/bin:/usr/bin:/bin" LANG=C.UTF-8 ROS_HOSTNAME=localhost ROS_HOME="$scratch/ros" \
    ROS_MASTER_URI="${ROS_MASTER_URI:-http://localhost:11311}" \
    bash -c 'setup=$1/setup.bash words=("${@:2}") && set -- && source "$setup" && exec "${words[@]}"' bash "$space" "$@"
}

# Nothing of the source folder or of the development space may be in use.
isAlone() {
  inSpace env | grep -E '^(CMAKE_PREFIX_PATH|ROS_PACKAGE_PATH|PYTHONPATH|LD_LIBRARY_PATH)=' >"$scratch/env.txt"
  cat "$scratch/env.txt"
  grep -qF "$space" "$scratch/env.txt" && ! sed "s|$space||g" "$scratch/env.txt" | grep -F "$root/"
}
check 'its environment has no path of the sources' isAlone

runsAScene() {
  inSpace rosrun vibe_core vibe_headless --script package://vibe_core/trainees/demo/grabs.yaml --duration 1 --quiet
}
check 'a scene and a script of the install space run' runsAScene

# The page is drawn elsewhere.
webNodeDrawsNothing() {
  inSpace ldd "$space/lib/vibe_web/web_node" >"$scratch/libraries.txt"
  cat "$scratch/libraries.txt"
  grep -q 'libvibe_shapes.so => /' "$scratch/libraries.txt" && ! grep -E 'libQt|librviz|libOgre|not found' "$scratch/libraries.txt"
}
check 'the node of the page links no rviz, Qt or Ogre' webNodeDrawsNothing

findsPlugins() {
  inSpace rospack plugins --attrib=plugin rviz | tee "$scratch/plugins.txt"
  grep -q "^vibe_rviz_plugins $space/" "$scratch/plugins.txt"
}
check 'rviz finds the plugins' findsPlugins

hasMeshes() {
  local address
  grep -o 'package://vibe_description/[^"]*' "$space/share/vibe_description/urdf/scope.urdf" | sort -u >"$scratch/meshes.txt"
  [ -s "$scratch/meshes.txt" ] || { echo 'the URDF names no mesh'; return 1; }
  while IFS= read -r address; do
    [ -s "$space/share/vibe_description/${address#package://vibe_description/}" ] || { echo "$address"; return 1; }
  done <"$scratch/meshes.txt"
  [ -s "$space/share/vibe_description/meshes/scope.mtl" ]
}
check 'the meshes of the URDF are installed' hasMeshes

usesTheModule() {
  inSpace /usr/bin/python3 -B -c 'import vibe, vibe.env
s = vibe.Simulation(vibe.load("package://vibe_core/scenes/sphere.yaml"))
s.run(5)
assert s.steps == 5 and vibe.__file__.startswith("'"$space"'"), vibe.__file__'
}
check 'the Python module runs a scene' usesTheModule

check 'rostests of others can use vibe_testing' inSpace /usr/bin/python3 -c \
  'import vibe_testing.program, vibe_testing.recorder, vibe_testing.diagnostics, vibe_testing.virtual_display'

helps() {
  local program
  for program in 'vibe_sim sim_node' 'vibe_sim vibe_replay' 'vibe_sim vibe_record' 'vibe_sim vibe_player' \
    'vibe_sessions report' 'vibe_sessions cohort' 'vibe_sessions export' 'vibe_sessions regression' 'vibe_bringup record' \
    'vibe_bringup report' 'vibe_bringup picture' 'vibe_bringup views' 'vibe_bringup latency' 'vibe_bringup dataset' \
    'vibe_benchmarks vibe_bench'; do
    # shellcheck disable=SC2086
    inSpace rosrun $program --help >"$scratch/help.txt" 2>&1 || { echo "$program"; cat "$scratch/help.txt"; return 1; }
  done
}
check 'its programs start' helps

sessionRuns() {
  inSpace rosrun vibe_bringup run --headless --fast --duration 2 --output "$scratch/session" >"$scratch/session.txt" 2>&1 ||
    { cat "$scratch/session.txt"; return 1; }
  cat "$scratch/session.txt"
  grep -q '^state hash: ' "$scratch/session/summary.txt" && grep -qF "scene = $space/share/" "$scratch/session.txt" &&
    inSpace rosrun vibe_bringup replay "$scratch/session/session.bag" | grep '^the same: all 120 steps'
}
check 'a session runs, is recorded and repeats' sessionRuns

aRegressionPasses() {
  inSpace rosrun vibe_sessions regression "$space/share/vibe_sessions/regressions/sphere.regression.yaml"
}
check 'a shipped regression passes' aRegressionPasses

# build NAME: a workspace of somebody else with this example alone, on top of the install space.
build() {
  local mine=$scratch/$1
  mkdir -p "$mine/src"
  ln -s /usr/share/catkin/cmake/toplevel.cmake "$mine/src/CMakeLists.txt"
  cp -r "$root/examples/$1" "$mine/src/$1"
  inSpace cmake -S "$mine/src" -B "$mine/build" -DCATKIN_DEVEL_PREFIX="$mine/devel" -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE='-O1 -DNDEBUG' \
    -DCMAKE_INSTALL_PREFIX="$mine/install" -DPYTHON_EXECUTABLE=/usr/bin/python3 -DPython3_EXECUTABLE=/usr/bin/python3 &&
    inSpace cmake --build "$mine/build" -j1 && inSpace cmake --build "$mine/build" -j1 --target tests &&
    inSpace env --chdir="$mine/build" ctest --output-on-failure --no-tests=error --timeout 600
}
for name in law constraint lab; do
  check "examples/$name builds and passes its tests on the install space alone" build "$name"
done

# The shipped programs know the law once its library is loaded, and only then.
programKnowsTheLaw() {
  local words=(rosrun vibe_core vibe_headless --quiet --duration 0.1 --scene "$scratch/polynomial.yaml")
  printf 'geometry: {kind: sphere, particles: 200}\ntissue: {law: polynomial}\n' >"$scratch/polynomial.yaml"
  inSpace env VIBE_PLUGINS="$scratch/law/devel/lib/libvibe_example_law.so" "${words[@]}" || return 1
  refuses 2 "polynomial.yaml:2: tissue.law: 'polynomial' is not known here" inSpace "${words[@]}"
}
check 'vibe_headless runs a scene with the law of the example' programKnowsTheLaw

# Control: what is not installed is not found.
noticesWhatIsMissing() {
  mv "$space/include/vibe_core/tissue/material_registry.hpp" "$scratch/"
  ! build law >/dev/null 2>&1
}
rm -rf -- "$scratch/law"
check 'a header that is not installed is noticed' noticesWhatIsMissing
