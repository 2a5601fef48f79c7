#!/usr/bin/env bash
# Renders a camera's view of two instruments in motion, tracks them, and compares with the truth: camera.sh FOLDER
set -euo pipefail
rosrun vibe_vision vibe_render --scene moving --frames 60 --out "$1"
rosrun vibe_vision vibe_track --images "$1/*.png" --config "$1/config.yaml" --csv "$1/result.csv"
"$(dirname -- "$(readlink -f -- "$0")")/compare_tracks.py" "$1"
