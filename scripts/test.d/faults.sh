# What is around the nodes breaks: programs, master, peers, devices, clocks. Figures: the table that is printed.
# kind: waiting
# units: 4
# cost: 200
# timeout: 2400
# alone-with: fake-camera
# packages: vibe_system_tests
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

isOrdinary vibe_sim/sim_node vibe_hardware/hardware_node vibe_vision/vision_node || skip 'faults (they need the ordinary build)'
unset DISPLAY

faults() { builtSystemTest faults "$@"; }

# isOk GROUP NAME: the report says so; else the reason, and what was printed meanwhile.
isOk() {
  grep -qxF "ok	$2" "$scratch/report" && return
  grep -F "not ok	$2	" "$scratch/report" || { echo 'it was not reached'; tail -n 20 "$scratch/$1.txt"; }
  sed -n "/^--- $2\$/,/^--- /p" "$scratch/$1.txt"
  return 1
}

names=$(faults --list)
for group in nodes master traffic fast peers; do
  faults --group "$group" --report "$scratch/report" --table "$scratch/table" >"$scratch/$group.txt" 2>&1 || true
  while IFS='	' read -r of name; do
    if [ "$of" = "$group" ]; then check "$name" isOk "$group" "$name"; fi
  done <<<"$names"
done

echo '    | fault | lost | recovery | what the user sees |'
if [ -s "$scratch/table" ]; then sed 's/^/    /' "$scratch/table"; fi
