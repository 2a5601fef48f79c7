# Runs in the virtual machine, in the host's files. The variables come from scripts/lib/hid_kernel.py:
# VIBE_DEVEL, the devel folder, and VIBE_GUEST_ARGUMENTS for the test program.
set -a
PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin
HOME=/run/vibe_guest ROS_HOME=/run/vibe_guest ROS_LOG_DIR=/run/vibe_guest
ROS_HOSTNAME=localhost ROS_MASTER_URI=http://localhost:11311
source /run/vibe_guest/session.env
set +a
cd /run/vibe_guest || exit 1

# the tests of the node come last; until then the master has started
/usr/bin/rosmaster --core -p 11311 >rosmaster.log 2>&1 &

dmesg --console-off 2>/dev/null
# shellcheck disable=SC2086
"$VIBE_DEVEL/lib/vibe_hardware/hid_guest" --gtest_color=no $VIBE_GUEST_ARGUMENTS
