# SPDX-License-Identifier: AGPL-3.0-or-later
# cmake --install puts libraries, headers, the tool and the bundled joints in place, with a package
# file so that another project can say find_package(artus COMPONENTS echo) and link artus::echo.
include(CMakePackageConfigHelpers)
get_property(ARTUS_COMPONENTS GLOBAL PROPERTY ARTUS_LIBRARIES)
set(ARTUS_COMPONENT_TABLE "")
foreach(component ${ARTUS_COMPONENTS})
  get_property(rooms GLOBAL PROPERTY ARTUS_ROOMS_OF_${component})
  get_property(packages GLOBAL PROPERTY ARTUS_PACKAGES_OF_${component})
  string(APPEND ARTUS_COMPONENT_TABLE
    "set(artus_rooms_of_${component} ${rooms})\nset(artus_packages_of_${component} ${packages})\n")
endforeach()
configure_package_config_file(cmake/artus-config.cmake.in ${PROJECT_BINARY_DIR}/artus-config.cmake
  INSTALL_DESTINATION lib/cmake/artus)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/artus-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/artus-config.cmake ${PROJECT_BINARY_DIR}/artus-config-version.cmake
  cmake/packages.cmake DESTINATION lib/cmake/artus COMPONENT development)
# Component `program`: what a user of the tool needs. What was not built is left out of an installation.
install(DIRECTORY meshes/ DESTINATION share/artus/meshes COMPONENT program
  FILES_MATCHING PATTERN "*.toml" PATTERN "*.ply" PATTERN "*.artus" PATTERN "README.md" PATTERN "generate" EXCLUDE)
install(DIRECTORY devices/ DESTINATION share/artus/devices COMPONENT program FILES_MATCHING PATTERN "*.toml")
install(DIRECTORY training/scenarios/ DESTINATION share/artus/scenarios COMPONENT program
  FILES_MATCHING PATTERN "*.toml")
install(FILES LICENSE DESTINATION share/doc/artus RENAME copyright COMPONENT program)
install(FILES README.md CHANGELOG.md DESTINATION share/doc/artus COMPONENT program)
# `programs`: what component `program` brings. `installed`: the libraries as well; no tests and benches.
add_custom_target(programs)
foreach(target artus artus_hands artus_validate artus_python artus_engine artus_bridge_touch artus_bridge_force_dimension
    artus_bridge_haply artus_bridge_virtuose)
  if(TARGET ${target})
    add_dependencies(programs ${target})
  endif()
endforeach()
list(TRANSFORM ARTUS_COMPONENTS PREPEND artus_ OUTPUT_VARIABLE libraries)
add_custom_target(installed DEPENDS programs ${libraries})
