# Half an hour of a session, played through rviz: its memory does not grow. Minutes long: it is played ten times as fast.
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

program=$root/devel/lib/vibe_rviz_plugins/rviz_report
if [ -z "${VIBE_SLOW_TESTS:-}" ] || [ -n "${VIBE_VARIANT:-}" ] || [ ! -x "$program" ]; then
  echo 'skipped half an hour of rviz (scripts/test --slow makes it)'
  exit 0
fi

record() {
  "$root/scripts/run" --headless --fast --script "$root/src/vibe_sim/trainees/demo/five_states.yaml" --output "$scratch/session"
}
soak() {
  (set +u && source "$root/devel/setup.bash" && /usr/bin/python3 "$root/scripts/lib/soak_rviz.py" --program "$program" \
    --bag "$scratch/session/session.bag" --config "$root/src/vibe_description/rviz/vibe.rviz" \
    --urdf "$root/src/vibe_description/urdf/scope.urdf" --minutes 30 --rate 10 "$@")
}
check 'a session is recorded' record
check 'rviz shows it for half an hour, and its memory does not grow' soak
