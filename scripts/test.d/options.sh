# What every script promises: help, one clear line on a wrong call, and that it runs from any folder.
# kind: computing
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

helps() {
  local said
  said=$(cd / && "$1" --help) && grep -q '^Usage: ' <<<"$said"
}

for script in "$root"/scripts/*; do
  [ -f "$script" ] && [ -x "$script" ] || continue
  name=${script##*/}
  check "$name --help" helps "$script"
  check "$name refuses an unknown option" refuses 2 "unknown option '--no-such-option'" "$script" --no-such-option
  ln -s "$script" "$scratch/linked-$name"
  check "$name works through a link" helps "$scratch/linked-$name"
done
