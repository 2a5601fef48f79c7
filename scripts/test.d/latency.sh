# scripts/latency follows a jump of the hand through all stages, up to the pixel.
# kind: waiting
# units: 4
# cost: 120
# alone-with: fake-camera
# packages: vibe_bringup vibe_latency
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"
export PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin # python3 of Debian, which has numpy

latency=$root/scripts/latency
isOrdinary || skip 'measurements (scripts/latency uses the ordinary build, not this one)'

# measure NAME OPTION...: a few blinks into $scratch/NAME.
measure() {
  local name=$1
  shift
  "$latency" --blinks 12 --scene "$root/src/vibe_sessions/regressions/scenes/coarse_stomach.yaml" \
    --output "$scratch/$name" "$@"
}

# sees NAME STAGE COUNT: so many blinks at least passed a stage, in a time between 0 and 2 s; 0: none did.
sees() {
  python3 - "$scratch/$1/latency.json" "$2" "$3" <<'PY'
import json, sys
with open(sys.argv[1]) as file:
    numbers = json.load(file)["stages"][sys.argv[2]]
print(numbers)
wanted = int(sys.argv[3])
right = numbers["count"] >= wanted and 0 < numbers["p50"] < 2 if wanted else numbers["count"] == 0
sys.exit(0 if right else "not what was expected")
PY
}

check 'latency follows the device to the pixel' measure device
check 'latency: from the device to the state' sees device 'event to published state' 7
check 'latency: from the device to the pixel' sees device 'event to pixel' 4
check 'latency draws a figure' test -s "$scratch/device/latency.png"
check 'latency follows the camera to the state' measure camera --camera --headless --free --rate 60
check 'latency: from the exposure to the state' sees camera 'sample to published state' 7
check 'latency without rviz sees no pixel' sees camera 'event to pixel' 0

# says NAME CONDITION: what latency.json of $scratch/NAME says, as n.
says() {
  python3 -c 'import json, sys; n = json.load(open(sys.argv[1])); print(n); sys.exit(not eval(sys.argv[2]))' \
    "$scratch/$1/latency.json" "$2"
}

check 'latency counts deadlines' measure steps --steps --minutes 0.1 --rate 60
check 'latency: the steps of six seconds' says steps '330 <= n["steps"]["count"] <= 400 and n["steps"]["step"]["p50"] > 0'
check 'latency draws the deadlines' test -s "$scratch/steps/latency.png"
check 'latency tells the age of positions' measure now --sway --minutes 0.1
check 'latency: positions are old without prediction' says now '0.002 < n["motion"]["age"] < 0.1'
check 'latency tells the age of predicted positions' measure ahead --sway --minutes 0.1 --lead 40
# without predicted positions the joint would stay at 0, 10 mm from the middle of the motion
check 'latency: the simulator follows the prediction' says ahead \
  'n["motion"]["count"] > 300 and n["motion"]["error at once"] < 0.004 and n["motion"]["age"] < 0.05'
