# `cmake --install`: the program with its scenes, and the core library as the package `wunderlich`.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS wunderlich_core EXPORT wunderlich_targets ARCHIVE)
install(DIRECTORY src/wunderlich ${PROJECT_BINARY_DIR}/generated/wunderlich TYPE INCLUDE
  FILES_MATCHING PATTERN "*.hpp" PATTERN "scene" EXCLUDE PATTERN "io" EXCLUDE PATTERN "sweep" EXCLUDE
  PATTERN "picture" EXCLUDE)
install(EXPORT wunderlich_targets NAMESPACE wunderlich:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/wunderlich)

file(WRITE ${PROJECT_BINARY_DIR}/wunderlich-config.cmake
  "include(CMakeFindDependencyMacro)\nfind_dependency(Eigen3 3.4)\n"
  "include(\${CMAKE_CURRENT_LIST_DIR}/wunderlich_targets.cmake)\n")
write_basic_package_version_file(${PROJECT_BINARY_DIR}/wunderlich-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/wunderlich-config.cmake ${PROJECT_BINARY_DIR}/wunderlich-config-version.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/wunderlich)

if(TARGET wunderlich)
  install(TARGETS wunderlich RUNTIME)
  install(DIRECTORY scenes TYPE DATA FILES_MATCHING PATTERN "*.yaml")
endif()
