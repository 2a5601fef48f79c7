# What the endoscope's picture shows in nine views of scripts/views: properties with their controls. It runs the
# sessions, because pictures of the documentation would not notice a change. Of the two views that the camera follows,
# smoke is taken, too; scar, five minutes later, is for the pages.
# kind: computing
# cost: 100
# packages: vibe_bringup vibe_system_tests
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

ordinaryBuild 'what the endoscope shows' lib/vibe_endoscope/endoscope_camera
if ! /usr/bin/python3 -c 'import numpy, PIL, scipy' 2>/dev/null; then
  echo 'not ok views need python3-numpy, python3-pil and python3-scipy; scripts/setup installs them'
  exit 0
fi

takesTheViews() {
  "$root/scripts/views" --size 320x240 --truth --output "$scratch" \
    rest 5mmhg 10mmhg antrum retroflexed touched marked sutured bleeding smoke
}
check 'views: the pictures are taken, with their truth' takesTheViews
systemTest check_views "$scratch" || echo 'not ok views: not everything could be measured'
