// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/simulation/fluid_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "artus/detail/core/check.h"
#include "artus/detail/haptics/plunger/space_pressure.h"
#include "artus/detail/soft/liquid/injected_body.h"
#include "artus/detail/soft/liquid/kept_volume.h"
#include "artus/detail/soft/liquid/overflow.h"

namespace artus {
namespace {

constexpr double kShapeTime = 0.06;  // s that the first shape may take: a flow is seen at once
constexpr double kGrowthTime = 0.3;  // s that a later one may: images need not wait for it
constexpr double kVisible = 1e-9;    // m^3, of a shape's first liquid and least growth
constexpr double kLeastKept = 0.8;   // of a volume, by a press; less is not made up for
constexpr double kNearlyMost = 0.999;
constexpr double kMissed = 5e-3;         // of a volume, by which a shape may be wrong
constexpr int kMostInARow = 4;           // shapes for that, one after the other
constexpr std::uint64_t kLater = 10;     // times what a shape takes, until it is asked again then
constexpr double kStill = 1e-12;         // m^3 from image to image, of liquid that rests
constexpr double kGrowth = 0.03;         // of what is there: 0.1 mm of a bursa that is 10 mm open
constexpr double kPressForce = 0.05;     // N by which a press is another
constexpr double kPressGrowth = 0.1;     // of the force
constexpr double kPressDistance = 1e-3;  // m of its middle
constexpr double kPressTurn = 0.04;      // rad
constexpr double kNewest = 0.25;         // share of the press as it is now in what shapes a space;
                                         // fitted: followed at once, press and shape go to and fro
constexpr double kForgotten = 0.05;      // least share of one

/// Whether the region is anywhere in the body; a recording may name one that a gap left empty.
bool is_there(const CompiledJoint& joint, std::uint32_t region) {
  const auto& all = joint.mesh.interfaces;
  return region < joint.regions.size() &&
         std::any_of(all.begin(), all.end(),
                     [&](const Interface& f) { return f.front == region || f.back == region; });
}

JointSpaces spaces_of(const CompiledJoint& joint) {
  auto spaces = make_joint_spaces(joint);
  ARTUS_REQUIRE(spaces.has_value(), "the joint's spaces must be valid");
  return std::move(*spaces);
}

/// With the index of the body or of the shape before, where it has the surfaces of one of them.
std::shared_ptr<const BodyMap> map_of(const CompiledJoint& shape, const DeformedBody& tissue,
                                      const FluidShape* before) {
  std::vector<MappedJoint> others{tissue.mapped()};
  if (before != nullptr && before->map && before->map->model == tissue.map().model)
    others.push_back({before->joint, before->map});
  return make_body_map(shape, others);
}

double volume_of(const std::vector<Injected>& places) {
  double volume = 0;
  for (const Injected& place : places) volume += place.volume;
  return volume;
}

/// Times what was given that a shape is to be opened by, where tissue keeps this share of it.
double more_for(double kept) {
  return 1 / std::max(kLeastKept, kept);
}

/// `places`: all opened by the same times what was given.
MadeShape make_shape(const OpenedSpaces& opened, const std::vector<Injected>& places,
                     const Liquid& liquid, const std::shared_ptr<const DeformedBody>& tissue,
                     std::vector<PastContact> contacts, const FluidShape* before) {
  FluidShape shape;
  shape.liquid.given = volume_of(places);
  shape.liquid.left_out = shape.liquid.given - volume_of(with_overflow(opened, places));
  StressAt stress;
  const bool pressed = std::any_of(contacts.begin(), contacts.end(), [](const PastContact& past) {
    return !past.contact.pieces.empty();
  });
  if (tissue && pressed) stress = FaceStress(tissue, std::move(contacts));
  shape.joint = std::make_shared<const CompiledJoint>(
      with_injected(opened.joint(), places, liquid, stress, opened));
  if (!tissue) {
    shape.scene = std::make_shared<const Scene>(shape.joint);
    return {std::make_shared<const FluidShape>(std::move(shape)), 1, true};
  }
  if (!places.empty()) shape.made = places.front().more;
  const double kept = kept_volume(*shape.joint, opened.joint(), *tissue);
  // What a press drives out is elsewhere in the space.
  if (shape.made >= kNearlyMost / kLeastKept)
    shape.liquid.left_out +=
        std::max(0.0, 1 - kept * shape.made) * (shape.liquid.given - shape.liquid.left_out);
  shape.map = map_of(*shape.joint, *tissue, before);
  return {std::make_shared<const FluidShape>(std::move(shape)), more_for(kept), false};
}

}  // namespace

std::vector<Injected> injected_of(const CompiledJoint& joint, const JointSpaces& spaces,
                                  std::span<const InjectedSite> sites) {
  std::vector<Injected> injected;
  for (const InjectedSite& site : sites)
    if (is_there(joint, site.region))
      injected.push_back(
          {joint.regions[site.region].name, site.volume, site.cavity != 0,
           Vec3(site.p_J[0], site.p_J[1], site.p_J[2]),
           pressure_of(spaces.spaces[spaces.of_region[site.region]].law, site.volume)});
  return injected;
}

FluidShapes::FluidShapes(std::shared_ptr<const CompiledJoint> joint, Liquid liquid,
                         double image_rate, std::shared_ptr<const OpenedSpaces> opened)
    : joint_(std::move(joint)), opened_(std::move(opened)), liquid_(std::move(liquid)) {
  ARTUS_REQUIRE(joint_ != nullptr && image_rate > 0, "needs a joint and an image rate above 0");
  ARTUS_REQUIRE(!opened_ || &opened_->joint() == joint_.get(), "spaces of this joint");
  spaces_ = spaces_of(*joint_);
  if (!opened_) opened_ = std::make_shared<const OpenedSpaces>(joint_, true);
  images_to_change_ = static_cast<std::uint64_t>(std::ceil(kShapeTime * image_rate));
  images_to_grow_ =
      static_cast<std::uint64_t>(kGrowthTime / kShapeTime * static_cast<double>(images_to_change_));
}

FluidShapes::Press FluidShapes::press_of(std::span<const PastContact> contacts) {
  Press press;
  Vec3 moment = Vec3::Zero();
  for (const auto& [share, contact] : contacts)
    for (const PressingPiece& piece : contact.pieces) {
      press.force += share * piece.force;
      moment += share * piece.force * piece.p;
    }
  if (!contacts.empty()) press.into = contacts.front().contact.into;
  if (press.force > 0) press.middle = moment / press.force;
  return press;
}

/// The newest comes to those before, whose shares shrink.
void FluidShapes::remember(const ContactForce& contact) {
  double sum = kNewest;
  for (PastContact& past : contacts_) {
    past.share *= 1 - kNewest;
    if (past.share >= kForgotten) sum += past.share;
  }
  std::erase_if(contacts_, [](const PastContact& past) { return past.share < kForgotten; });
  contacts_.insert(contacts_.begin(), {kNewest, contact});
  for (PastContact& past : contacts_) past.share /= sum;
}

bool FluidShapes::has_changed(std::span<const InjectedSite> sites, const Press& press) const {
  bool cavity = false;
  for (std::size_t k = 0; k < sites.size(); ++k) {
    const double before = k < begun_.size() ? begun_[k].volume : 0;
    if (std::abs(sites[k].volume - before) >= std::max(kVisible, kGrowth * before)) return true;
    cavity = cavity || (sites[k].cavity != 0 && sites[k].volume >= kVisible);
  }
  if (!cavity) return false;
  const double most = std::max(press.force, begun_under_.force);
  if (most < kPressForce) return false;
  return std::abs(press.force - begun_under_.force) > std::max(kPressForce, kPressGrowth * most) ||
         (press.middle - begun_under_.middle).norm() > kPressDistance ||
         (press.into - begun_under_.into).norm() > kPressTurn;
}

/// Whether no liquid came since the image before, and the newest shape does not have all of it.
bool FluidShapes::is_at_rest(std::span<const InjectedSite> sites) const {
  const auto differ = [](std::span<const InjectedSite> a, std::span<const InjectedSite> b,
                         double by) {
    if (a.size() != b.size()) return true;
    for (std::size_t k = 0; k < a.size(); ++k)
      if (std::abs(a[k].volume - b[k].volume) >= by) return true;
    return false;
  };
  return !differ(sites, seen_, kStill) && differ(sites, begun_, kVisible);
}

/// Another shape of the same vertices is gone over into; what has others is there at once.
void FluidShapes::take() {
  const std::shared_ptr<const FluidShape> before = std::move(state_.shape);
  const MadeShape made = next_.get();
  state_ = {made.shape, nullptr, 1, made.kept};
  more_ = made.more;
  taken_ = images_;
  if (made.shape == before) {
    made_up_ = 0;
    return;
  }
  const bool alike =
      before && before->map && made.shape->map &&
      before->joint->mesh.vertices.size() == made.shape->joint->mesh.vertices.size() &&
      before->joint->regions.size() == made.shape->joint->regions.size();
  if (alike) state_.before = before;
}

const FluidState& FluidShapes::step(std::span<const InjectedSite> sites) {
  ++images_;
  if (sites.empty()) {  // a new syringe, and a body that nothing was put into
    if (next_.valid()) next_.get();
    begun_.clear();
    contacts_.clear();
    state_ = {};
    return state_;
  }
  if (next_.valid() && images_ >= due_) take();
  if (state_.before) {
    state_.part = static_cast<double>(images_ - taken_ + 1) / static_cast<double>(images_to_grow_);
    if (state_.part >= 1) state_ = {state_.shape, nullptr, 1, state_.kept};
  }
  return state_;
}

void FluidShapes::follow(std::span<const InjectedSite> sites,
                         const std::shared_ptr<const DeformedBody>& tissue) {
  Press press;
  if (tissue) press = press_of(std::array{PastContact{1, tissue->contact()}});
  const bool changed = is_at_rest(sites) || has_changed(sites, press);
  seen_.assign(sites.begin(), sites.end());
  if (sites.empty() || next_.valid()) return;
  const bool asked = tissue && state_.shape && !state_.before && images_ >= asked_ &&
                     (!state_.kept || tissue != asked_in_);
  if (changed || asked) begin(tissue, changed);
}

/// A shape of all that there is now; where nothing but tissue has changed, only if that takes some
/// of the present one.
void FluidShapes::begin(const std::shared_ptr<const DeformedBody>& tissue, bool changed) {
  made_up_ = changed ? 0 : made_up_ + 1;
  due_ = images_ + (begun_.empty() ? images_to_change_ : images_to_grow_);
  asked_ = due_ + (made_up_ < kMostInARow ? 0 : kLater * images_to_grow_);
  asked_in_ = tissue;
  if (changed) {
    begun_ = seen_;
    if (tissue) remember(tissue->contact());
    begun_under_ = press_of(contacts_);
  }
  next_ =
      std::async(std::launch::async,
                 [opened = opened_, liquid = liquid_, tissue, contacts = contacts_,
                  before = state_.shape, more = more_,
                  places = injected_of(*joint_, spaces_, begun_), changed]() mutable -> MadeShape {
                   double now = tissue && before ? more : 1;
                   if (!changed) {
                     now = more_for(kept_volume(*before->joint, opened->joint(), *tissue));
                     if (std::abs(now / before->made - 1) < kMissed) return {before, now, true};
                   }
                   for (Injected& place : places) place.more = now;
                   return make_shape(*opened, places, liquid, tissue, contacts, before.get());
                 });
}

}  // namespace artus
