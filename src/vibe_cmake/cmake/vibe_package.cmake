# What every C++ package of ViBE does in the same way: settings, libraries, programs. Needs no ROS. The functions make
# plain CMake targets, so that a package adds include folders and libraries with CMake's own commands.

set(VIBE_CMAKE_DIR ${CMAKE_CURRENT_LIST_DIR})

# vibe_package(): settings of the package, and the interface library <package>_options with its compiler flags.
#   VIBE_WARNINGS_ARE_ERRORS=ON  for those who change the code; other compilers than theirs warn of other things
#   VIBE_SANITIZE=ON      sanitizers, those of VIBE_SANITIZERS
#   VIBE_UNITY_BUILD=OFF  compiles every source by itself: finds missing includes, takes three times as long
macro(vibe_package)
  set(CMAKE_CXX_STANDARD 17)
  set(CMAKE_CXX_STANDARD_REQUIRED ON)
  set(CMAKE_CXX_EXTENSIONS OFF)
  set(CMAKE_POSITION_INDEPENDENT_CODE ON)
  set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
  if(NOT CMAKE_BUILD_TYPE)
    set(CMAKE_BUILD_TYPE Release)
  endif()
  if(NOT COMMAND catkin_package)
    enable_testing()  # here: in a function it would be lost
  endif()
  option(VIBE_WARNINGS_ARE_ERRORS "Stop at compiler warnings" OFF)
  option(VIBE_SANITIZE "Build with sanitizers" OFF)
  set(VIBE_SANITIZERS address,undefined CACHE STRING "What VIBE_SANITIZE builds with; or thread")
  option(VIBE_UNITY_BUILD "Compile the sources of a folder as one file" ON)

  add_library(${PROJECT_NAME}_options INTERFACE)
  target_compile_options(${PROJECT_NAME}_options INTERFACE
    -Wall -Wextra -Wpedantic -Wconversion -Wno-sign-conversion $<$<BOOL:${VIBE_WARNINGS_ARE_ERRORS}>:-Werror>
    # whatever -march a user gives: with wider registers and fused operations Eigen adds up in another order, and it aligns
    # its types otherwise; vibe_instruction_set() follows and comes before this
    "$<$<STREQUAL:${CMAKE_SYSTEM_PROCESSOR},x86_64>:-mno-avx;-mno-fma>"
    # clang++ calls it shadowing, too, where a type within a function has the name of one in another file of the folder
    $<$<CXX_COMPILER_ID:GNU>:-Wshadow>)
  if(VIBE_SANITIZE)
    target_compile_options(${PROJECT_NAME}_options INTERFACE
      -fsanitize=${VIBE_SANITIZERS} -fno-sanitize-recover=undefined -fno-omit-frame-pointer -g)
    target_link_options(${PROJECT_NAME}_options INTERFACE -fsanitize=${VIBE_SANITIZERS})
  endif()
endmacro()

# vibe_eigen(): finds Eigen. Its version 5 has but a target; catkin and packages in a workspace ask for variables.
macro(vibe_eigen)
  find_package(Eigen3 REQUIRED)
  get_target_property(EIGEN3_INCLUDE_DIRS Eigen3::Eigen INTERFACE_INCLUDE_DIRECTORIES)
  set(EIGEN3_FOUND TRUE)
endmacro()

# vibe_rviz_qt(VARIABLE COMPONENT...): finds the Qt that rviz was built with; a plugin with another one crashes when it is
# loaded. VARIABLE gets Qt5 or Qt6. A macro, because what find_package() sets has to stay.
macro(vibe_rviz_qt variable)
  if(NOT rviz_QT_VERSION MATCHES "^[56]\\.")
    message(FATAL_ERROR "rviz does not say which Qt it was built with (rviz_QT_VERSION is '${rviz_QT_VERSION}', expected 5 or 6); install rviz's development files")
  endif()
  string(REGEX REPLACE "\\..*" "" ${variable} "Qt${rviz_QT_VERSION}")
  find_package(${${variable}} REQUIRED COMPONENTS ${ARGN})
endmacro()

# vibe_sources(VARIABLE PATTERN...): the sources that match, without those of programs (*_main.cpp).
function(vibe_sources variable)
  file(GLOB sources CONFIGURE_DEPENDS ${ARGN})
  list(FILTER sources EXCLUDE REGEX "_main\\.cpp$")
  set(${variable} ${sources} PARENT_SCOPE)
endfunction()

