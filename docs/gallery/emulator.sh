#!/usr/bin/env bash
# Both USB devices without hardware: their firmware runs in vibe_emulator, and a script moves them. emulator.sh SECONDS
set -euo pipefail
folder=$(mktemp -d)
trap 'kill $(jobs -p) 2>/dev/null; wait; rm -rf "$folder"' EXIT
rosrun vibe_hardware vibe_emulator --folder "$folder" --hand script package://vibe_core/trainees/demo/grabs.yaml &
rosrun vibe_hardware hardware_node _bus:="$folder" &
timeout "$1" rostopic echo -p haptic/measured_js || true # joints of the haptic device and the torques of its motors
