# Tests may look inside: they see src/ as well as include/. What they share with those of other packages is in the folder
# vibe_testing beside this one. CHOLMOD checks the sparse factor; only its test links it.
if(NOT EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/../vibe_testing)
  message(FATAL_ERROR "There is no folder vibe_testing beside ${CMAKE_CURRENT_SOURCE_DIR}; copy it from the repository")
endif()
find_path(CHOLMOD_INCLUDE_DIR cholmod.h PATH_SUFFIXES suitesparse REQUIRED)
find_library(CHOLMOD_LIBRARY cholmod REQUIRED)
vibe_tests(LINK vibe_core ${BULLET_LIBRARIES} PkgConfig::URDFDOM
           INCLUDE src ${CMAKE_CURRENT_SOURCE_DIR}/../vibe_testing/include
           SYSTEM ${BULLET_INCLUDE_DIRS}
           DEFINITIONS VIBE_CORE_DIR="${CMAKE_CURRENT_SOURCE_DIR}"
                       VIBE_DESCRIPTION_DIR="${CMAKE_CURRENT_SOURCE_DIR}/../vibe_description"
           ISOLATED allocation_test arithmetic_test cholmod_test)
target_include_directories(vibe_core_cholmod_test SYSTEM PRIVATE ${CHOLMOD_INCLUDE_DIR})
target_link_libraries(vibe_core_cholmod_test ${CHOLMOD_LIBRARY})
