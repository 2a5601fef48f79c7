# Debian's kernel in a virtual machine: enumeration, hidraw, gamepad, parameters, unplugging, the node with real hidraw.
# kind: computing
# units: 5
# cost: 120
# alone-with: build-firmware
# packages: vibe_system_tests
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

check 'hid_kernel refuses a timeout in words' refuses 2 "not 'soon'" "$root/scripts/hid_kernel" --timeout soon

isOrdinary || skip 'the kernel in a virtual machine (with sanitizers the emulated programs would take many minutes)'

"$root/scripts/hid_kernel" --devel "$root/devel" --log "$scratch/log" 2>"$scratch/errors" | tee "$scratch/said"
status=${PIPESTATUS[0]}
cat "$scratch/errors"
if [ "$status" -eq 77 ]; then
  echo "skipped the kernel in a virtual machine ($(tail -n 1 "$scratch/errors"))"
elif [ "$status" -ne 0 ]; then
  grep -q '^not ok ' "$scratch/said" || echo "not ok the kernel in a virtual machine (status $status)"
  tail -n 60 "$scratch/log" 2>/dev/null | sed 's/^/    /'
fi
