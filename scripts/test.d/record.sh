# scripts/record and scripts/replay refuse what they cannot do.
# kind: computing
# packages: vibe_bringup
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

export ROS_MASTER_URI=http://localhost:1
check 'record says that no master answers' refuses 1 'no ROS master answers at http://localhost:1' \
  "$root/scripts/record" --output "$scratch/new.bag"
touch "$scratch/old.bag"
check 'record does not overwrite' refuses 2 'is there already' "$root/scripts/record" --output "$scratch/old.bag"
check 'record refuses half a second' refuses 2 "not '0.5'" "$root/scripts/record" --duration 0.5
check 'replay asks for a recording' refuses 2 'which recording' "$root/scripts/replay"
check 'replay names a recording that is not there' refuses 2 "no file 'nowhere.bag'" "$root/scripts/replay" nowhere.bag
