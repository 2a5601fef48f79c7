# Fuzzes what reads bytes from outside: every src/PACKAGE/fuzz/NAME_fuzz.cpp becomes a libFuzzer program with the address
# and undefined-behaviour sanitizers and runs for VIBE_FUZZ_SECONDS, two at once: 10 s by default, 60 s with
# VIBE_SLOW_TESTS. It starts from the files in src/PACKAGE/fuzz/corpus/NAME/, if there are any: examples, and what it
# once found.
# kind: computing
# units: 4
# cost: 300
# timeout: 3600
# packages: vibe_core vibe_firmware vibe_hardware vibe_sim vibe_vision vibe_web
#
# A program consists of its file, the sources of vibe_firmware that need no board, and what the file names itself:
#   // sources: src/driver/report_reader.cpp ...   relative to its package, patterns allowed
#   // includes: ../vibe_firmware/fuzz ...         folders for headers of the file, relative to its package
#   // packages: yaml-cpp ...                      of pkg-config
#   // units: 100                                  that it must execute at least, if not 1000
#   // corpus: scenes ...                          folders with more examples, relative to its package
# Every file may include public headers of all packages, and those of the src, node and fuzz folders of its own. A source that
# several programs name is compiled once, and with those of its folder that the same programs name.
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

isOrdinary || skip 'fuzzing (it has sanitizers of its own; runs with scripts/test)'
echo 'extern "C" int LLVMFuzzerTestOneInput(const unsigned char*, unsigned long) { return 0; }' >"$scratch/empty.cpp"
if ! clang++ -fsanitize=fuzzer,address,undefined "$scratch/empty.cpp" -o "$scratch/empty" >"$scratch/clang.log" 2>&1; then
  sed 's/^/    /' "$scratch/clang.log"
  skip 'fuzzing (needs clang and libclang-rt-14-dev; scripts/setup installs them)'
fi

seconds=${VIBE_FUZZ_SECONDS:-$([ -n "${VIBE_SLOW_TESTS:-}" ] && echo 60 || echo 10)}
flags=(-std=c++17 -gline-tables-only -O1 -fno-sanitize-recover=all
  -fsanitize=fuzzer,address,undefined,float-cast-overflow)
fuzz_files=("$root"/src/*/fuzz/*_fuzz.cpp)

# named FILE WORD: what the line `// WORD: ...` of a file names
named() { sed -nE "s|^// $2: *||p" "$1"; }

# twoAtOnce COMMAND...: starts it when fewer than two run
twoAtOnce() {
  while [ "$(jobs -rp | wc -l)" -ge 2 ]; do wait -n || true; done
  "$@" &
}

# sourcesOf FILE: the files that its program consists of
sourcesOf() {
  local package=${1%/fuzz/*} pattern
  realpath -e -- "$1" "$root"/src/vibe_firmware/src/{core,protocol}/*.cpp
  # shellcheck disable=SC2046,SC2086
  for pattern in $(named "$1" sources); do realpath -e -- $package/$pattern; done
}

# unit_of[SOURCE]: the file that includes it with the sources of its folder that belong to the same programs
declare -A programs_of=() unit_of=() unit_named=()
makeUnits() {
  local file source key
  for file in "${fuzz_files[@]}"; do
    for source in $(sourcesOf "$file"); do programs_of[$source]+=" $file"; done
  done
  for source in $(printf '%s\n' "${!programs_of[@]}" | sort); do
    key="${source%/*}${programs_of[$source]}"
    [ -n "${unit_named[$key]:-}" ] || unit_named[$key]=$scratch/unit${#unit_named[@]}.cpp
    unit_of[$source]=${unit_named[$key]}
    printf '#include "%s"\n' "$source" >>"${unit_named[$key]}"
  done
}

# compiles UNIT: its object, or what the compiler says beside it
compiles() {
  local folder first own includes=()
  first=$(sed -nE '1s|^#include "(.*)"$|\1|p' "$1")
  own=$(sed -E "s|^($root/src/[^/]+)/.*|\1|" <<<"$first")
  for folder in "$root"/src/*/include "$root/src/vibe_firmware/src" "$own/src" "$own/node" "$own/fuzz"; do includes+=("-I$folder"); done
  for folder in $(named "$first" includes); do includes+=("-I$own/$folder"); done
  # shellcheck disable=SC2086
  clang++ "${flags[@]}" "${includes[@]}" $package_flags -c "$1" -o "$1.o" >"$1.log" 2>&1
}

# links FILE PROGRAM
links() {
  local unit objects=() modules
  for unit in $(for source in $(sourcesOf "$1"); do echo "${unit_of[$source]}"; done | sort -u); do
    cat "$unit.log"
    objects+=("$unit.o")
  done
  modules=$(named "$1" packages)
  # shellcheck disable=SC2046,SC2086
  clang++ "${flags[@]}" "${objects[@]}" ${modules:+$(pkg-config --libs $modules)} -o "$2"
}

# corpusOf FILE: the folders of its examples
corpusOf() {
  local folder package=${1%/fuzz/*} name
  name=$(basename "$1" _fuzz.cpp)
  [ ! -d "${1%/*}/corpus/$name" ] || echo "${1%/*}/corpus/$name"
  for folder in $(named "$1" corpus); do realpath -e -- "$package/$folder"; done
}

# runs PROGRAM SECONDS [CORPUS...]: notes how it ends
runs() {
  local status=0 corpus=("$1.corpus" "${@:3}")
  mkdir -p "$1.corpus" "$1.findings"
  "$1" -max_total_time="$2" -max_len=4096 -timeout=10 -rss_limit_mb=2048 -print_final_stats=1 \
    -artifact_prefix="$1.findings/" "${corpus[@]}" >"$1.log" 2>&1 </dev/null || status=$?
  echo "$status" >"$1.status"
}

# foundNothing PROGRAM UNITS: it ended well after that many units; the input that breaks it is printed in hexadecimal
foundNothing() {
  grep -E 'ERROR|SUMMARY|runtime error|stat::number_of_executed_units' "$1.log" || true
  local finding units
  for finding in "$1.findings"/*; do [ ! -f "$finding" ] || od -An -tx1 "$finding"; done
  units=$(sed -nE 's/^stat::number_of_executed_units: *//p' "$1.log")
  [ "$(cat "$1.status")" -eq 0 ] && [ "${units:-0}" -ge "$2" ]
}

# shellcheck disable=SC2046
package_flags=$(pkg-config --cflags eigen3 $(for file in "${fuzz_files[@]}"; do named "$file" packages; done | sort -u))
makeUnits
for unit in "${unit_named[@]}"; do twoAtOnce compiles "$unit"; done
wait
for file in "${fuzz_files[@]}"; do
  name=$(basename "$file" .cpp)
  check "$name compiles" links "$file" "$scratch/$name"
done
for file in "${fuzz_files[@]}"; do
  name=$(basename "$file" .cpp)
  # shellcheck disable=SC2046
  [ ! -x "$scratch/$name" ] || twoAtOnce runs "$scratch/$name" "$seconds" $(corpusOf "$file")
done
wait
for file in "${fuzz_files[@]}"; do
  name=$(basename "$file" .cpp)
  units=$(named "$file" units)
  [ ! -x "$scratch/$name" ] || check "$name finds nothing in $seconds s" foundNothing "$scratch/$name" "${units:-1000}"
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
  runs "$scratch/planted" 20
  ! foundNothing "$scratch/planted" 1000 && grep -q 'heap-buffer-overflow' "$scratch/planted.log"
}
check 'control: a planted error is found' findsThePlantedError
