# SPDX-License-Identifier: AGPL-3.0-or-later
# What nearly every file includes is parsed once: Eigen and the standard library's headers alone for the
# libraries, GoogleTest with them for the tests (docs/decisions/0002-precompiled-headers.md). Headers of ours are never
# among them. The tidy preset builds without, so that a file that forgets an include is found.
option(ARTUS_PRECOMPILED_HEADERS "Parse the outside headers that most files include once" ON)
set(ARTUS_COMMON_HEADERS
  <algorithm> <array> <chrono> <cmath> <cstdint> <cstdio> <filesystem> <functional> <limits> <map> <memory> <numbers>
  <optional> <span> <string> <string_view> <utility> <variant> <vector> <Eigen/Core> <Eigen/Geometry> <tl/expected.hpp>)

# artus_precompiled(target <header> ...): the headers above and those named.
# artus_precompiled(target REUSE other): those of another target, which is compiled with the same options.
function(artus_precompiled target)
  cmake_parse_arguments(A "" "REUSE" "" ${ARGN})
  if(NOT ARTUS_PRECOMPILED_HEADERS)
    return()
  endif()
  if(A_REUSE)
    target_precompile_headers(${target} REUSE_FROM ${A_REUSE})
  else()
    target_precompile_headers(${target} PRIVATE ${ARTUS_COMMON_HEADERS} ${A_UNPARSED_ARGUMENTS})
  endif()
endfunction()

# artus_joined(target): up to twelve sources of one folder are compiled as one, which parses our own headers once for
# them. An edit then costs its neighbours, too: whoever works on one room for long may set
# ARTUS_JOINED_SOURCES=OFF. What the anonymous namespaces of a folder name must differ; the compiler says so.
option(ARTUS_JOINED_SOURCES "Compile several sources of a folder as one" ON)
function(artus_joined target)
  if(NOT ARTUS_JOINED_SOURCES)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  set(folders)
  foreach(source IN LISTS sources)
    get_filename_component(folder "here/${source}" DIRECTORY)
    string(MAKE_C_IDENTIFIER "${folder}" folder)
    list(APPEND folders ${folder})
    list(APPEND in_${folder} ${source})
  endforeach()
  list(REMOVE_DUPLICATES folders)
  foreach(folder IN LISTS folders)
    list(LENGTH in_${folder} count)
    math(EXPR batches "(${count} + 11) / 12")
    set(k 0)
    foreach(source IN LISTS in_${folder})
      math(EXPR batch "${k} * ${batches} / ${count}")
      math(EXPR k "${k} + 1")
      set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${folder}_${batch})
    endforeach()
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()

# artus_cold(target): compiled at -O1, which takes half the time of -O3, with one precompiled header for all
# such targets, the first of them its owner.
function(artus_cold target)
  target_compile_options(${target} PRIVATE -O1)
  get_property(owner GLOBAL PROPERTY ARTUS_COLD_OWNER)
  if(owner)
    artus_precompiled(${target} REUSE ${owner})
  else()
    set_property(GLOBAL PROPERTY ARTUS_COLD_OWNER ${target})
    artus_precompiled(${target} <nlohmann/json.hpp>)
  endif()
endfunction()

# ccache keeps what was compiled with precompiled headers only when it may leave two things unchecked that
# do not occur here: macros defined in front of such a header, and __DATE__ and __TIME__.
find_program(CCACHE ccache)
if(CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE})
endif()
