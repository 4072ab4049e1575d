// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/solver/soft_block.h"

#include <cmath>

namespace artus {
namespace {

constexpr double kEdge = 1e-9;  // m

}  // namespace

SoftMaterial linear_material(double youngs_modulus, double poisson_ratio) {
  SoftMaterial m;
  m.shear = youngs_modulus / (2 * (1 + poisson_ratio));
  m.bulk = lame_lambda(m.shear, poisson_ratio);
  return m;
}

double thickness_of(const SoftBlock& block) {
  double sum = 0;
  for (const SoftLayer& layer : block.layers) sum += layer.thickness;
  return sum;
}

MaterialField make_field(const SoftBlock& block) {
  MaterialField field;
  for (const SoftLayer& layer : block.layers) field.materials.push_back(layer.material);
  field.at = [block, total = thickness_of(block)](const Vec3& p) {
    const double low = block.quarter ? 0 : -1;
    if (p.z() < 0 || p.z() > total + kEdge || std::abs(p.x()) > block.half_x + kEdge ||
        std::abs(p.y()) > block.half_y + kEdge || p.x() < low * block.half_x - kEdge ||
        p.y() < low * block.half_y - kEdge)
      return kNoMaterial;
    double depth = 0;
    for (std::size_t k = 0; k < block.layers.size(); ++k) {
      depth += block.layers[k].thickness;
      if (p.z() < depth) return static_cast<int>(k);
    }
    return static_cast<int>(block.layers.size()) - 1;
  };
  return field;
}

std::shared_ptr<const SoftModel> make_block_model(const SoftBlock& block, double cell,
                                                  std::vector<CageZone> zones) {
  SoftModelParams params;
  const double low = block.quarter ? 0 : -1;
  params.cage.low = Vec3(low * block.half_x, low * block.half_y, 0);
  params.cage.high = Vec3(block.half_x, block.half_y, thickness_of(block));
  params.cage.cell = cell;
  params.cage.zones = std::move(zones);
  params.held = [block, total = thickness_of(block)](const Vec3& p) {
    HeldNode node;
    const bool wall = block.walls && (std::abs(p.x()) > block.half_x - kEdge ||
                                      std::abs(p.y()) > block.half_y - kEdge);
    if (p.z() > total - kEdge || wall) node.held = {true, true, true};
    if (block.quarter && std::abs(p.x()) < kEdge) node.held[0] = true;
    if (block.quarter && std::abs(p.y()) < kEdge) node.held[1] = true;
    return node;
  };
  return std::make_shared<const SoftModel>(make_field(block), params);
}

SkinPatch make_flat_skin(const SoftBlock& block, double spacing) {
  SkinPatch skin;
  const double low_x = block.quarter ? 0 : -block.half_x;
  const double low_y = block.quarter ? 0 : -block.half_y;
  const int nx = static_cast<int>(std::lround((block.half_x - low_x) / spacing));
  const int ny = static_cast<int>(std::lround((block.half_y - low_y) / spacing));
  for (int j = 0; j <= ny; ++j) {
    for (int i = 0; i <= nx; ++i)
      skin.vertices.emplace_back(low_x + (block.half_x - low_x) * i / nx,
                                 low_y + (block.half_y - low_y) * j / ny, 0);
  }
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      const auto a = static_cast<std::uint32_t>(i + (nx + 1) * j);
      const auto up = static_cast<std::uint32_t>(nx + 1);
      skin.triangles.push_back({a, a + up, a + 1});
      skin.triangles.push_back({a + 1, a + up, a + up + 1});
    }
  }
  return skin;
}

std::vector<double> layer_thicknesses(const SoftBlock& block, const SoftModel& model,
                                      std::span<const Vec3> u, double x, double y) {
  std::vector<double> result;
  double depth = 0;
  const auto at = [&](double z) {
    return z + model.displacement_at(model.cage().locate({x, y, z}, 1), u).z();
  };
  for (const SoftLayer& layer : block.layers) {
    result.push_back(at(depth + layer.thickness) - at(depth));
    depth += layer.thickness;
  }
  return result;
}

}  // namespace artus
