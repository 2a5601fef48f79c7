# The core without ROS: plain CMake and clang++ build and install a copy of it in an empty environment, and a program
# outside the workspace links it. The same bits everywhere: the library calls no elementary function of the C library, and
# sessions have the same hash in this build and in that of catkin and g++, with every instruction set, with a C library
# that uses other code, and with another Eigen where VIBE_OTHER_EIGEN names the prefix in which one is installed.
# kind: computing
# cost: 300
# timeout: 3600
# packages: README.md vibe_core vibe_python
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

catkin_build=$root/build${VIBE_VARIANT:-}
catkin_devel=$root/devel${VIBE_VARIANT:-}
isOrdinary vibe_core/vibe_headless || skip 'plain CMake (needs the Release build; scripts/build makes it)'
command -v clang++ >/dev/null || skip 'plain CMake (needs clang++; scripts/setup installs it)'

scratch=$(readlink -f -- "$scratch")
source=$scratch/source/vibe_core
build=$scratch/build
prefix=$scratch/first_place
moved=$scratch/second_place
mkdir -p "$scratch/source"
cp -r "$root"/src/vibe_{cmake,core,description,python} "$scratch/source/"

# bare COMMAND...: without ROS, without CMake's search paths, from a folder where nothing lies
bare() {
  (cd / && env -i PATH=/usr/bin:/bin HOME="$scratch" LANG=C.UTF-8 "$@")
}

ros_words='catkin|roscpp|rosconsole|roslib|librostime|xmlrpcpp|_msgs|/opt/ros|/include/ros'

# namesNoRos FILE...: fails with the lines in which a file names a part of ROS
namesNoRos() {
  ! grep -HniE "$ros_words" "$@"
}

eigen=() # another one than that of Debian
[ -z "${VIBE_OTHER_EIGEN:-}" ] || eigen=(-DEigen3_DIR="$VIBE_OTHER_EIGEN/share/eigen3/cmake")

configures() {
  bare cmake "${eigen[@]}" -S "$source" -B "$build" -DCMAKE_INSTALL_PREFIX="$prefix" -DCMAKE_DISABLE_FIND_PACKAGE_catkin=ON \
    -DCMAKE_CXX_COMPILER=clang++ -DVIBE_WARNINGS_ARE_ERRORS="${VIBE_WARNINGS_ARE_ERRORS:-OFF}"
}

builds() { bare cmake --build "$build" -j1; }

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

makesASourceDistribution() {
  echo 'target_compile_options(vibe_python PRIVATE -O0)' >>"$scratch/source/vibe_python/CMakeLists.txt" # the module is but the way to the core
  (cd "$scratch/source/vibe_python" && bare /usr/bin/env -C "$PWD" /usr/bin/python3 setup.py -q sdist -d "$scratch/archive") &&
    ! tar tf "$scratch"/archive/vibe*.tar.gz | grep -E '/test/|__pycache__'
}

# with the core that is installed already, and without network
makesAWheel() {
  bare /usr/bin/python3 -m venv --system-site-packages "$scratch/venv" &&
    bare VIBE_CORE_PREFIX="$moved" CMAKE_BUILD_PARALLEL_LEVEL=1 "$scratch/venv/bin/pip" wheel --no-build-isolation --no-deps \
      --no-index --wheel-dir "$scratch/wheels" "$scratch"/archive/vibe*.tar.gz
}

installsTheWheel() {
  bare "$scratch/venv/bin/pip" install --no-index "$scratch"/wheels/vibe_esg-*.whl && rm -rf "$scratch/source/vibe_python"
}

pythonHash() {
  bare "$scratch/venv/bin/python" -c '
import sys, vibe
if not vibe.__file__.startswith(sys.prefix): sys.exit(vibe.__file__)
simulation = vibe.Simulation(vibe.load())
simulation.run(round(float(sys.argv[1]) / simulation.model.step_period))
print(f"state hash: {simulation.hash():016x}")' "$1"
}

# --- functions of the C library that are exact to the last bit, and those that only look at a number
exact='sqrt|fma|nan|floor|ceil|round|l?lround|l?lrint|rint|nearbyint|trunc|fabs|fmod|remainder|copysign|ldexp|frexp|scalbl?n|modf|nextafter|fmin|fmax|logb|ilogb'

# callsNoInexactFunction LIBRARY: fails with the functions of libm that it calls, apart from these
callsNoInexactFunction() {
  local libm
  libm=$(ldconfig -p | sed -n 's/.*libm\.so\.6.*=> //p' | head -n 1)
  nm -D --defined-only "$libm" | awk '{ print $3 }' | sed 's/@.*//' | sort -u >"$scratch/offered"
  nm -D --undefined-only "$1" | awk '{ print $2 }' | sed 's/@.*//' | sort -u >"$scratch/wanted"
  [ "$(wc -l <"$scratch/offered")" -gt 100 ] && [ -s "$scratch/wanted" ] || { echo 'no symbols were read'; return 1; }
  ! comm -12 "$scratch/offered" "$scratch/wanted" | grep -vxE "($exact)[fl]?"
}

noticesACall() {
  echo '#include <cmath>
double f(double x) { return std::sqrt(x) + std::exp(x); }' >"$scratch/calls.cpp"
  g++ -shared -fPIC -o "$scratch/calls.so" "$scratch/calls.cpp" -lm
  ! callsNoInexactFunction "$scratch/calls.so" >"$scratch/names" && grep -x exp "$scratch/names" && ! grep -x sqrt "$scratch/names"
}

# --- hashes
# of HEADLESS [NAME=VALUE...]: the hash of a few seconds in which the trainee touches the wall and grabs it
of() {
  local headless=$1
  shift
  env ROS_PACKAGE_PATH="$root/src" "$@" "$headless" --quiet --duration "$seconds" \
    --script package://vibe_core/trainees/demo/grabs.yaml
}

