# SPDX-License-Identifier: AGPL-3.0-or-later
# artus_library(NAME HEADERS ... SOURCES ... DEPENDS ... PRIVATE_DEPENDS ...)
# One folder = one static library artus_NAME (artus::NAME), its headers in an installable file set.
function(artus_library name)
  cmake_parse_arguments(A "" "" "HEADERS;SOURCES;DEPENDS;PRIVATE_DEPENDS" ${ARGN})
  add_library(artus_${name} STATIC)
  add_library(artus::${name} ALIAS artus_${name})
  set_target_properties(artus_${name} PROPERTIES EXPORT_NAME ${name})
  target_sources(artus_${name} PRIVATE ${A_SOURCES}
    PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${A_HEADERS})
  target_compile_features(artus_${name} PUBLIC cxx_std_20)
  artus_warnings(artus_${name})
  target_link_libraries(artus_${name} PUBLIC ${A_DEPENDS} PRIVATE ${A_PRIVATE_DEPENDS})
  install(TARGETS artus_${name} EXPORT artus FILE_SET HEADERS DESTINATION include/artus)
  set_property(GLOBAL APPEND PROPERTY ARTUS_LIBRARIES ${name})
endfunction()

# The warnings and floating-point rules every target of the project obeys: results must not depend
# on contraction into fused multiply-adds, so the same source gives the same bytes on every build.
# GCC 12 sees overlapping copies in std::string's operator+ at -O3 that are not there (GCC PR 105651).
function(artus_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -Wconversion -Wnon-virtual-dtor
    -ffp-contract=off
    $<$<AND:$<CONFIG:Release>,$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-restrict>
    $<$<BOOL:${ARTUS_WERROR}>:-Werror>)
endfunction()
