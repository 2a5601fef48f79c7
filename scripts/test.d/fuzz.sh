# Fuzzes what reads bytes from outside: every src/PACKAGE/fuzz/NAME_fuzz.cpp becomes a libFuzzer program with the address
# and undefined-behaviour sanitizers and runs for its share of VIBE_FUZZ_SECONDS (60 by default).
#
# A program consists of its file, the sources of vibe_firmware that need no board, and what the file names itself:
#   // sources: src/driver/report_reader.cpp ...   relative to its package, patterns allowed
#   // includes: ../vibe_core/src ...               folders for headers, relative to its package
#   // packages: yaml-cpp ...                      of pkg-config
# It may include public headers of all packages, and those of the src and fuzz folders of its own.
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

if [ -n "${VIBE_VARIANT:-}" ]; then
  echo 'skipped fuzzing (it has sanitizers of its own; runs with scripts/test)'
  exit 0
fi
echo 'extern "C" int LLVMFuzzerTestOneInput(const unsigned char*, unsigned long) { return 0; }' >"$scratch/empty.cpp"
if ! clang++ -fsanitize=fuzzer,address,undefined "$scratch/empty.cpp" -o "$scratch/empty" >"$scratch/clang.log" 2>&1; then
  sed 's/^/    /' "$scratch/clang.log"
  echo 'skipped fuzzing (needs clang and libclang-rt-14-dev; scripts/setup installs them)'
  exit 0
fi

flags=(-std=c++17 -g -O1 -fno-sanitize-recover=undefined -fsanitize=fuzzer,address,undefined)

# named FILE WORD: what the line `// WORD: ...` of a file names
named() { sed -nE "s|^// $2: *||p" "$1"; }

# builds FILE PROGRAM
builds() {
  local file=$1 package pattern sources=() includes=() modules
  package=${file%/fuzz/*}
  sources=("$root"/src/vibe_firmware/src/{core,protocol}/*.cpp)
  for pattern in $(named "$file" sources); do
    # shellcheck disable=SC2206
    sources+=("$package"/$pattern)
  done
  for pattern in "$root"/src/*/include; do includes+=("-I$pattern"); done
  for pattern in $(named "$file" includes); do includes+=("-I$package/$pattern"); done
  modules=$(named "$file" packages)
  # shellcheck disable=SC2046,SC2086
  clang++ "${flags[@]}" "${includes[@]}" -I"$root/src/vibe_firmware/src" -I"$package/src" -I"$package/fuzz" \
    ${modules:+$(pkg-config --cflags $modules)} "$file" "${sources[@]}" ${modules:+$(pkg-config --libs $modules)} -o "$2"
}

# findsNothing PROGRAM SECONDS: the input that breaks it is printed in hexadecimal
findsNothing() {
  local status=0
  mkdir -p "$1.corpus" "$1.findings"
  "$1" -max_total_time="$2" -max_len=4096 -timeout=10 -print_final_stats=1 -artifact_prefix="$1.findings/" "$1.corpus" \
    >"$1.log" 2>&1 || status=$?
  grep -E 'ERROR|SUMMARY|runtime error|stat::number_of_executed_units' "$1.log" || true
  local finding
  for finding in "$1.findings"/*; do [ ! -f "$finding" ] || od -An -tx1 "$finding"; done
  [ "$status" -eq 0 ] && grep -qE 'number_of_executed_units: [0-9]{4,}' "$1.log"
}

programs=()
for file in "$root"/src/*/fuzz/*_fuzz.cpp; do
  name=$(basename "$file" .cpp)
  check "$name compiles" builds "$file" "$scratch/$name"
  [ ! -x "$scratch/$name" ] || programs+=("$scratch/$name")
done

seconds=$((${VIBE_FUZZ_SECONDS:-60} / (${#programs[@]} > 0 ? ${#programs[@]} : 1)))
[ "$seconds" -ge 1 ] || seconds=1
for program in "${programs[@]}"; do
  check "$(basename "$program") finds nothing in $seconds s" findsNothing "$program" "$seconds"
done

# Control: the same way finds an error that is there.
cat >"$scratch/planted.cpp" <<'CPP'
#include <cstdint>
#include <vector>
volatile int read;
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::vector<int> table(64);
  if (size > 1 && data[0] == 'V') read = table[data[1]];
  return 0;
}
CPP
clang++ "${flags[@]}" "$scratch/planted.cpp" -o "$scratch/planted"
findsThePlantedError() {
  ! findsNothing "$scratch/planted" 20 && grep -q 'heap-buffer-overflow' "$scratch/planted.log"
}
check 'control: a planted error is found' findsThePlantedError
