# vibe_msgs and the MCAP export before ROS 2's own tools, as far as Debian has them: colcon builds the package with rosidl's
# generators and introspection, and Fast CDR reads and writes a file's bytes. The definitions are parsed in export_ros2_test, too.
# kind: computing
# units: 4
# cost: 240
# packages: vibe_msgs vibe_sessions
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

isSlowRun || skip 'the tools of ROS 2 (scripts/test --slow lets them build vibe_msgs)'
readonly names='python3-colcon-ros python3-colcon-recursive-crawl ament-cmake rosidl-cmake rosidl-tools rosidl-generator-c-cpp
  librosidl-typesupport-introspection-c-cpp-dev libfastcdr-dev'
for name in $names; do
  dpkg-query --show --showformat '${db:Status-Status}' "$name" 2>/dev/null | grep -qx installed ||
    skip "the tools of ROS 2 ($name is not installed)"
done

judge() { (set +u && source "$root/devel/setup.bash" && cd "$root/src/vibe_sessions/test" && exec /usr/bin/python3 -B ros2_judge.py "$scratch"); }
check 'colcon builds vibe_msgs for ROS 2, whose Fast CDR finds every field of every message' judge
