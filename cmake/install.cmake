# SPDX-License-Identifier: AGPL-3.0-or-later
# cmake --install puts libraries, headers, the tool and the bundled joints in place, with a package
# file so that another project can say find_package(artus) and link artus::sim.
include(CMakePackageConfigHelpers)
install(EXPORT artus NAMESPACE artus:: DESTINATION lib/cmake/artus FILE artus-targets.cmake)
configure_package_config_file(cmake/artus-config.cmake.in ${PROJECT_BINARY_DIR}/artus-config.cmake
  INSTALL_DESTINATION lib/cmake/artus)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/artus-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/artus-config.cmake ${PROJECT_BINARY_DIR}/artus-config-version.cmake
  cmake/dependencies.cmake DESTINATION lib/cmake/artus)
install(DIRECTORY meshes/ DESTINATION share/artus/meshes
  FILES_MATCHING PATTERN "*.toml" PATTERN "*.ply" PATTERN "README.md" PATTERN "generate" EXCLUDE)
install(DIRECTORY devices/ DESTINATION share/artus/devices FILES_MATCHING PATTERN "*.toml")
