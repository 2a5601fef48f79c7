# Programs of this machine that run the firmware against a simulated motor.
add_library(cosim_host STATIC host/axis_plant.cpp host/fifo_peer.cpp)
target_include_directories(cosim_host PUBLIC host)
target_link_libraries(cosim_host PUBLIC firmware_core)
