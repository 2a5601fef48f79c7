#!/usr/bin/env bash
# Experts and novices make a mark: cohort.sh FOLDER [TRAINEES OF EACH SKILL]
set -euo pipefail
here=$(dirname -- "$(readlink -f -- "$0")")
rosrun vibe_sessions cohort --output "$1" --script "$here/mark.yaml" --novice 0 1 --count "${2:-2}"
cut -d, -f 1-4 "$1/cohort.csv" # scene, surface, skill (0: expert, 1: novice), seed; then the measures
"$here/plot_cohort.py" "$1/cohort.csv" path_length time "$1/cohort.png"
