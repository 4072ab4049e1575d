# SPDX-License-Identifier: AGPL-3.0-or-later
# The headers that programs include: PUBLIC NAME and the file that it is. They stand under artus/; all others are
# artus/detail/ and their folder, and are installed only where one of these needs them. At most 30.
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
