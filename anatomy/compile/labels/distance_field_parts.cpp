// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <numeric>

#include "artus/detail/anatomy/compile/labels/distance_field.h"
#include "artus/detail/anatomy/compile/labels/distance_field_blocks.h"
#include "artus/detail/anatomy/surfaces/vertex_sets.h"

namespace artus {
namespace {

using namespace field_blocks;  // NOLINT(google-build-using-namespace): the layout of a block

constexpr std::uint32_t kNone = 0xffffffffU;

/// Numbers the connected parts of a block's negative samples from `next` on.
void label_block(const float* samples, std::uint32_t* label, std::uint32_t& next) {
  constexpr std::array<int, 3> kStrides{1, kRow, kPlane};
  std::vector<int> stack;
  for (int start = 0; start < kBlock; ++start) {
    if (!(samples[start] < 0) || label[start] != kNone) continue;
    stack.push_back(start);
    label[start] = next;
    while (!stack.empty()) {
      const int i = stack.back();
      stack.pop_back();
      for (const int stride : kStrides) {
        const int along = i / stride % kSide;
        for (const int side : {-1, 1}) {
          if (along + side < 0 || along + side >= kSide) continue;
          const int j = i + side * stride;
          if (!(samples[j] < 0) || label[j] != kNone) continue;
          label[j] = next;
          stack.push_back(j);
        }
      }
    }
    ++next;
  }
}

/// The samples of the face of a block that looks along `axis`, and of the one across it.
template <class Visit>
void for_each_face_sample(std::size_t axis, Visit&& visit) {
  constexpr std::array<int, 3> kStrides{1, kRow, kPlane};
  const int across = kCells * kStrides[axis];
  const int u = kStrides[(axis + 1) % 3];
  const int v = kStrides[(axis + 2) % 3];
  for (int i = 0; i < kSide; ++i)
    for (int j = 0; j < kSide; ++j) visit(across + i * u + j * v, i * u + j * v);
}

}  // namespace

/// Parts of the inside: one label for each sample of the stored blocks and each wholly inner block.
struct DistanceField::Parts {
  std::vector<std::uint32_t> of_sample;  // (n_slots, 9, 9, 9), kNone outside
  std::vector<std::uint32_t> of_block;   // (nx, ny, nz), kNone unless wholly inside
  std::uint32_t n = 0;
  std::optional<VertexSets> joined;

  explicit Parts(const DistanceField& field)
      : of_sample(field.samples_.size(), kNone), of_block(field.slots_.size(), kNone) {
    for (std::size_t at = 0; at < field.samples_.size(); at += kBlock)
      label_block(&field.samples_[at], &of_sample[at], n);
    for (std::size_t b = 0; b < of_block.size(); ++b)
      if (field.slots_[b] == kIn) of_block[b] = n++;
    joined.emplace(n);
    const std::array<int, 3>& size = field.blocks_;
    const std::array<std::size_t, 3> strides{
        1, static_cast<std::size_t>(size[0]),
        static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1])};
    for (std::size_t b = 0; b < of_block.size(); ++b)
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (b / strides[axis] % static_cast<std::size_t>(size[axis]) + 1 <
            static_cast<std::size_t>(size[axis]))
          join(field, b, b + strides[axis], axis);
  }

  [[nodiscard]] std::uint32_t label(const DistanceField& field, std::size_t block,
                                    int sample) const {
    const std::int32_t slot = field.slots_[block];
    if (slot < 0) return of_block[block];
    return of_sample[static_cast<std::size_t>(slot) * kBlock + static_cast<std::size_t>(sample)];
  }

  void join(const DistanceField& field, std::size_t a, std::size_t b, std::size_t axis) {
    if (field.slots_[a] == kOut || field.slots_[b] == kOut) return;
    for_each_face_sample(axis, [&](int of_a, int of_b) {
      const std::uint32_t la = label(field, a, of_a);
      const std::uint32_t lb = label(field, b, of_b);
      if (la != kNone && lb != kNone) joined->union_set(la, lb);
    });
  }
};

std::vector<FieldPart> DistanceField::keep_largest_part() {
  Parts labels(*this);
  struct Sum {
    std::size_t n = 0;
    Vec3 position = Vec3::Zero();
  };
  std::vector<Sum> sums(labels.n);
  for (std::size_t block = 0; block < slots_.size(); ++block) {
    if (slots_[block] == kOut) continue;
    const Vec3 corner = block_corner(block);
    for (int i = 0; i < kCells * kCells * kCells; ++i) {  // rims are shared: each counts once
      const std::array<int, 3> at{i % kCells, i / kCells % kCells, i / (kCells * kCells)};
      const std::uint32_t label = labels.label(*this, block, at[0] + kRow * at[1] + kPlane * at[2]);
      if (label == kNone) continue;
      Sum& sum = sums[labels.joined->find_set(label)];
      ++sum.n;
      sum.position += corner + spacing_ * Vec3(at[0], at[1], at[2]);
    }
  }
  std::vector<std::uint32_t> order(labels.n);
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return sums[a].n > sums[b].n; });
  std::vector<FieldPart> parts;
  for (const std::uint32_t i : order) {
    if (sums[i].n == 0) break;
    const auto n = static_cast<double>(sums[i].n);
    parts.push_back({n * spacing_ * spacing_ * spacing_, sums[i].position / n});
  }
  if (order.empty()) return parts;
  const auto is_dropped = [&](std::uint32_t label) {
    return label != kNone && labels.joined->find_set(label) != order.front();
  };
  for (std::size_t i = 0; i < samples_.size(); ++i)
    if (is_dropped(labels.of_sample[i])) samples_[i] = -samples_[i];
  for (std::size_t b = 0; b < slots_.size(); ++b)
    if (is_dropped(labels.of_block[b])) slots_[b] = kOut;
  return parts;
}

}  // namespace artus
