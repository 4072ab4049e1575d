// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
// The few calls that differ between Embree 3 and 4; ARTUS_EMBREE_MAJOR comes from the build.
#if ARTUS_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace artus {

#if ARTUS_EMBREE_MAJOR >= 4
using EmbreeContext = RTCRayQueryContext;

inline void init_context(EmbreeContext& context) noexcept {
  rtcInitRayQueryContext(&context);
}

inline void find_occluded(RTCScene scene, EmbreeContext& context, RTCRay& ray) noexcept {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &context;
  rtcOccluded1(scene, &ray, &arguments);
}

inline void find_intersection(RTCScene scene, EmbreeContext& context, RTCRayHit& ray) noexcept {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context;
  rtcIntersect1(scene, &ray, &arguments);
}
#else
using EmbreeContext = RTCIntersectContext;

inline void init_context(EmbreeContext& context) noexcept {
  rtcInitIntersectContext(&context);
}

inline void find_occluded(RTCScene scene, EmbreeContext& context, RTCRay& ray) noexcept {
  rtcOccluded1(scene, &context, &ray);
}

inline void find_intersection(RTCScene scene, EmbreeContext& context, RTCRayHit& ray) noexcept {
  rtcIntersect1(scene, &context, &ray);
}
#endif

}  // namespace artus
