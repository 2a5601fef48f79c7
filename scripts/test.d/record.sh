# scripts/record without a master; what else it and others refuse is tested in src/vibe_bringup/test.
# kind: computing
# packages: vibe_bringup
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

export ROS_MASTER_URI=http://localhost:1
check 'record says that no master answers' refuses 1 'no ROS master answers at http://localhost:1' \
  "$root/scripts/record" --output "$scratch/new.bag"
