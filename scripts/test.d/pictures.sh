# What rviz shows in five states of the procedure, against the pictures of the documentation; no display has an error.
# kind: computing
# cost: 90
# packages: docs vibe_bringup vibe_system_tests
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

references=$root/docs/pictures
region=860x610+20+70 # where rviz draws: figures in panels and the frame rate change all the time
states=(rest marked grabbed sutured cinched)
compare() { systemTest compare_pictures --region "$region" "$@"; }
fails() {
  local status=0
  "$@" || status=$?
  [ "$status" -eq 1 ] || { echo "status $status, not 1"; return 1; }
}

# --- the measure itself: what must not count, and what must
similarPicturesPass() {
  convert "$references/rest.png" -blur 0x0.6 -attenuate 0.05 +noise Gaussian "$scratch/noisy.png"
  compare "$references/rest.png" "$references/rest.png" && compare "$references/rest.png" "$scratch/noisy.png"
}
coloursSwappedFail() {
  convert "$references/rest.png" -color-matrix '0 0 1 0 1 0 1 0 0' "$scratch/swapped.png"
  fails compare "$references/rest.png" "$scratch/swapped.png"
}
shiftedFails() {
  convert "$references/rest.png" -roll +8+0 "$scratch/shifted.png"
  fails compare "$references/rest.png" "$scratch/shifted.png"
}
otherStatesFail() {
  local a b
  for a in "${states[@]}"; do
    for b in "${states[@]}"; do
      [ "$a" = "$b" ] || fails compare "$references/$a.png" "$references/$b.png" || { echo "$a and $b"; return 1; }
    done
  done
}
otherSizeIsRefused() {
  convert "$references/rest.png" -crop 1000x500+0+0 +repage "$scratch/small.png"
  refuses 2 'smaller than the region' compare "$references/rest.png" "$scratch/small.png"
}

if ! command -v convert >/dev/null || ! /usr/bin/python3 -c 'import PIL, scipy' 2>/dev/null; then
  echo 'not ok pictures need imagemagick, python3-pil and python3-scipy; scripts/setup installs them'
  exit 0
fi
check 'pictures: noise and a little blur do not count' similarPicturesPass
check 'pictures: swapped colours do' coloursSwappedFail
check 'pictures: eight pixels aside do' shiftedFails
check 'pictures: every state differs from every other' otherStatesFail
check 'pictures: another size is refused' otherSizeIsRefused

program=$root/devel/lib/vibe_rviz_plugins/rviz_report
ordinaryBuild 'what rviz draws' lib/vibe_rviz_plugins/rviz_report

# --- what rviz draws now
mkdir "$scratch/now"
takesPictures() { "$root/scripts/picture" --program "$program $scratch/report.json" --output "$scratch/now"; }
looksLikeTheReference() { compare "$references/$1.png" "$scratch/now/$1.png"; }
noDisplayHasAnError() {
  /usr/bin/python3 - "$scratch/report.json" <<'PYTHON'
import json, sys
statuses = json.load(open(sys.argv[1]))["statuses"]
bad = [status for status in statuses if status["level"] != "Ok"]
for status in bad:
    print("{of}, {what}: {level}, {text}".format(**status))
shown = {status["of"] for status in statuses}
missing = {"Stomach", "Sutures", "Endoscope"} - shown
assert not missing, "nothing is told of {}".format(missing)
sys.exit(1 if bad else 0)
PYTHON
}
everyPropertyHasHelp() {
  /usr/bin/python3 - "$scratch/report.json" "$1" <<'PYTHON'
import json, sys
told = json.load(open(sys.argv[1]))["help"]
print("{properties} properties, without help: {without_help}".format(**told))
sys.exit(1 if told["without_help"] or told["properties"] < int(sys.argv[2]) else 0)
PYTHON
}
check 'rviz draws the five states' takesPictures
for state in "${states[@]}"; do check "rviz: $state looks as in the documentation" looksLikeTheReference "$state"; done
check 'rviz: no display has an error or a warning' noDisplayHasAnError
check 'rviz: every property has a help sentence' everyPropertyHasHelp 30

# no surface, and a display that has nothing to show: both must be seen
withoutTheSurface() {
  /usr/bin/python3 - "$root/src/vibe_description/rviz/vibe.rviz" "$scratch/without.rviz" <<'PYTHON'
import sys, yaml
config = yaml.safe_load(open(sys.argv[1]))
for display in config["Visualization Manager"]["Displays"]:
    if display["Name"] == "Stomach":
        display["Surface"]["Value"] = False
    if display["Name"] == "Sutures":
        display["Topic"] = "/nobody/says/anything"
yaml.safe_dump(config, open(sys.argv[2], "w"))
PYTHON
  "$root/scripts/picture" --program "$program $scratch/report.json" --config "$scratch/without.rviz" \
    --colours 500 --output "$scratch" without=10 && fails compare "$references/rest.png" "$scratch/without.png"
}
check 'rviz: a surface that is not drawn is seen to be missing' withoutTheSurface
check 'rviz: a display without messages is seen' fails noDisplayHasAnError
