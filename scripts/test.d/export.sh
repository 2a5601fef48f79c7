# What scripts/export writes, as the readers of others see it: rosbags, mcap, pyarrow, av, usd-core and pyassimp of PyPI (with
# the libassimp that rviz needs), in an environment below build/. The rest is tested in src/vibe_sessions/test.
# kind: computing
# packages: vibe_bringup vibe_msgs vibe_sessions vibe_sim vibe_python
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

names=$root/src/vibe_sessions/test/readers.txt environment=$root/build/readers
pythonEnvironment readers "$names" >"$scratch/pip.txt" 2>&1 ||
  skip "the readers of others (pip could not install what $(basename "$names") names: $(tail -n 1 "$scratch/pip.txt"))"

readers() { (set +u && source "$root/devel/setup.bash" && cd "$root/src/vibe_sessions/test" && exec "$environment/bin/python" -B export_readers.py "$1"); }
for part in McapReaders FoxgloveLayout Ros2Package ParquetReader UsdReader GltfReader LerobotReader; do
  check "readers of others: $part" readers "$part"
done

# Rerun's numpy is newer than that of Debian
if ! isSlowRun; then
  echo 'skipped Rerun (scripts/test --slow installs it, 800 MB)'
elif SITE_PACKAGES='' pythonEnvironment rerun "${names%/*}/rerun.txt" >"$scratch/rerun.txt" 2>&1; then
  VIBE_RERUN=$root/build/rerun/bin/python check 'readers of others: RerunView' readers RerunView
else
  echo "skipped Rerun (pip could not install what rerun.txt names: $(tail -n 1 "$scratch/rerun.txt"))"
fi
