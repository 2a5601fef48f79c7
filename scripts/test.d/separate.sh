# Every source includes what it uses: each is compiled by itself, not with the others of its folder. Minutes long.
# kind: computing
# units: 4
# timeout: 7200
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

onDemand 'sources one by one'
check 'every source compiles by itself' "$root/scripts/build" --separate --tests
