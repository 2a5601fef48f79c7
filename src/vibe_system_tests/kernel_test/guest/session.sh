# Runs in the virtual machine, in the host's files. The variables come from vibe_system_tests/hid_kernel.py:
# VIBE_DEVEL, the devel folder; VIBE_PACKAGES, the folder of the packages; VIBE_FILTER, which tests to run (gtest);
# VIBE_IMAGE, not empty if the firmware image runs.
set -a
PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin
HOME=/run/vibe_guest ROS_HOME=/run/vibe_guest ROS_LOG_DIR=/run/vibe_guest
ROS_HOSTNAME=localhost ROS_MASTER_URI=http://localhost:11311
source /run/vibe_guest/session.env
ROS_PACKAGE_PATH=$VIBE_PACKAGES:/usr/share
set +a
cd /run/vibe_guest || exit 1

# the usual configuration loads rospy and numpy: half a minute in an emulated processor
cat >logging.conf <<'END'
[loggers]
keys=root
[handlers]
keys=errors
[formatters]
keys=
[logger_root]
level=WARNING
handlers=errors
[handler_errors]
class=StreamHandler
args=(sys.stderr,)
END
export ROS_PYTHON_LOG_CONFIG_FILE=$PWD/logging.conf

# the tests of the nodes come last; until then the master has started
/usr/bin/rosmaster --core -p 11311 >rosmaster.log 2>&1 &

tests=$VIBE_DEVEL/lib/vibe_system_tests/hid_guest
"${tests}_replug" --gtest_color=no --gtest_filter="$VIBE_FILTER" >replug.log 2>&1 &
replug=$!
"$tests" --gtest_color=no --gtest_filter="$VIBE_FILTER"
wait $replug
cat replug.log
