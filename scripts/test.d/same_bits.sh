# The same bits everywhere: the library calls no elementary function of the C library, and sessions have the same hash
# with g++ and clang++, with every instruction set, and with a C library that uses other code. clang++ compiles the
# kernels that such a session uses, which are linked with what g++ has compiled; VIBE_SLOW_TESTS has it compile the whole
# library, which takes minutes.
# kind: computing
# cost: 120
# timeout: 3600
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

devel=$root/devel${VIBE_VARIANT:-}
if [ -n "${VIBE_VARIANT:-}" ] || [ ! -x "$devel/lib/vibe_core/vibe_headless" ]; then
  echo 'skipped the same bits (needs the Release build; scripts/build makes it)'
  exit 0
fi
if ! command -v clang++ >/dev/null; then
  echo 'skipped the same bits (needs clang++; scripts/setup installs it)'
  exit 0
fi
scratch=$(readlink -f -- "$scratch")
build=$scratch/build

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
  env ROS_PACKAGE_PATH="$root/src" "${preload[@]}" "$@" "$headless" --quiet --duration "$seconds" \
    --script package://vibe_core/trainees/demo/grabs.yaml
}

# agrees HEADLESS NAME=VALUE...: this hash is that of the g++ build with the widest instruction set
agrees() {
  local found
  found=$(of "$@") || return 1
  printf 'expected %s\nfound    %s\n' "$(<"$scratch/expected")" "$found"
  [ "$found" = "$(<"$scratch/expected")" ] && [[ $found =~ ^'state hash: '[0-9a-f]+$ ]]
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

# The library with the kernels of clang++, and everything else of g++.
buildsKernels() {
  /usr/bin/python3 "$root/scripts/lib/relink_library.py" "$root/build" vibe_core clang++ "$mixed" \
    '/src/(sparse/[a-z_]*|tissue/shell_)kernel_[a-z_]*(sse2|avx2|avx512)\.cpp$'
}

# usesTheKernels: the program of g++ does load this library, and clang++ has compiled a part of it.
usesTheKernels() {
  env LD_PRELOAD="$mixed" ldd "$gcc" | tee "$scratch/loaded" | grep -F libvibe_core
  [ "$(grep -c libvibe_core.so "$scratch/loaded")" -eq 1 ] && grep -qF "$mixed" "$scratch/loaded" &&
    readelf -p .comment "$mixed" | grep -i clang
}

builds() {
  local launcher=()
  ! command -v ccache >/dev/null || launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  env CCACHE_NOHASHDIR=1 cmake -S "$root/src/vibe_core" -B "$build" -DCMAKE_DISABLE_FIND_PACKAGE_catkin=ON \
    -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=Release -DBUILD_TESTING=OFF "${launcher[@]}" &&
    env CCACHE_NOHASHDIR=1 cmake --build "$build" --target vibe_headless -j1
}

check 'the library calls no elementary function of the C library' callsNoInexactFunction "$devel/lib/libvibe_core.so"
check 'control: such a call is noticed' noticesACall

seconds=2
preload=()
gcc=$devel/lib/vibe_core/vibe_headless mixed=$scratch/mixed/libvibe_core.so
of "$gcc" X=1 >"$scratch/expected"
# without FMA and AVX2, the C library of Debian 12 uses other code for exp, log, sin, cos, tan, pow and atan
other_code=GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX2_Usable,-FMA_Usable,-FMA4_Usable
flags=" $(grep -m 1 '^flags' /proc/cpuinfo) "
sets=(sse2)
case $flags in *' avx2 '*) case $flags in *' fma '*) sets+=(avx2) ;; esac ;; esac
case $flags in *' avx512vl '*) case $flags in *' avx512dq '*) sets+=(avx512) ;; esac ;; esac

# agreesEverywhere NAME HEADLESS: with every instruction set and with other code of the C library
agreesEverywhere() {
  local set
  check "$1: the same hash" agrees "$2" X=1
  for set in "${sets[@]}"; do
    check "$1: the same hash with $set" agrees "$2" VIBE_INSTRUCTIONS="$set"
  done
  check "$1: the same hash with other code of the C library" agrees "$2" "$other_code"
}

agreesEverywhere gcc "$gcc"
if [ -n "${VIBE_SLOW_TESTS:-}" ]; then
  other='clang' other_headless=$build/vibe_headless
  check 'clang++ builds the library' builds
  check 'what clang++ builds calls no elementary function either' callsNoInexactFunction "$build/libvibe_core.so"
else
  other='kernels of clang' other_headless=$gcc preload=("LD_PRELOAD=$mixed")
  check 'clang++ compiles the kernels' buildsKernels
  check 'the kernels of clang++ are those that are used' usesTheKernels
fi
agreesEverywhere "$other" "$other_headless"
if [ "${#sets[@]}" -gt 1 ]; then
  check 'control: the C library does use other code' cLibraryHasOtherBits
  check 'control: plain arithmetic has another hash' differs "$other_headless" VIBE_ARITHMETIC=plain
  (preload=() && of "$gcc" VIBE_ARITHMETIC=plain) >"$scratch/expected"
  check "$other: the same hash with plain arithmetic" agrees "$other_headless" VIBE_ARITHMETIC=plain
fi
check 'an unknown instruction set is refused' refuses 2 'VIBE_INSTRUCTIONS is' of "$gcc" VIBE_INSTRUCTIONS=mmx
check 'an unknown arithmetic is refused' refuses 2 'VIBE_ARITHMETIC is' of "$gcc" VIBE_ARITHMETIC=exact
