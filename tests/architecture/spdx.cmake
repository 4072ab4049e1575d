# SPDX-License-Identifier: AGPL-3.0-or-later
# The licence stands in the first two lines of every source file.
cmake_minimum_required(VERSION 3.25)
set(bad "")
foreach(folder core anatomy raycast haptics echo operators dataset simulation session evidence exchange reports python apps viewer trainer meshes tests bench scripts cmake)
  file(GLOB_RECURSE files ${ROOT}/${folder}/*.h ${ROOT}/${folder}/*.cpp ${ROOT}/${folder}/*.c ${ROOT}/${folder}/*.cmake ${ROOT}/${folder}/CMakeLists.txt
    ${ROOT}/scripts/*)
  foreach(f ${files})
    file(STRINGS ${f} head LIMIT_COUNT 2)
    if(NOT head MATCHES "SPDX-License-Identifier: AGPL-3.0-or-later")
      list(APPEND bad ${f})
    endif()
  endforeach()
endforeach()
if(bad)
  list(REMOVE_DUPLICATES bad)
  string(REPLACE ";" "\n" bad "${bad}")
  message(FATAL_ERROR "no SPDX line in:\n${bad}")
endif()
