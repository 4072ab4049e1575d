# SPDX-License-Identifier: AGPL-3.0-or-later
# The headers that programs include: PUBLIC NAME and the file that it is. They stand under artus/; all others are
# artus/detail/ and their folder, and are installed only where one of these needs them.
set(ARTUS_PUBLIC_HEADERS
  core/result.h core/result.h
  core/geometry.h core/geometry.h
  anatomy/compiled_joint.h anatomy/body/compiled_joint.h
  anatomy/joint_file.h anatomy/source/joint_file.h
  anatomy/compile.h anatomy/compile/compile.h
  raycast/scene.h raycast/scene.h
  haptics/device.h haptics/device.h
  haptics/needle_renderer.h haptics/needle/needle_renderer.h
  haptics/needle_feel.h haptics/needle/needle_feel.h
  echo/renderer.h echo/display/renderer.h
  echo/transducer.h echo/probe/transducer.h
  echo/transducer_file.h echo/probe/transducer_file.h
  echo/image_settings.h echo/probe/image_settings.h
  echo/image_io.h echo/display/image_io.h
  echo/frame.h echo/acquire/frame.h
  echo/labels.h echo/display/labels.h
  echo/needle_view.h echo/medium/needle_view.h
  dataset/pose_list.h dataset/pose_list.h
  dataset/sweep.h dataset/sweep.h
  simulation/simulation.h simulation/simulation.h
  simulation/session_params.h simulation/session_params.h
  session/session.h session/session.h
  session/shared_memory_device.h session/shm/shared_memory_device.h
  session/recording.h session/record/recording.h
  session/replay.h session/record/replay.h
  session/client/artus_shm.h session/client/artus_shm.h
  session/client/artus_shm.hpp session/client/artus_shm.hpp
  session/client/artus_shm_layout.h session/client/artus_shm_layout.h
  simulation/input_device.h simulation/input_device.h
)

# artus_include_path(FILE RESULT): under which name `echo/display/renderer.h` is included.
set(names ${ARTUS_PUBLIC_HEADERS})
while(names)
  list(POP_FRONT names name file)
  set(ARTUS_PUBLIC_NAME_${file} ${name})
endwhile()
function(artus_include_path file result)
  if(DEFINED ARTUS_PUBLIC_NAME_${file})
    set(${result} "artus/${ARTUS_PUBLIC_NAME_${file}}" PARENT_SCOPE)
  else()
    set(${result} "artus/detail/${file}" PARENT_SCOPE)
  endif()
endfunction()

# Headers are included by these names in the tree as outside of it: links under one include directory stand for the
# installed ones, a file each for what is public, folders for the rest.
set(ARTUS_INCLUDE_DIR ${PROJECT_BINARY_DIR}/include)
foreach(folder IN LISTS ARTUS_FOLDERS)
  if(EXISTS ${PROJECT_SOURCE_DIR}/${folder})
    file(MAKE_DIRECTORY ${ARTUS_INCLUDE_DIR}/artus/detail)
    file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${folder} ${ARTUS_INCLUDE_DIR}/artus/detail/${folder} SYMBOLIC)
  endif()
endforeach()
set(names ${ARTUS_PUBLIC_HEADERS})
while(names)
  list(POP_FRONT names name file)
  get_filename_component(folder ${ARTUS_INCLUDE_DIR}/artus/${name} DIRECTORY)
  file(MAKE_DIRECTORY ${folder})
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${file} ${ARTUS_INCLUDE_DIR}/artus/${name} SYMBOLIC)
endwhile()

# All headers that public ones include, at any remove, by the names of the include directory: what is installed.
function(artus_needed_headers result)
  set(known)
  set(open)
  set(names ${ARTUS_PUBLIC_HEADERS})
  while(names)
    list(POP_FRONT names name file)
    list(APPEND open artus/${name})
  endwhile()
  while(open)
    list(POP_FRONT open header)
    if(header IN_LIST known)
      continue()
    endif()
    list(APPEND known ${header})
    file(STRINGS ${ARTUS_INCLUDE_DIR}/${header} lines REGEX "^#include \"")
    foreach(line IN LISTS lines)
      string(REGEX REPLACE "^#include \"([^\"]*).*" "\\1" included "${line}")
      if(included MATCHES "^artus/")
        list(APPEND open ${included})
      endif()
    endforeach()
  endwhile()
  set(${result} ${known} PARENT_SCOPE)
endfunction()
artus_needed_headers(ARTUS_INSTALLED_HEADERS)
