# The tables of docs/accuracy.md and README: each is what docs/measured holds, and the quick results repeat.
# kind: computing
# cost: 20
# packages: docs vibe_benchmarks vibe_sessions
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

devel=$root/devel${VIBE_VARIANT:-}

# accuracy TREE OPTION...: scripts/lib/accuracy.py with the pages and results of a tree
accuracy() {
  ROS_PACKAGE_PATH=$root/src LD_LIBRARY_PATH=$devel/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH} \
    /usr/bin/python3 -B "$root/scripts/lib/accuracy.py" --root "$1" --devel "$devel" "${@:2}"
}

# copyOfPages: prints a folder with what accuracy.py reads
copyOfPages() {
  local tree
  tree=$(mktemp -d "$scratch/tree XXXXXX")
  mkdir -p "$tree/docs/tutorials" "$tree"/src/vibe_core/scenes
  cp "$root/README.md" "$tree/"
  cp -r "$root"/docs/{*.md,measured} "$tree/docs/"
  cp "$root"/docs/tutorials/*.md "$tree/docs/tutorials/"
  ln -s "$root/src/vibe_benchmarks" "$tree/src/"
  ln -s "$root/src/vibe_core/scenes/stomach.yaml" "$tree/src/vibe_core/scenes/"
  echo "$tree"
}

# finds PATTERN FILE EXPRESSION OPTION...: with this sed expression applied to a file, the check fails and says so
finds() {
  local tree said
  tree=$(copyOfPages)
  accuracy "$tree" "${@:4}" || { echo 'finds a problem where none is'; return 1; }
  sed -i -E "$3" "$tree/$2"
  ! said=$(accuracy "$tree" "${@:4}" 2>&1) || { echo 'finds nothing'; return 1; }
  grep -E -- "$1" <<<"$said" || { printf '%s\n' "$said"; return 1; }
}

check 'tables of the pages are what was measured' accuracy "$root" --check-pages
check 'a figure that was typed over is found' finds "accuracy.md: the table 'fem'" docs/accuracy.md \
  '/case6_bite/s/[0-9.]+ %/0.1 %/' --check-pages
check 'a result without its page is found' finds "accuracy.md: the table 'fem'" docs/measured/fem.csv \
  '/^case6_bite,/s/0\.0[0-9]+/0.001/' --check-pages
check 'what the guard no longer vouches for is marked as older' finds "accuracy.md: the table '" \
  docs/measured/guard.csv '/^free,/s/0\.0/0.1/' --check-pages
check 'a table that nobody makes is found' finds "below 'Steps in contact' that no script makes" docs/accuracy.md \
  's/^### Steps in contact$/&\n\n| state | error |\n|---|---|\n| free | 0.1 % |/' --check-pages
check 'a table that is left out is found' finds "the table 'states' stands in no page" docs/accuracy.md \
  's/^<!-- measured: states -->$//' --check-pages

isOrdinary vibe_benchmarks/vibe_bench ||
  skip 'the quick measurements (scripts/build builds vibe_benchmarks; slow in other builds)'
check 'quick results repeat' accuracy "$root" --check
check 'a result that its code no longer gives is found' finds 'fem case6_bite shell force: reference_error is' \
  docs/measured/fem.csv '/^case6_bite,shell,force/s/0\.0[0-9]+/0.001/' --check --section fem/case6_bite
