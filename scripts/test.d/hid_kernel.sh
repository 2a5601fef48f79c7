# Debian's kernel in a virtual machine: enumeration, hidraw, gamepad, parameters, unplugging, the node with real hidraw.
# kind: computing
# units: 4
# cost: 120
# alone-with: build-firmware
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

check 'hid_kernel refuses a timeout in words' refuses 2 "not 'soon'" "$root/scripts/hid_kernel" --timeout soon

# The output of a guest becomes results: what failed, and what was never heard of, is not ok.
resultsAreRead() {
  PYTHONPATH=$root/scripts/lib PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 - <<'PYTHON'
import contextlib
import io
from hid_kernel import Report

said = io.StringIO()
with contextlib.redirect_stdout(said):
    report = Report(['A.good', 'A.bad', 'A.without', 'A.silent'])
    for line in ['[ RUN      ] A.good', '[       OK ] A.good (1 ms)', '[ RUN      ] A.bad', 'bad.cpp:1: Failure',
                 '[  FAILED  ] A.bad (2 ms)', '[ RUN      ] A.without', 'no board', '[  SKIPPED ] A.without (0 ms)',
                 'figure x: 1 ms', '[  FAILED  ] 1 test, listed below:', '[  FAILED  ] A.bad']:
        report.read(line)
    assert not report.end()
lines = said.getvalue().splitlines()
assert [line for line in lines if not line.startswith(' ')] == [
    'ok A.good', 'not ok A.bad', 'skipped A.without', 'figure x: 1 ms', 'not ok A.silent'], lines
assert '    bad.cpp:1: Failure' in lines, lines
PYTHON
}
check 'hid_kernel: a test that fails or is never heard of is not ok' resultsAreRead

if [ -n "${VIBE_VARIANT:-}" ]; then
  echo 'skipped the kernel in a virtual machine (with sanitizers the emulated programs would take many minutes)'
  exit 0
fi

"$root/scripts/hid_kernel" --devel "$root/devel" --log "$scratch/log" 2>"$scratch/errors" | tee "$scratch/said"
status=${PIPESTATUS[0]}
cat "$scratch/errors"
if [ "$status" -eq 77 ]; then
  echo "skipped the kernel in a virtual machine ($(tail -n 1 "$scratch/errors"))"
elif [ "$status" -ne 0 ]; then
  grep -q '^not ok ' "$scratch/said" || echo "not ok the kernel in a virtual machine (status $status)"
  tail -n 60 "$scratch/log" 2>/dev/null | sed 's/^/    /'
fi
