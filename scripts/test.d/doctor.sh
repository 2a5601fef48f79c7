# scripts/doctor tells troubles apart, each with its remedy.
# kind: computing
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

unset DISPLAY ROS_HOME ROS_LOG_DIR
export ROS_MASTER_URI=http://localhost:1
cd "$scratch" || exit 1

# asks FILE...: one text, and the status that says that there is trouble
asks() { gives 1 said.txt "$root/scripts/doctor" "$@"; }

# finds PATTERN: among the troubles that were listed last
finds() { grep -E -- "^[0-9]+\. .*$1" said.txt || { cat said.txt; return 1; }; }
isQuietAbout() { ! finds "$1"; }

printf 'version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 5\n' >pointer.stl
printf '\n<!DOCTYPE html><html></html>\n' >page.glb
printf 'name: x\ngas:\302\240{}\n' >blank.yaml
printf 'name: x # \302\240 \303\244\ngas: {}\n' >good.yaml
printf 'scop\320\265: {}\n' >letter.yaml
printf 'A: 00 0 255 0 0 0\nA: 02 0 255 0 0 0\nE: 0.0 0003 0000 7\n' >pad.evemu
: >empty.obj
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >open.obj
/usr/bin/python3 - <<'PYTHON'
import rosbag
from std_msgs.msg import String
with rosbag.Bag("filtered.bag", "w") as bag:
    bag.write("/scene", String("name: x\n"))
PYTHON

check 'files are looked at' asks ./*.stl ./*.glb ./*.yaml ./*.evemu ./*.obj ./*.bag none.bag
check 'a pointer of Git LFS' finds 'pointer.stl is a pointer.*git lfs pull'
check 'a page in place of a file' finds 'page.glb is an HTML page'
check 'a blank that does not break' finds 'blank.yaml:2 contains NO-BREAK SPACE'
check 'a letter of another script' finds 'letter.yaml:1 contains CYRILLIC SMALL LETTER IE'
check 'comments are free' isQuietAbout 'good.yaml'
check 'an axis without a state' finds 'the axes 02 have no event'
check 'an empty file' finds 'empty.obj is empty'
check 'what the import says of a surface' finds 'open.obj is not closed: it has 1 hole'
check 'a file that is not there' finds 'none.bag cannot be read .No such file'
check 'topics that were left out' finds 'filtered.bag lacks applied_input, session_info, snapshot'
check 'nothing of the machine' isQuietAbout 'X server|ROS_HOME'
mkdir -p sessions/dead/log
printf 'ok\nrviz died with status -6\n' >sessions/dead/log/rviz.log
export QT_QPA_PLATFORM=wayland WAYLAND_DISPLAY=wayland-0
check 'a Wayland desktop is looked at' asks good.yaml
check 'an rviz that died' finds 'rviz died with status -6 in the session in sessions/dead'
check 'a platform of Qt in which rviz aborts' finds 'QT_QPA_PLATFORM makes rviz a Wayland client'
check 'a desktop without X' finds 'no X display, .* install xwayland'
unset QT_QPA_PLATFORM WAYLAND_DISPLAY
echo ok >sessions/dead/log/rviz.log
export DISPLAY=:987 ROS_HOME=$scratch/page.glb/none
check 'the machine is looked at' asks good.yaml
check 'an rviz that lives, with X' isQuietAbout 'rviz died|QT_QPA|xwayland'
check 'a display that does not answer' finds 'no X server answers at DISPLAY=:987'
check 'a folder that cannot be written to' finds 'ROS_HOME is .*/page.glb/none, which cannot'

# a master with a simulator and a client whose arm has another name
cat >master.py <<'PYTHON'
import xmlrpc.server
server = xmlrpc.server.SimpleXMLRPCServer(("localhost", 0), logRequests=False)
state = [[["/applied_input", ["/sim_node"]], ["/scope/measured_cp", ["/sim_node"]],
          ["/scope/measured_js", ["/sim_node", "/old"]], ["/scope/operating_state", ["/sim_node"]],
          ["/PSM1/servo_cp", ["/client"]], ["/scope/move_cp", ["/client"]]],
         [["/PSM1/measured_cp", ["/client"]], ["/scope/measured_js", ["/client"]],
          ["/suturing_device/input/joint_states", ["/sim_node"]], ["/scope/operating_state", ["/client"]],
          ["/scope/servo_cp", ["/sim_node"]], ["/scope/move_cp", ["/sim_node"]], ["/PSM1/goal", ["/client"]]], []]
server.register_function(lambda caller: [1, "", state], "getSystemState")
print(server.server_address[1], flush=True)
server.serve_forever()
PYTHON
unset ROS_HOME
coproc MASTER { exec /usr/bin/python3 master.py; }
master=$MASTER_PID
read -r port <&"${MASTER[0]}"
export ROS_MASTER_URI=http://localhost:$port
check 'a graph is looked at' asks good.yaml
kill "$master"
check 'a client that listens where nobody sends' finds '/client listens to /PSM1/measured_cp, which nobody publishes; there is /scope/measured_cp'
check 'the joints of the tool need no remapping' isQuietAbout 'listens to /scope/measured_js'
check 'a device of release 1.0.0' finds '/old publishes /scope/measured_js, .* let it publish /scope/input/joint_states'
check 'a command that nobody receives' finds '/client sends /PSM1/servo_cp, .* there is /scope/servo_cp'
check 'no other topic' isQuietAbout 'goal|operating_state|move_cp|suturing_device|/sim_node publishes'
