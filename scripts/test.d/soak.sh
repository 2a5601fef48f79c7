# Half an hour of a session, played through rviz: its memory does not grow. Minutes long: it is played ten times as fast.
# kind: computing
# timeout: 3600
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

# A megabyte a minute is growth, noise of ten megabytes around one value is none.
growthIsSeen() {
  PYTHONPATH=$root/scripts/lib:$root/src/vibe_bringup/src PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 - <<'PYTHON'
from soak_rviz import HALF_HOUR, slope
leak = [(time, 300 + time / 60) for time in range(0, 1800, 20)]
noise = [(time, 300 + 10 * (k % 2)) for k, time in enumerate(range(0, 1800, 20))]
assert abs(HALF_HOUR * slope(leak) - 30) < 1e-6
assert abs(HALF_HOUR * slope(noise)) < 1
PYTHON
}
check 'soak: growth is told from noise' growthIsSeen

program=$root/devel/lib/vibe_rviz_plugins/rviz_report
if [ -z "${VIBE_SLOW_TESTS:-}" ] || [ -n "${VIBE_VARIANT:-}" ] || [ ! -x "$program" ]; then
  echo 'skipped half an hour of rviz (scripts/test --slow makes it)'
  exit 0
fi

record() {
  "$root/scripts/run" --headless --fast --record-all --script "$root/src/vibe_core/trainees/demo/five_states.yaml" --output "$scratch/session"
}
soak() {
  (set +u && source "$root/devel/setup.bash" && /usr/bin/python3 "$root/scripts/lib/soak_rviz.py" --program "$program" \
    --bag "$scratch/session/session.bag" --config "$root/src/vibe_description/rviz/vibe.rviz" \
    --minutes 30 --rate 10 "$@")
}
check 'a session is recorded' record
check 'rviz shows it for half an hour, and its memory does not grow' soak
