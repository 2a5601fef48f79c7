# A scene that names a way of the prototype: refused with the remedy by a program that has not loaded it, run by one that
# has, and the same bits as those of the same scene without that way as long as the way is not used.
# kind: computing
# cost: 5
# packages: vibe_prototype
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

devel=$root/devel${VIBE_VARIANT:-}
headless=$devel/lib/vibe_core/vibe_headless
[ -x "$headless" ] && [ -f "$devel/lib/libvibe_prototype.so" ] || skip 'the prototype (not built; scripts/build builds it)'
export ROS_PACKAGE_PATH=$root/src

# scene NAME CINCH DEFORMATION
scene() {
  printf '%s\n' 'base: package://vibe_core/scenes/stomach.yaml' "suture: {cinch_model: $2}" "marking: {deformation: $3}" \
    >"$scratch/$1.yaml"
}
scene groups groups solver
scene gradient thread gradient
scene neither thread solver

runs() { "$headless" --quiet --duration 0.1 --scene "$scratch/$1.yaml"; }

needed="is in the package vibe_prototype, which this program has not loaded; .*VIBE_PLUGINS=libvibe_prototype.so"
check 'groups without the package' refuses 2 "groups.yaml:2: suture.cinch_model: 'groups' $needed" runs groups
check 'gradient without the package' refuses 2 "gradient.yaml:3: marking.deformation: 'gradient' $needed" runs gradient
runs neither >"$scratch/expected"
export VIBE_PLUGINS=libvibe_prototype.so
check 'groups with the package' runs groups
check 'gradient with the package' runs gradient
sameBits() { [ "$(runs "$1")" = "$(<"$scratch/expected")" ] && grep -q '^state hash: ' "$scratch/expected"; }
check 'loading it changes no bit of another scene' sameBits neither
check 'and none of a scene of its own before the way is used' sameBits groups
VIBE_PLUGINS=libvibe_none.so
check 'a library that is not there' refuses 2 "VIBE_PLUGINS names 'libvibe_none.so', which cannot be loaded" runs neither
