# TinyUSB as a library, from the folders that the caller names.
enable_language(C)
foreach(needed TINYUSB_DIR:src/tusb.h CMSIS_CORE_DIR:core_cm7.h CMSIS_DEVICE_DIR:stm32f7xx.h)
  string(REPLACE ":" ";" needed ${needed})
  list(GET needed 0 variable)
  list(GET needed 1 file)
  if(NOT EXISTS "${${variable}}/${file}")
    message(FATAL_ERROR "There is no ${file} in ${variable} ('${${variable}}'); USB on STM32F767 needs all of TINYUSB_DIR, CMSIS_CORE_DIR and CMSIS_DEVICE_DIR.")
  endif()
endforeach()

# usbd_control.c was merged into usbd.c after 0.19, dwc2_common.c split off in 0.18
file(GLOB TINYUSB_SOURCES ${TINYUSB_DIR}/src/tusb.c ${TINYUSB_DIR}/src/common/tusb_fifo.c ${TINYUSB_DIR}/src/device/usbd*.c
     ${TINYUSB_DIR}/src/class/hid/hid_device.c ${TINYUSB_DIR}/src/portable/synopsys/dwc2/dcd_dwc2.c
     ${TINYUSB_DIR}/src/portable/synopsys/dwc2/dwc2_common.c)
add_library(tinyusb STATIC ${TINYUSB_SOURCES})
target_include_directories(tinyusb SYSTEM PUBLIC stm32f767/tinyusb ${TINYUSB_DIR}/src ${CMSIS_CORE_DIR} ${CMSIS_DEVICE_DIR})
target_compile_definitions(tinyusb PUBLIC STM32F767xx VIBE_TINYUSB)
target_compile_options(tinyusb PRIVATE -O2 -ffunction-sections -fdata-sections)
list(APPEND STM32_SOURCES tinyusb_link.cpp)
