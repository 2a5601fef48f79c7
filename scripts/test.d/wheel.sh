# The wheel for any Linux: scripts/package makes it, and every CPython from 3.9 to 3.14 that is found here installs it and
# performs the first session, with the hash of README.md.
# kind: computing
# timeout: 5400
# packages: vibe_core vibe_python
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

isSlowRun && command -v debootstrap >/dev/null ||
  skip 'the wheel (scripts/test --slow makes it, where debootstrap is installed)'

program='import vibe
model = vibe.load()
simulation = vibe.Simulation(model)
simulation.follow(vibe.Trainee(model, "package://vibe_core/trainees/first.yaml"))
print(f"state hash: {simulation.hash():016x}")'

# Prefixes of the Pythons that have headers, beside those of which Debian has them.
prefixes() {
  local number python
  for number in 10 12; do
    for python in "${PYENV_ROOT:-$HOME/.pyenv}/versions/3.$number".*; do
      [ ! -f "$python/include/python3.$number/Python.h" ] || printf '%s\n' --python "$python"
    done
  done
}

packs() {
  local options
  mapfile -t options < <(prefixes)
  "$root/scripts/package" --wheel "${options[@]}" --output "$scratch/wheel" &&
    [ "$(stat -c %s "$scratch"/wheel/*.whl)" -lt 60000000 ]
}
check 'a wheel of at most 60 MB' packs
wheel=$(echo "$scratch"/wheel/*.whl)

# installs PYTHON: in an environment of its own, without ROS on any path
installs() {
  local place=$scratch/${1//\//_} expected
  expected=$(grep -m 1 '^state hash: ' "$root/README.md")
  env -i PATH=/usr/bin:/bin HOME="$scratch" "$1" -m venv "$place" && "$place/bin/pip" install -q "$wheel" &&
    [ "$(cd / && env -i HOME="$scratch" "$place/bin/python" -c "$program")" = "$expected" ]
}

for number in 9 10 11 12 13 14; do
  for python in /usr/bin/python3.$number "${PYENV_ROOT:-$HOME/.pyenv}/versions/3.$number".*/bin/python3.$number; do
    [[ ! -x $python || ! $wheel = *cp3$number* ]] || check "$python installs it and has the hash of README.md" installs "$python"
  done
done