# agrees HEADLESS NAME=VALUE...: this hash is that of the g++ build with the widest instruction set
agrees() {
  local found
  found=$(of "$@") || return 1
  printf 'expected %s\nfound    %s\n' "$(<"$scratch/expected")" "$found"
  [ "$found" = "$(<"$scratch/expected")" ] && [[ $found =~ ^'state hash: '[0-9a-f]+$ ]]
}

# a whole session, with needle and thread
hasTheHashOfTheReadme() {
  [ "$(bare "$clang" --quiet --script package://vibe_core/trainees/first.yaml | tee /dev/stderr)" = \
    "$(grep -m 1 '^state hash: ' "$root/README.md")" ]
}

differs() { ! agrees "$@"; }

# what exp and sin of the C library give for many numbers, as a hash
bitsOfTheCLibrary() {
  env "$@" /usr/bin/python3 -c '
import hashlib, math, struct
print(hashlib.sha256(b"".join(struct.pack("3d", math.exp(x), math.sin(x), math.pow(x, 0.3))
                              for x in (k * 0.001 + 1e-5 for k in range(200000)))).hexdigest())'
}

cLibraryHasOtherBits() {
  bitsOfTheCLibrary "$other_code" >"$scratch/other" && bitsOfTheCLibrary X=1 >"$scratch/usual" && ! cmp -s "$scratch/other" "$scratch/usual"
}

check 'plain CMake configures the core in an empty environment' configures
grep -v '^CMAKE_DISABLE_FIND_PACKAGE_catkin:' "$build/CMakeCache.txt" >"$scratch/cache"
check 'plain CMake names no part of ROS when it compiles' namesNoRos "$build/compile_commands.json" "$scratch/cache"
namesCatkin() { ! namesNoRos "$root/build/CMakeCache.txt"; }
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
  bare cmake -S "$scratch/consumer" -B "$scratch/consumer_build" "${eigen[@]}" -DCMAKE_PREFIX_PATH="$moved"
check 'a program elsewhere links the installed library' bare cmake --build "$scratch/consumer_build"
check 'a program elsewhere gives the state of the catkin build' givesTheHashOfCatkin \
  bare "$scratch/consumer_build/run_scene" package://vibe_core/scenes/stomach.yaml "$seconds" -- --duration "$seconds"
if [ ${#eigen[@]} -gt 0 ]; then
  echo 'skipped a wheel of the Python module (it is made with the Eigen of the system)'
else
  check 'a source distribution of the Python module is made, without tests' makesASourceDistribution
  check 'a wheel is made of it in a virtual environment' makesAWheel
  check 'the wheel is installed' installsTheWheel
  check 'the module of the wheel links no part of ROS' namesNoRos <(bare ldd "$scratch"/venv/lib/python3*/site-packages/vibe/_core*.so)
  check 'the module of the wheel gives the state of the catkin build' givesTheHashOfCatkin pythonHash "$seconds" -- --duration "$seconds"
fi
unknownPackage() {
  refuses 2 "There is no package 'vibe_elsewhere'" bare "$moved/bin/vibe_headless" --scene package://vibe_elsewhere/a.yaml
}
check 'control: a package that is not installed is not found' unknownPackage

# --- the same bits
seconds=2
gcc=$catkin_devel/lib/vibe_core/vibe_headless clang=$moved/bin/vibe_headless
of "$gcc" X=1 >"$scratch/expected"
# without FMA and AVX2, the C library of Debian 12 uses other code for exp, log, sin, cos, tan, pow and atan
other_code=GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX2_Usable,-FMA_Usable,-FMA4_Usable
flags=" $(grep -m 1 '^flags' /proc/cpuinfo) "
sets=(sse2)
case $flags in *' avx2 '*) case $flags in *' fma '*) sets+=(avx2) ;; esac ;; esac
case $flags in *' avx512vl '*) case $flags in *' avx512dq '*) sets+=(avx512) ;; esac ;; esac

check 'the library calls no elementary function of the C library' callsNoInexactFunction "$catkin_devel/lib/libvibe_core.so"
check 'what clang++ builds calls none either' callsNoInexactFunction "$build/libvibe_core.so"
check 'control: such a call is noticed' noticesACall
for compiler in gcc clang; do
  headless=${!compiler}
  check "$compiler: the same hash" agrees "$headless" X=1
  for set in "${sets[@]}"; do
    check "$compiler: the same hash with $set" agrees "$headless" VIBE_INSTRUCTIONS="$set"
  done
  check "$compiler: the same hash with other code of the C library" agrees "$headless" "$other_code"
done
if [ "${#sets[@]}" -gt 1 ]; then
  check 'clang: the first session has the hash of the README' hasTheHashOfTheReadme
  check 'control: the C library does use other code' cLibraryHasOtherBits
  check 'control: plain arithmetic has another hash' differs "$gcc" VIBE_ARITHMETIC=plain
  of "$gcc" VIBE_ARITHMETIC=plain >"$scratch/expected"
  check 'clang: the same hash with plain arithmetic' agrees "$clang" VIBE_ARITHMETIC=plain
fi
[ ${#eigen[@]} -gt 0 ] || echo 'skipped the same hash with another Eigen (VIBE_OTHER_EIGEN names none)'
check 'an unknown instruction set is refused' refuses 2 'VIBE_INSTRUCTIONS is' of "$gcc" VIBE_INSTRUCTIONS=mmx
check 'an unknown arithmetic is refused' refuses 2 'VIBE_ARITHMETIC is' of "$gcc" VIBE_ARITHMETIC=exact
