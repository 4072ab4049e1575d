// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "artus/anatomy/compiled_joint.h"
#include "artus/core/geometry.h"

struct RTCDeviceTy;
struct RTCSceneTy;

namespace artus::bench {

/// The least Embree can do for an all-hits query: one robust occlusion ray whose filter notes
/// depth and primitive. Nothing is sorted, paired or refined.
class BareEmbree {
 public:
  struct Hits {
    std::array<float, 256> depths;
    std::array<std::uint32_t, 256> primitives;
    std::size_t size;
  };

  explicit BareEmbree(const CompiledJoint& joint);
  ~BareEmbree();
  BareEmbree(const BareEmbree&) = delete;
  BareEmbree& operator=(const BareEmbree&) = delete;
  void all_hits(const Segment& segment, Hits& out) const noexcept;

 private:
  Vec3 centre_ = Vec3::Zero();
  RTCDeviceTy* device_ = nullptr;
  RTCSceneTy* scene_ = nullptr;
};

}  // namespace artus::bench