# vibe_unity(TARGET [SOURCE...]): compiles these sources (all of the target if none is named) folder by folder, each
# folder as one file. Sources with flags of their own stay alone, and so do those that a package takes out by setting
# their property SKIP_UNITY_BUILD_INCLUSION.
function(vibe_unity target)
  if(NOT VIBE_UNITY_BUILD)
    return()
  endif()
  set(sources ${ARGN})
  if(NOT sources)
    get_target_property(sources ${target} SOURCES)
  endif()
  foreach(source ${sources})
    if(source MATCHES "\\.cpp$")
      get_filename_component(folder ${source} DIRECTORY)
      get_filename_component(folder ${folder} NAME)
      set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${folder})
    endif()
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()

# vibe_library(NAME [STATIC|SHARED] PATTERN...): a library of the sources that match, with the options of the package.
# catkin_lint does not know that this makes a target, and vibe_eigen() variables, which CMake itself checks: packages tell
# it so in a line after project(). It follows both branches of an if(); `skip` hides that of plain CMake.
function(vibe_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "STATIC;SHARED" "" "")
  vibe_sources(sources ${arg_UNPARSED_ARGUMENTS})
  if(arg_STATIC)
    add_library(${name} STATIC ${sources})
  elseif(arg_SHARED)
    add_library(${name} SHARED ${sources})
  else()
    add_library(${name} ${sources})
  endif()
  target_link_libraries(${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_NAME}_options>)
  vibe_unity(${name})
endfunction()

# vibe_instruction_set(SET SOURCE...): lets these sources use the instructions of a set: sse2 (which every x86-64 has),
# avx2 (with FMA and F16C), avx512 (F, VL, BW, DQ, CD). fused_sse2 is SSE2 with an emulated fused multiply-add, which is used
# by the thousand: small code, which compiles in seconds.
function(vibe_instruction_set set)
  set(options "")
  if(set STREQUAL "fused_sse2")
    set(options -Os)
  elseif(set MATCHES "^avx")
    set(options -mavx2 -mfma -mf16c)
  elseif(NOT set STREQUAL "sse2")
    message(FATAL_ERROR "There is no instruction set '${set}'; use sse2, fused_sse2, avx2 or avx512")
  endif()
  if(set STREQUAL "avx512")
    # GCC 12 warns in its own header for intrinsics (bug 105593)
    list(APPEND options -mavx512f -mavx512vl -mavx512bw -mavx512dq -mavx512cd -Wno-uninitialized
                        $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  endif()
  foreach(source ${ARGN})
    set_property(SOURCE ${source} PROPERTY COMPILE_OPTIONS ${options})
  endforeach()
endfunction()

# vibe_kernels(TARGET KERNEL... SETS SET...): compiles src/KERNEL_impl.hpp for each of these instruction sets, by itself,
# as a part of the target. In it VIBE_KERNEL_SET is the set, as a word of C++: Sse2, FusedSse2, Avx2. What it defines
# outside of unnamed namespaces has to have names that contain the set.
function(vibe_kernels target)
  cmake_parse_arguments(arg "" "" "SETS" ${ARGN})
  set(word_sse2 Sse2)
  set(word_fused_sse2 FusedSse2)
  set(word_avx2 Avx2)
  foreach(kernel ${arg_UNPARSED_ARGUMENTS})
    foreach(set ${arg_SETS})
      set(source ${CMAKE_CURRENT_BINARY_DIR}/kernels/${kernel}_${set}.cpp)
      file(GENERATE OUTPUT ${source} CONTENT "#define VIBE_KERNEL_SET ${word_${set}}\n#include \"${kernel}_impl.hpp\"\n")
      set_property(SOURCE ${source} PROPERTY GENERATED TRUE)
      vibe_instruction_set(${set} ${source})
      target_sources(${target} PRIVATE ${source})
    endforeach()
  endforeach()
endfunction()

# vibe_programs(PATTERN... LINK LIBRARY... [DESTINATION FOLDER] [NAMES VARIABLE]): a program for every source that
# matches, named after it without `_main`, and installed. VARIABLE gets the names.
function(vibe_programs)
  cmake_parse_arguments(arg "" "DESTINATION;NAMES" "LINK" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${arg_UNPARSED_ARGUMENTS})
  set(names "")
  foreach(source ${sources})
    get_filename_component(name ${source} NAME_WE)
    string(REGEX REPLACE "_main$" "" name ${name})
    add_executable(${name} ${source})
    target_link_libraries(${name} ${arg_LINK} ${PROJECT_NAME}_options)
    # programs read options and call libraries; this compiles by a third faster
    target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>)
    list(APPEND names ${name})
  endforeach()
  if(NOT arg_DESTINATION)
    set(arg_DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
  endif()
  if(names)
    install(TARGETS ${names} RUNTIME DESTINATION ${arg_DESTINATION})
  endif()
  if(arg_NAMES)
    set(${arg_NAMES} ${names} PARENT_SCOPE)
  endif()
endfunction()
