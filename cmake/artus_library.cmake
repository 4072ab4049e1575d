# SPDX-License-Identifier: AGPL-3.0-or-later
# artus_library(NAME [COLD] HEADERS ... SOURCES ... DEPENDS ... PRIVATE_DEPENDS ... PACKAGES ... OPTIONS ...)
# One folder (or one room of anatomy/) = one static library artus_NAME (artus::NAME) and one component of
# the installed package. HEADERS are all; those are installed that public ones need (public_headers.cmake). PACKAGES are the outside libraries that whoever
# asks for the component needs beyond those of its rooms, by the names of cmake/packages.cmake. OPTIONS
# are the room's own compile options. COLD: no tick and no line of an image runs in it, so it is compiled for
# a quick build. Small sources are compiled together (precompiled.cmake).
function(artus_library name)
  cmake_parse_arguments(A "COLD" "" "HEADERS;SOURCES;DEPENDS;PRIVATE_DEPENDS;PACKAGES;OPTIONS" ${ARGN})
  add_library(artus_${name} STATIC ${A_SOURCES})
  add_library(artus::${name} ALIAS artus_${name})
  set_target_properties(artus_${name} PROPERTIES EXPORT_NAME ${name})
  file(RELATIVE_PATH folder ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
  set(installed)
  foreach(header IN LISTS A_HEADERS)
    artus_include_path(${folder}/${header} path)
    set_property(GLOBAL APPEND PROPERTY ARTUS_HEADERS_OF_${name} ${path})
    if(DEFINED ARTUS_PUBLIC_NAME_${folder}/${header})
      # the file itself: what stands for it in the include directory is a link
      get_filename_component(place include/${path} DIRECTORY)
      install(FILES ${header} DESTINATION ${place} COMPONENT development)
    elseif(path IN_LIST ARTUS_INSTALLED_HEADERS)
      list(APPEND installed ${ARTUS_INCLUDE_DIR}/${path})
    endif()
  endforeach()
  target_sources(artus_${name} PUBLIC FILE_SET HEADERS BASE_DIRS ${ARTUS_INCLUDE_DIR} FILES ${installed})
  target_include_directories(artus_${name} PUBLIC $<BUILD_INTERFACE:${ARTUS_INCLUDE_DIR}> $<INSTALL_INTERFACE:include>)
  target_compile_features(artus_${name} PUBLIC cxx_std_20)
  artus_warnings(artus_${name})
  target_compile_options(artus_${name} PRIVATE ${A_OPTIONS})
  artus_joined(artus_${name})
  if(A_COLD)
    artus_cold(artus_${name})
  elseif(name STREQUAL "core" OR A_OPTIONS)
    artus_precompiled(artus_${name})
  else()
    artus_precompiled(artus_${name} REUSE artus_core)
  endif()
  target_link_libraries(artus_${name} PUBLIC ${A_DEPENDS} PRIVATE ${A_PRIVATE_DEPENDS})
  install(TARGETS artus_${name} EXPORT artus-${name}
    ARCHIVE DESTINATION lib COMPONENT development OPTIONAL
    FILE_SET HEADERS DESTINATION include COMPONENT development)
  install(EXPORT artus-${name} NAMESPACE artus:: DESTINATION lib/cmake/artus FILE artus-${name}-targets.cmake
    COMPONENT development)
  set(rooms ${A_DEPENDS} ${A_PRIVATE_DEPENDS})
  list(FILTER rooms INCLUDE REGEX "^artus::")
  list(TRANSFORM rooms REPLACE "^artus::" "")
  set_property(GLOBAL APPEND PROPERTY ARTUS_LIBRARIES ${name})
  set_property(GLOBAL PROPERTY ARTUS_ROOMS_OF_${name} ${rooms})
  set_property(GLOBAL PROPERTY ARTUS_PACKAGES_OF_${name} ${A_PACKAGES})
endfunction()

# A text file of the repository as a header of the calling library, so that an installed artus needs no
# search path: TEMPLATE (a .h.in beside the CMakeLists) with TEXT put in.
function(artus_bundle library template header)
  configure_file(${template} ${CMAKE_CURRENT_BINARY_DIR}/generated/artus/detail/${header} @ONLY)
  target_include_directories(artus_${library} PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/generated)
endfunction()

# The warnings and floating-point rules every target of the project obeys: results must not depend
# on contraction into fused multiply-adds, so the same source gives the same bytes on every build.
# GCC 12 sees overlapping and overlong copies in std::string's operator+ that are not there (GCC PR 105651).
function(artus_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -Wconversion -Wnon-virtual-dtor
    -ffp-contract=off
    "$<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-restrict;-Wno-array-bounds;-Wno-stringop-overflow>"
    $<$<BOOL:${ARTUS_WERROR}>:-Werror>)
endfunction()
