// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <atomic>
#include <cstdint>
#include <future>
#include <memory>
#include <mutex>
#include <vector>

#include "artus/detail/anatomy/body/space.h"
#include "artus/detail/soft/liquid/opened_space.h"

namespace artus {

/// The cavities among `spaces` (indices), those first that planned injections end next to, in the
/// order of the plan: where liquid is likely to come first. Cost: the interfaces, once an
/// injection.
[[nodiscard]] std::vector<std::uint32_t> order_by_plan(const CompiledJoint& joint,
                                                       const JointSpaces& spaces);

/// The spaces of a joint, each made ready once: when it is first asked for, or before that on a
/// thread of its own. Any number of threads.
class OpenedSpaces {
 public:
  /// `ahead`: begins to make all of them at once, one after another (order_by_plan). Requires: a
  /// joint whose spaces are valid. Cost: little; see OpenedSpace.
  explicit OpenedSpaces(std::shared_ptr<const CompiledJoint> joint, bool ahead = false);
  ~OpenedSpaces();
  OpenedSpaces(const OpenedSpaces&) = delete;
  OpenedSpaces& operator=(const OpenedSpaces&) = delete;
  OpenedSpaces(OpenedSpaces&&) = delete;
  OpenedSpaces& operator=(OpenedSpaces&&) = delete;

  /// The space that a region belongs to. Requires: one that has interfaces. Waits where it is being
  /// made.
  [[nodiscard]] const OpenedSpace& of(RegionId region) const;
  [[nodiscard]] const CompiledJoint& joint() const noexcept { return *joint_; }

 private:
  struct Entry {
    std::once_flag made;
    std::unique_ptr<const OpenedSpace> space;
  };
  [[nodiscard]] std::vector<RegionId> regions_of(std::size_t space) const;

  std::shared_ptr<const CompiledJoint> joint_;
  JointSpaces spaces_;
  std::vector<bool> there_;             // by region
  mutable std::vector<Entry> entries_;  // by space
  std::atomic<bool> stop_ = false;
  std::future<void> ahead_;
};

}  // namespace artus
