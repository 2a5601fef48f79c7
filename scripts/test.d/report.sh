# scripts/report refuses what it cannot do; the rest is tested in src/vibe_sessions/test.
# kind: computing
# packages: vibe_bringup vibe_sessions
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

check 'report asks for a recording' refuses 2 'which recording' "$root/scripts/report"
check 'report refuses no workers' refuses 2 "not '0'" "$root/scripts/report" --jobs 0 session.bag
check 'report needs a value' refuses 2 '--output needs a value' "$root/scripts/report" session.bag --output
