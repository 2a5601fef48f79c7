# scripts/doctor tells troubles apart, each with its remedy.
# kind: computing
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

unset DISPLAY ROS_HOME ROS_LOG_DIR
export ROS_MASTER_URI=http://localhost:1
cd "$scratch" || exit 1

# asks FILE...: one text, and the status that says that there is trouble
asks() {
  local status=0
  "$root/scripts/doctor" "$@" >said.txt 2>&1 || status=$?
  cat said.txt
  [ "$status" -eq 1 ]
}

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
check 'a file that is not there' finds 'none.bag cannot be read .No such file'
check 'topics that were left out' finds 'filtered.bag lacks applied_input, session_info, snapshot'
check 'nothing of the machine' isQuietAbout 'X server|ROS_HOME'
export DISPLAY=:987 ROS_HOME=$scratch/page.glb/none
check 'the machine is looked at' asks good.yaml
check 'a display that does not answer' finds 'no X server answers at DISPLAY=:987'
check 'a folder that cannot be written to' finds 'ROS_HOME is .*/page.glb/none, which cannot'
