// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>

#include "artus/detail/viewer/joint3d/colours.h"
#include "artus/detail/viewer/joint3d/joint_view.h"

namespace artus {

Eigen::Vector3f look_colour(const Rgb& colour) noexcept {
  const auto& [r, g, b] = colour;
  return Eigen::Vector3f(r, g, b) / 255.F;
}

// The body of the picture that begins, with a surface of what was injected.
void JointView::take_body(const BodyState& body) {
  body_ = body;
  sending_ = 0;
  if (body_.joint != injected_joint_) {
    injected_joint_ = body_.joint;
    injected_.clear();
    if (injected_joint_->regions.size() > joint_->regions.size()) show_injected();
  }
  places_ = places_in(*joint_, body_);
  injected_places_ = injected_.empty() ? VertexPlaces{} : places_in(*injected_joint_, body_);
  for (Part& part : parts_) part.making = part.centre + places_.displacement(part.nearest);
}

// Liquid in tissue is a region of its own, after those of the joint.
void JointView::show_injected() {
  const auto first = static_cast<RegionId>(joint_->regions.size());
  for (Sheet& sheet : find_sheets(*injected_joint_, first))
    injected_.push_back({std::move(sheet), true, {}});
  const auto known = std::find_if(parts_.begin(), parts_.end(),
                                  [](const Part& part) { return part.name.empty(); });
  const auto part = static_cast<std::size_t>(known - parts_.begin());
  if (known == parts_.end()) {
    looks_.push_back({"injected", look_colour(tissue_colour("fluid")), 1, true});
    parts_.push_back({looks_.size() - 1, {}});
  }
  part_of_.resize(injected_joint_->regions.size(), part);
}

const VertexPlaces& JointView::places_of(const DrawnSheet& sheet) const noexcept {
  return sheet.injected ? injected_places_ : places_;
}

// What the picture is going to show; meshes that are made later are made where they lie.
void JointView::move_to_body() {
  for (const Step& step : steps_) {
    std::unique_ptr<MovingMesh>& mesh = step.sheet->meshes[detail_.level()];
    if (mesh) sending_ += mesh->move(places_of(*step.sheet));
  }
}

const GlMesh& JointView::mesh_of(DrawnSheet& sheet) {
  std::unique_ptr<MovingMesh>& mesh = sheet.meshes[detail_.level()];
  if (!mesh) {
    mesh = std::make_unique<MovingMesh>(
        decimated(sheet.sheet.surface, DetailChooser::kCells[detail_.level()]));
    sending_ += mesh->move(places_of(sheet));
  }
  return mesh->mesh();
}

}  // namespace artus
