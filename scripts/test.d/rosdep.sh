# rosdep, which every ROS user tries first, knows a package of Debian 12 and 13 for every dependency.
# kind: computing
# cost: 10
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

command -v rosdep >/dev/null || skip 'rosdep (not installed; scripts/setup installs it)'
mkdir "$scratch/sources"
export ROSDEP_SOURCE_PATH=$scratch/sources ROS_HOME=$scratch ROSDISTRO_INDEX_URL=file://$scratch/index.yaml
printf '%%YAML 1.1\n---\ndistributions: {}\ntype: index\nversion: 4\n' >"$scratch/index.yaml"
debian=/usr/share/python3-rosdep2/debian.yaml

# knowsAll OWN: every key of the packages has packages of both systems, with the file of the workspace or without
knowsAll() {
  local system keys
  rm -f "$scratch/sources"/*
  [ "$1" = no ] || echo "yaml file://$root/scripts/rosdep.yaml" >"$scratch/sources/05-vibe.list"
  echo "yaml file://$debian debian" >"$scratch/sources/10-debian.list"
  echo "yaml file://$root/scripts/test.d/rosdep/base.yaml" >"$scratch/sources/20-default.list"
  rosdep update || return 1
  for system in debian:bookworm debian:trixie; do
    keys=$(rosdep keys --from-paths "$root/src" --ignore-src --os="$system") && [ -n "$keys" ] || return 1
    # shellcheck disable=SC2086
    rosdep resolve --os="$system" $keys || return 1
  done
}

check 'rosdep knows every dependency on Debian 12 and 13' knowsAll yes
check 'control: not without the file of the workspace' bash -c "
  $(declare -f knowsAll); root=$root scratch=$scratch debian=$debian; ! knowsAll no"
