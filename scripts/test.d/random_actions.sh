# Random actions in all environments and rough use of their simulations: 20 minutes, 5 under sanitizers.
# kind: computing
# timeout: 3600
# packages: vibe_python
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

variant=${VIBE_VARIANT:-}
setup=$root/devel$variant/setup.bash
[ -n "${VIBE_SLOW_TESTS:-}" ] && [ "$variant" != -threads ] && [ -e "$root/devel$variant/lib/python3/dist-packages/vibe" ] ||
  skip 'random actions in all environments (scripts/test --slow makes them, where the Python module is built)'

# Python is not built with the sanitizers, so their library has to come first. What Python and numpy keep until they end
# would be reported as lost, and freed memory is kept to be watched, so growth is not judged.
preload() {
  local compiler=${CXX:-c++}
  export LD_PRELOAD="$("$compiler" -print-file-name=libasan.so):$("$compiler" -print-file-name=libstdc++.so)"
  # it does not know the stack on which a trainee acts, and would report its own call there when an exception passes
  echo interceptor_name:sigaltstack >"$scratch/suppressions"
  export ASAN_OPTIONS=detect_leaks=0:suppressions="$scratch/suppressions" UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1
}

acts() {
  (
    set +u && source "$setup"
    [ "$variant" != -sanitize ] || preload
    exec /usr/bin/python3 -B "$root/src/vibe_python/scripts/random_actions.py" "$@"
  ) >"$scratch/said.txt" 2>&1 || { tail -n 40 "$scratch/said.txt"; return 1; }
}

if [ "$variant" = -sanitize ]; then
  check '5 minutes of random actions under sanitizers' acts --minutes 5 --particles 300 --growth -1
else
  check '20 minutes of random actions, and memory does not grow' acts --minutes 20
fi
tail -n 1 "$scratch/said.txt" | sed 's/^/    /'
