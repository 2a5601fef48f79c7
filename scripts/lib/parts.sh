# The parts of the workspace: what is installed and built when it is first asked for. Sourced, never run.

# packagesOf PART: the packages of a part; to be built without tests they need no other part but `session`, except that
# `tests` needs all of them. A program that starts nodes of further parts names these (`parts()` in vibe_bringup).
packagesOf() {
  case $1 in
    session) echo vibe_cmake vibe_msgs vibe_core vibe_description vibe_ros_utils vibe_sim vibe_graphics vibe_endoscope vibe_operator vibe_rviz_plugins vibe_sessions vibe_bringup ;;
    devices) echo vibe_firmware vibe_hardware ;;
    vision) echo vibe_vision vibe_vision_evidence ;;
    measurements) echo vibe_latency vibe_prototype vibe_testing vibe_benchmarks vibe_python ;;
    python) echo vibe_python ;;
    web) echo vibe_web ;;
    tests) echo vibe_testing vibe_system_tests ;;
    *) return 1 ;;
  esac
}

# keysOf PART: the lines of apt_packages.txt, besides those of dependencies, that a part needs
keysOf() {
  case $1 in
    session) echo @build @run ;;
    measurements) echo @count ;;
    firmware) echo @firmware ;;
    packages) echo @package ;;
    web) echo @web ;;
    tests) echo @test @lint ;;
  esac
}

# newerSources BUILT TESTING PACKAGE...: what is compiled, or what code or build files are generated from, and newer than
# the record of a build; of tests only where TESTING is ON; no package: of all. What is read where it lies, such as
# Python modules, scenes and pages, needs no build.
newerSources() {
  local built=$1 name without=() folders=()
  [ "$2" = ON ] || without=(! -path '*/test/*' ! -path '*/fuzz/*')
  shift 2
  [ $# -gt 0 ] || folders=("$vibe_root/src")
  for name in "$@"; do [ ! -d "$vibe_root/src/$name" ] || folders+=("$vibe_root/src/$name"); done
  [ ${#folders[@]} -eq 0 ] || find "${folders[@]}" -type f -newer "$built" "${without[@]}" \( -name '*.[ch]pp' -o -name '*.[ch]' \
    -o -name '*.cc' -o -name '*.inl' -o -name '*.msg' -o -name '*.srv' -o -name '*.action' -o -name '*.cmake' -o -name CMakeLists.txt \
    -o -name package.xml -o -name setup.py \)
}

parts=(session devices vision measurements python web firmware packages tests)

# checkPart PART: ends the script if there is no such part
checkPart() {
  [[ " ${parts[*]} " == *" $1 "* ]] || usageError "--part: there is no part '$1'; choose one of ${parts[*]}"
}
