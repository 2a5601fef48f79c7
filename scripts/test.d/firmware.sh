# The firmware images: what they contain, and how they run in QEMU against a simulated motor. docs/hardware.md states the
# figures.
# kind: computing
# cost: 120
# alone-with: build-firmware
# packages: docs vibe_firmware
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

for tool in arm-none-eabi-g++ qemu-system-arm; do
  command -v $tool >/dev/null || skip "firmware ($tool is missing; scripts/setup installs it)"
done
if [ -n "${VIBE_VARIANT:-}" ]; then
  # there are no sanitizers for a Cortex-M7, but the same code runs on the host
  sanitized=$root/build-firmware/host$VIBE_VARIANT
  buildsSanitized() {
    cmake -S "$root/src/vibe_firmware/ports" -B "$sanitized" -DVIBE_SANITIZE=ON &&
      cmake --build "$sanitized" --target vibe_cosim -j "$(nproc)"
  }
  check 'firmware: host programs build with sanitizers' buildsSanitized
  for scenario in hostile passive release; do
    check "firmware: scenario $scenario under the sanitizers" "$sanitized/vibe_cosim" $scenario
  done
  exit 0
fi

build=$root/build-firmware
cosim=$build/host/vibe_cosim
haptic=$build/arm/firmware_mps2_haptic_cosim.elf
tests=$root/src/vibe_firmware/test/qemu
counter=$build/host/count_instructions.so
budget=2500  # instructions of a control interrupt

check 'firmware: images and host programs build' "$root/scripts/firmware"
[ -x "$cosim" ] && [ -f "$haptic" ] || exit 1

# inQemu IMAGE SCENARIO [OPTION...]: output of the run, with errors
inQemu() {
  local image=$1
  shift
  /usr/bin/python3 "$tests/run_cosim.py" "$image" --cosim "$cosim" "$@" 2>&1
}

# --- what is in the images

usesNoHeap() {
  local image hits
  for image in "$build"/arm/*.elf; do
    hits=$(arm-none-eabi-nm "$image" | grep -E ' (_?(malloc|calloc|realloc|free|sbrk)(_r)?|_Zn[wa].*|_Zd[la].*|__cxa_throw|_Unwind_.*|_ZTI.*)$' || true)
    [ -z "$hits" ] || { printf '%s:\n%s\n' "${image##*/}" "$hits"; return 1; }
  done
}
check 'firmware: no heap, no exceptions, no run-time type information in any image' usesNoHeap

heapDoesNotLink() {
  ! cmake --build "$build/arm" --target firmware_mps2_heap >"$scratch/heap" 2>&1 || { echo 'it links'; return 1; }
  grep -qE 'undefined reference to .(operator new|_sbrk)' "$scratch/heap" || { cat "$scratch/heap"; return 1; }
}
check 'control: an image that asks for memory does not link' heapDoesNotLink

