# What plain CMake installs besides: the library with its package files, so that find_package(vibe_core) works, and the
# endoscope's description, which the scenes name as package://vibe_description.
include(CMakePackageConfigHelpers)
install(TARGETS vibe_core EXPORT vibe_coreTargets LIBRARY DESTINATION ${INSTALL_LIB} ARCHIVE DESTINATION ${INSTALL_LIB})
install(EXPORT vibe_coreTargets NAMESPACE vibe_core:: DESTINATION ${INSTALL_LIB}/cmake/vibe_core)
configure_package_config_file(cmake/vibe_coreConfig.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/vibe_coreConfig.cmake
                              INSTALL_DESTINATION ${INSTALL_LIB}/cmake/vibe_core)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/vibe_coreConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/vibe_coreConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/vibe_coreConfigVersion.cmake
        DESTINATION ${INSTALL_LIB}/cmake/vibe_core)
install(FILES package.xml DESTINATION ${INSTALL_SHARE})
set(DESCRIPTION ${CMAKE_CURRENT_SOURCE_DIR}/../vibe_description)
if(EXISTS ${DESCRIPTION}/urdf)
  install(FILES ${DESCRIPTION}/package.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/vibe_description)
  install(DIRECTORY ${DESCRIPTION}/urdf ${DESCRIPTION}/meshes DESTINATION ${CMAKE_INSTALL_DATADIR}/vibe_description)
endif()
