# Tests: gtest programs, rostests and Python tests, each registered with ctest as <package>/<folder>/<file>.

# The programs of this many test files and more are compiled in several pieces: a test that changes compiles soon.
set(VIBE_TESTS_PER_PIECE 8)

# vibe_tests(LINK LIBRARY... [INCLUDE FOLDER...] [SYSTEM FOLDER...] [DEFINITIONS NAME=VALUE...] [ISOLATED TEST...]
#            [WAITING TEST...] [TIMED TEST...]):
# one gtest program <package>_<folder>_tests of all test/<folder>/*_test.cpp (<package>_tests of test/*_test.cpp), and a
# ctest test for every file, which runs the cases of this file. ISOLATED files change what is global to a process and get
# a program <package>_<file> of their own. A test computes all the time unless it is WAITING (for other processes, or for
# time to pass) or TIMED (it judges wall time, and runs alone).
function(vibe_tests)
  cmake_parse_arguments(arg "" "" "LINK;INCLUDE;SYSTEM;DEFINITIONS;ISOLATED;WAITING;TIMED" ${ARGN})
  if(NOT COMMAND catkin_package)
    find_package(GTest REQUIRED)
  endif()
  file(GLOB sources CONFIGURE_DEPENDS test/*_test.cpp test/*/*_test.cpp)
  set(programs "")
  foreach(source ${sources})
    get_filename_component(name ${source} NAME_WE)
    get_filename_component(folder ${source} DIRECTORY)
    get_filename_component(folder ${folder} NAME)
    if(name IN_LIST arg_ISOLATED)
      set(program ${PROJECT_NAME}_${name})
    elseif(folder STREQUAL "test")
      set(program ${PROJECT_NAME}_tests)
    else()
      set(program ${PROJECT_NAME}_${folder}_tests)
    endif()
    list(APPEND programs ${program})
    list(APPEND sources_of_${program} ${source})
    vibe_add_test_of_file(${program} ${folder} ${name})
    if(name IN_LIST arg_WAITING)
      set_tests_properties(${PROJECT_NAME}/${folder}/${name} PROPERTIES LABELS waiting)
    elseif(name IN_LIST arg_TIMED)
      set_tests_properties(${PROJECT_NAME}/${folder}/${name} PROPERTIES LABELS timed RUN_SERIAL ON)
    endif()
  endforeach()
  list(REMOVE_DUPLICATES programs)
  foreach(program ${programs})
    vibe_add_test_program(${program} ${sources_of_${program}})
    target_include_directories(${program} PRIVATE test ${arg_INCLUDE})
    target_include_directories(${program} SYSTEM PRIVATE ${arg_SYSTEM})
    target_compile_definitions(${program} PRIVATE ${arg_DEFINITIONS})
    target_link_libraries(${program} ${arg_LINK})
  endforeach()
endfunction()

# vibe_add_test_of_file(PROGRAM FOLDER NAME): the cases of NAME.cpp as one test
function(vibe_add_test_of_file program folder name)
  if(CATKIN_TEST_RESULTS_DIR)
    set(results ${CATKIN_TEST_RESULTS_DIR}/${PROJECT_NAME}/${name}.xml)
  else()
    set(results ${CMAKE_BINARY_DIR}/test_results/${PROJECT_NAME}/${name}.xml)
  endif()
  add_test(NAME ${PROJECT_NAME}/${folder}/${name}
           COMMAND ${CATKIN_ENV} $<TARGET_FILE:${program}> --only_file=${name}.cpp --gtest_output=xml:${results}
           WORKING_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/test)
  set_tests_properties(${PROJECT_NAME}/${folder}/${name} PROPERTIES TIMEOUT 600)
endfunction()

# vibe_add_test_program(PROGRAM SOURCE...): built by the target `tests`, run by `run_tests`
function(vibe_add_test_program program)
  set(main ${CMAKE_CURRENT_BINARY_DIR}/${program}_main.cpp)
  file(CONFIGURE OUTPUT ${main} CONTENT "#include \"${VIBE_CMAKE_DIR}/test_main.cpp\"\n")
  add_executable(${program} EXCLUDE_FROM_ALL ${ARGN} ${main})
  target_link_libraries(${program} GTest::gtest ${PROJECT_NAME}_options)
  # what takes long to run is in the libraries; this compiles by a third faster
  target_compile_options(${program} PRIVATE $<$<CONFIG:Release>:-O1>)
  if(VIBE_UNITY_BUILD)
    set(place 0)
    foreach(source ${main} ${ARGN})
      math(EXPR piece "${place} / ${VIBE_TESTS_PER_PIECE}")
      math(EXPR place "${place} + 1")
      set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${piece})
    endforeach()
    set_target_properties(${program} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
    # a case derives from a fixture in the unnamed namespace of its file: right, but not in the main file of GCC
    target_compile_options(${program} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  endif()
  if(TARGET tests)
    add_dependencies(tests ${program})
    set(run run_tests_${PROJECT_NAME}_gtest_${program})
    add_custom_target(${run} COMMAND ${CATKIN_ENV} $<TARGET_FILE:${program}>
      --gtest_output=xml:${CATKIN_TEST_RESULTS_DIR}/${PROJECT_NAME}/gtest-${program}.xml || true
      WORKING_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/test VERBATIM)
    add_dependencies(${run} tests)
    add_dependencies(run_tests ${run})
  else()
    set_target_properties(${program} PROPERTIES EXCLUDE_FROM_ALL OFF)
  endif()
endfunction()

# vibe_rostests(PATTERN... [DEPENDENCIES TARGET...] [COMPUTING TEST...] [TIMED TEST...]): the .test files that match. They
# wait for nodes most of the time, unless they are named COMPUTING or TIMED.
function(vibe_rostests)
  cmake_parse_arguments(arg "" "" "DEPENDENCIES;COMPUTING;TIMED" ${ARGN})
  find_package(rostest REQUIRED)
  file(GLOB files RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} CONFIGURE_DEPENDS ${arg_UNPARSED_ARGUMENTS})
  foreach(file ${files})
    add_rostest(${file} DEPENDENCIES ${arg_DEPENDENCIES})
    get_filename_component(name ${file} NAME_WE)
    string(REPLACE "/" "_" test ${file})
    set(kind waiting)
    if(name IN_LIST arg_COMPUTING)
      set(kind computing)
    elseif(name IN_LIST arg_TIMED)
      set(kind timed)
    endif()
    set_tests_properties(_ctest_${PROJECT_NAME}_rostest_${test} PROPERTIES LABELS ${kind})
  endforeach()
endfunction()

# vibe_python_tests(PATTERN...): unittest files that need no ROS graph, as <package>/test/<file>.
function(vibe_python_tests)
  file(GLOB files CONFIGURE_DEPENDS ${ARGN})
  foreach(file ${files})
    get_filename_component(name ${file} NAME_WE)
    add_test(NAME ${PROJECT_NAME}/test/${name} COMMAND ${CATKIN_ENV} ${PYTHON_EXECUTABLE} -B ${file} -v)
    set_tests_properties(${PROJECT_NAME}/test/${name} PROPERTIES TIMEOUT 600)
  endforeach()
endfunction()
