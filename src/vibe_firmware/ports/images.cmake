# The images of all ports. No heap: neither newlib's system calls nor libstdc++ are linked, so that an image that asks
# for memory does not link.

# firmware_image(NAME PORT CORE SOURCE...): links PORT's memory layout and startup with SOURCEs in the folder PORT.
function(firmware_image name port core)
  list(TRANSFORM ARGN PREPEND ${port}/)
  add_executable(${name} ${ARGN} common/startup.cpp)
  target_include_directories(${name} PRIVATE ${port})
  target_compile_options(${name} PRIVATE -ffp-contract=off)
  target_link_libraries(${name} PRIVATE ${core} device_options -lm -lc_nano -lgcc)
  target_link_options(
    ${name} PRIVATE -nostdlib -nostartfiles -T${CMAKE_CURRENT_SOURCE_DIR}/common/cortex_m7.ld
    -L${CMAKE_CURRENT_SOURCE_DIR}/${port} -Wl,--gc-sections -Wl,--fatal-warnings -Wl,-Map=${name}.map)
  set_target_properties(
    ${name} PROPERTIES SUFFIX .elf LINK_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/common/cortex_m7.ld;${CMAKE_CURRENT_SOURCE_DIR}/${port}/memory.ld")
endfunction()

set(MPS2_SOURCES processor.cpp semihosting.cpp tick_timer.cpp)
set(MPS2_USB_SOURCES ${MPS2_SOURCES} uart_link.cpp usb_board.cpp)
firmware_image(firmware_mps2_haptic_usb mps2_an500 firmware_core haptic_usb_main.cpp ${MPS2_USB_SOURCES})
firmware_image(firmware_mps2_input_usb mps2_an500 firmware_core input_usb_main.cpp ${MPS2_USB_SOURCES})
firmware_image(firmware_mps2_haptic_cosim mps2_an500 firmware_core haptic_cosim_main.cpp ${MPS2_SOURCES})

# Controls of the tests, not built by default: an image with fused multiplications, which gives another trace, and one
# that asks for memory, which must not link.
firmware_core(firmware_core_fused fast)
firmware_image(firmware_mps2_haptic_cosim_fused mps2_an500 firmware_core_fused haptic_cosim_main.cpp ${MPS2_SOURCES})
firmware_image(firmware_mps2_heap mps2_an500 firmware_core heap_main.cpp ${MPS2_SOURCES})
set_target_properties(firmware_core_fused firmware_mps2_haptic_cosim_fused firmware_mps2_heap PROPERTIES EXCLUDE_FROM_ALL ON)

# STM32F767, compiled but never run on hardware. USB needs TinyUSB 0.17 or later, Arm's CMSIS core headers (core_cm7.h) and
# ST's device headers (stm32f7xx.h); without these paths the images have no USB.
set(TINYUSB_DIR "" CACHE PATH "TinyUSB")
set(CMSIS_CORE_DIR "" CACHE PATH "folder with core_cm7.h")
set(CMSIS_DEVICE_DIR "" CACHE PATH "folder with stm32f7xx.h")
set(STM32_SOURCES clocks.cpp diagnostics.cpp nucleo_board.cpp processor.cpp serial_number.cpp)
if(NOT TINYUSB_DIR)
  list(APPEND STM32_SOURCES no_usb_handler.cpp)
else()
  include(tinyusb.cmake)
endif()
foreach(device haptic input)
  firmware_image(firmware_stm32f767_${device} stm32f767 firmware_core ${device}_main.cpp ${STM32_SOURCES})
  if(TINYUSB_DIR)
    target_link_libraries(firmware_stm32f767_${device} PRIVATE tinyusb)
  endif()
endforeach()
