# Half an hour of a session, played through rviz: its memory does not grow. Minutes long: it is played ten times as fast.
# kind: computing
# timeout: 3600
# packages: vibe_bringup vibe_system_tests
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

program=$root/devel/lib/vibe_rviz_plugins/rviz_report
onDemand 'half an hour of rviz'
ordinaryBuild 'half an hour of rviz' lib/vibe_rviz_plugins/rviz_report

record() {
  "$root/scripts/run" --headless --fast --record-all --script "$root/src/vibe_core/trainees/demo/five_states.yaml" --output "$scratch/session"
}
soak() {
  builtSystemTest soak_rviz --program "$program" --bag "$scratch/session/session.bag" \
    --config "$root/src/vibe_description/rviz/vibe.rviz" --minutes 30 --rate 10
}
check 'a session is recorded' record
check 'rviz shows it for half an hour, and its memory does not grow' soak
