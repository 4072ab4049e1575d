# SPDX-License-Identifier: AGPL-3.0-or-later
# The two halves of a step, hands and image, are composed in one place: the room simulation/. Whoever else names them
# has a step of its own, and a feature then reaches only the copy where it was made.
cmake_minimum_required(VERSION 3.25)
set(halves "(^|[^A-Za-z_])(HapticCore|ImageCore|NeedleRenderer|NeedleTickStep|FluidShapes|NeedleTissue|SyringeCore)[^A-Za-z_]")
# Which of them a folder may name all the same: the laws themselves; bodies that are formulas, which no image shows.
set(may "^simulation/" "^haptics/needle/" "^operators/trajectory_forces" "^evidence/validation/needle/" "^apps/hello"
  "^evidence/runs/needle_trace" "^evidence/validation/soft/needled_block" "^evidence/validation/injection/" "^python/forces"
  "^evidence/validation/soft/soft_gates")
set(bad "")
foreach(folder operators dataset simulation session training evidence exchange reports viewer trainer python apps)
  file(GLOB_RECURSE files RELATIVE ${ROOT} ${ROOT}/${folder}/*.h ${ROOT}/${folder}/*.cpp)
  foreach(f ${files})
    set(known FALSE)
    foreach(pattern ${may})
      if(f MATCHES "${pattern}")
        set(known TRUE)
      endif()
    endforeach()
    if(known)
      continue()
    endif()
    file(STRINGS ${ROOT}/${f} lines REGEX "${halves}")
    foreach(line IN LISTS lines)
      if(NOT line MATCHES "^ *//")
        list(APPEND bad "${f}: ${line}")
      endif()
    endforeach()
  endforeach()
endforeach()
if(bad)
  string(REPLACE ";" "\n  " bad "${bad}")
  message(FATAL_ERROR "a step of its own beside simulation/:\n  ${bad}")
endif()
