# Programs of this machine that run the firmware against a simulated motor.
find_package(CLI11 REQUIRED)
add_executable(
  vibe_cosim
  host/axis_plant.cpp
  host/cosim_main.cpp
  host/firmware_peer.cpp
  host/hostile_scenario.cpp
  host/lockstep.cpp
  host/passive_scenario.cpp
  host/release_scenario.cpp
  host/scenario.cpp)
target_link_libraries(vibe_cosim PRIVATE firmware_core CLI11::CLI11)

# Plugin of QEMU that counts instructions.
add_library(count_instructions MODULE qemu_plugin/count_instructions.cpp)
target_link_libraries(count_instructions PRIVATE firmware_options)
set_target_properties(count_instructions PROPERTIES PREFIX "" POSITION_INDEPENDENT_CODE ON)