# vector IMAGE NUMBER: entry of the vector table at 0x08000000, in hexadecimal
vector() {
  local address=$((16#08000000 + 4 * $2)) word
  word=$(arm-none-eabi-objdump -s -j .vectors --start-address $address --stop-address $((address + 4)) "$1" |
    sed -nE 's/^ 8[0-9a-f]+ (..)(..)(..)(..) .*/\4\3\2\1/p')
  echo "$word"
}
# address IMAGE FUNCTION: with the bit that marks Thumb code
address() {
  printf '%08x' $((16#$(arm-none-eabi-nm "$1" | sed -n "s/ T $2\$//p") | 1))
}
vectorsAreRight() {
  local image
  for image in "$build"/arm/firmware_stm32f767_*.elf; do
    echo "$image: $(vector "$image" 0) $(vector "$image" 1) $(vector "$image" 70)"
    [ "$(vector "$image" 0)" = 20020000 ] && [ "$(vector "$image" 1)" = "$(address "$image" resetHandler)" ] &&
      [ "$(vector "$image" $((16 + 54)))" = "$(address "$image" tickHandler)" ] &&
      [ "$(vector "$image" $((16 + 67)))" = "$(address "$image" usbHandler)" ] || return 1
  done
}
check 'firmware: vectors of the images for STM32F767: end of DTCM, reset, TIM6, OTG_FS (never run)' vectorsAreRight

compilesTinyUsbLink() {
  local ports=$root/src/vibe_firmware/ports
  arm-none-eabi-g++ -mcpu=cortex-m7 -mthumb -mfloat-abi=hard -mfpu=fpv5-d16 -std=c++17 -O2 -Wall -Wextra -Wpedantic \
    -Wshadow -Wconversion -Wno-sign-conversion -Werror -fno-exceptions -fno-rtti -I "$root/src/vibe_firmware/include" \
    -I "$ports/common" \
    -I "$ports/stm32f767" -I "$ports/stm32f767/tinyusb" -I "$root/src/vibe_firmware/test/tinyusb" \
    -c -o "$scratch/tinyusb_link.o" "$ports/stm32f767/tinyusb_link.cpp"
}
check 'firmware: the link to TinyUSB compiles against the declarations that it uses' compilesTinyUsbLink
# On this machine, where registers are memory and no barrier is needed.
linkStalls() {
  local ports=$root/src/vibe_firmware/ports tests=$root/src/vibe_firmware/test/tinyusb
  sed '/asm volatile("dsb"/d' "$ports/stm32f767/tinyusb_link.cpp" >"$scratch/link.cpp"
  c++ -std=c++17 -O1 -Wall -Wextra -Werror -I "$root/src/vibe_firmware/include" -I "$ports/common" \
    -I "$ports/stm32f767" -I "$ports/stm32f767/tinyusb" -I "$tests" -o "$scratch/link_check" "$scratch/link.cpp" \
    "$tests/link_check.cpp" && "$scratch/link_check"
}
check 'firmware: the link stalls a malformed SET_REPORT and tells of a suspended bus' linkStalls
missingTinyUsb() {
  cmake -S "$root/src/vibe_firmware/ports" -B "$scratch/tinyusb" -DTINYUSB_DIR="$scratch" \
    -DCMAKE_TOOLCHAIN_FILE="$root/src/vibe_firmware/ports/arm-none-eabi.cmake" && return 1
  cmake -S "$root/src/vibe_firmware/ports" -B "$scratch/tinyusb" 2>&1 | grep -q 'There is no src/tusb.h in TINYUSB_DIR'
}
check 'firmware: a TINYUSB_DIR without TinyUSB is refused' missingTinyUsb

printSizes() {
  arm-none-eabi-size "$build"/arm/firmware_*.elf | sed "s#$build/arm/##"
}
printSizes

# --- QEMU

runsEachScenario() {
  local scenario
  for scenario in hostile passive release; do
    inQemu "$haptic" "$scenario" --trace "$scratch/$scenario.qemu" >"$scratch/$scenario.said" || true
    "$cosim" "$scenario" --trace "$scratch/$scenario.host" >"$scratch/$scenario.host.said" || true
    grep -q '^verdict: ' "$scratch/$scenario.said" || { cat "$scratch/$scenario.said"; return 1; }
  done
}
check 'QEMU: the haptic device runs in lock-step with a motor' runsEachScenario
cat "$scratch"/{release,passive,hostile}.said 2>/dev/null || true

# periodIs COUNTS..COUNTS FILE
periodIs() {
  local found
  found=$(sed -n 's/^period, shortest and longest \[40 ns\]: //p' "$2")
  echo "period: $found"
  [ "$found" = "$1 $1" ]
}
isExact() {
  grep -qx 'ticks: 20000' "$scratch/hostile.said" && periodIs 25000 "$scratch/hostile.said"
}
check 'QEMU: the 1 kHz period is exact over 20 virtual seconds (25000 counts of 25 MHz)' isExact
withoutVirtualTime() {
  inQemu "$haptic" hostile --ticks 2000 --shift none >"$scratch/real_time" || true
  grep -q '^period' "$scratch/real_time" && ! periodIs 25000 "$scratch/real_time"
}
check 'control: without virtual time the period is not exact' withoutVirtualTime

sameTrace() {
  local scenario
  for scenario in hostile passive release; do
    "$cosim" --compare "$scratch/$scenario.host" "$scratch/$scenario.qemu" || return 1
  done
  [ "$(sed -n 's/^trace: //p' "$scratch/hostile.said")" = "$(sed -n 's/^trace: //p' "$scratch/hostile.host.said")" ]
}
check 'QEMU and host give the same bits in 20,000 ticks of random parameters, 20,000 of a sweep, 2,400 of a release' sameTrace
fusedDiffers() {
  cmake --build "$build/arm" --target firmware_mps2_haptic_cosim_fused || return 1
  inQemu "$build/arm/firmware_mps2_haptic_cosim_fused.elf" hostile --trace "$scratch/fused" || true
  ! "$cosim" --compare "$scratch/hostile.host" "$scratch/fused"
}
check 'control: with fused multiplications the bits differ' fusedDiffers

# withinBudget FILE: what the counter of instructions has written there
withinBudget() {
  local counted='^count_instructions: calls ([0-9]+), shortest ([0-9]+), longest ([0-9]+), mean [0-9.]+$'
  grep '^count_instructions' "$1" >"$scratch/counted" || { cat "$1"; return 1; }
  [[ $(cat "$scratch/counted") =~ $counted ]] || return 1
  [ "${BASH_REMATCH[1]}" -ge "$2" ] && [ "${BASH_REMATCH[2]}" -gt 100 ] && [ "${BASH_REMATCH[3]}" -le $budget ]
}
lockStepWithinBudget() {
  inQemu "$haptic" hostile --plugin "$counter" >"$scratch/lockstep.counted" || true
  withinBudget "$scratch/lockstep.counted" 20000
}
check "QEMU: a control interrupt takes at most $budget instructions, the exchange with the plant included" lockStepWithinBudget

# withinBounds SCENARIO, in QEMU
withinBounds() {
  cat "$scratch/$1.said"
  grep -qx 'verdict: within bounds' "$scratch/$1.said"
}
check 'QEMU: release of a spring-damper agrees with theory' withinBounds release
check 'QEMU: a constant spring and damper give no energy to a hand that moves at 1 Hz to 100 Hz' withinBounds passive
check 'QEMU: hostile parameters at 100 Hz give no more energy than the observer allows' withinBounds hostile
check 'control: torque that comes 3 ticks late gives energy, and the check finds it' gives 1 "$scratch/late" "$cosim" passive --delay 3
check 'control: torque that comes 3 ticks late does not agree with theory' gives 1 "$scratch/late" "$cosim" release --delay 3

# answersHost DEVICE
answersHost() {
  gives 0 "$scratch/$1_usb.counted" /usr/bin/python3 "$tests/uart_usb.py" --plugin "$counter" "$build/arm/firmware_mps2_$1_usb.elf"
}
for device in haptic input; do
  check "QEMU: the $device image answers a USB host over its UART" answersHost $device
  check "QEMU: an interrupt of the $device image takes at most $budget instructions" withinBudget "$scratch/${device}_usb.counted" 1000
done
grep -H '^count_instructions' "$scratch"/*.counted | sed "s#$scratch/##; s#.counted:count_instructions##" || true

check 'vibe_cosim --help' "$cosim" --help
check 'vibe_cosim: unknown scenario' refuses 2 'scenario: .*gentle' "$cosim" gentle
check 'vibe_cosim: a FIFO that is missing' refuses 2 'no_such_fifo cannot be opened' "$cosim" release --fifos "$scratch/no_such_fifo" "$scratch/b"
