# SPDX-License-Identifier: AGPL-3.0-or-later
# Every function marked ARTUS_REALTIME is run under the allocation and lock counters (tests/support/real_time.h).
cmake_minimum_required(VERSION 3.25)
set(files "")
foreach(folder core anatomy raycast haptics echo operators dataset simulation session training evidence exchange tests)
  file(GLOB_RECURSE found ${ROOT}/${folder}/*.h)
  if(folder STREQUAL "tests")
    file(GLOB_RECURSE found ${ROOT}/tests/*_test.cpp)
  endif()
  list(APPEND files ${found})
endforeach()
list(FILTER files EXCLUDE REGEX "core/check\\.h$")
execute_process(COMMAND awk -f ${CMAKE_CURRENT_LIST_DIR}/real_time.awk ${files} OUTPUT_VARIABLE bad COMMAND_ERROR_IS_FATAL ANY)
if(bad)
  string(REGEX REPLACE "(^|\n)${ROOT}/" "\\1  " bad "${bad}")  # indented lines are not wrapped
  message(FATAL_ERROR "real-time contracts that no test holds:\n${bad}")
endif()
