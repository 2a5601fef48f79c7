# What scripts/package tells Debian's tools: every ROS package is in a Debian package, with Debian packages for what it
# needs. That they build and run is tried by scripts/platform before a release (docs/install.md).
# kind: computing
# cost: 10
# packages: packaging vibe_bringup vibe_python vibe_web
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

command -v dh_listpackages >/dev/null || skip 'package (no debhelper; scripts/setup installs it)'

# describe SYSTEM [WORKSPACE]
describe() {
  rm -rf -- "$scratch/debian"
  /usr/bin/python3 -B "$root/scripts/lib/debian_control.py" "${2:-$root}" "$1" 0.1.0~test 1000000000 'Nobody <nobody@example.org>' \
    "$scratch/debian" g++ && (cd "$scratch" && dh_listpackages) | sort >"$scratch/packages"
}

# Debian's own tools read what was written: names of packages, version.
containsAll() {
  local folder
  describe bookworm || return 1
  for folder in "$root"/src/*/; do
    folder=$(basename "$folder")
    case $folder in
      vibe_system_tests|vibe_vision_evidence) ;; # of the workspace
      vibe_cmake|vibe_testing) grep -qxF "$folder vibe-dev" "$scratch/debian/ros_packages" ;;
      *) grep -qxF "${folder//_/-}" "$scratch/packages" ;;
    esac || { echo "$folder is in no package"; return 1; }
  done
  grep -qx vibe-dev "$scratch/packages" && [ "$(cd "$scratch" && dpkg-parsechangelog -S Version)" = 0.1.0~test ]
}
check 'every ROS package is in a Debian package' containsAll

hasOneMaintainer() { [ "$(cat "$root"/src/*/package.xml | grep '<maintainer ' | sort -u | tee /dev/stderr | wc -l)" -eq 1 ]; }
check 'all package.xml name the same maintainer' hasOneMaintainer

needsNoCompiler() {
  sed '/^Package: vibe-dev$/,$d; /^Build-Depends:/,/^[A-Z]/d' "$scratch/debian/control" >"$scratch/runtime"
  grep -q '^ vibe-core (= ' "$scratch/runtime" && ! grep -E '^ [^ ]+-dev[, ]*$|^ g\+\+' "$scratch/runtime"
}
check 'what runs needs no development files' needsNoCompiler
