// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/panels/panel_layout.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "artus/detail/core/text_file.h"

namespace artus {
namespace {

constexpr std::array<std::string_view, kPanels> kNames{"guide",   "picture", "joint", "scanner",
                                                       "session", "tissues", "force", "rates"};
constexpr float kLine = 17;                // pixels at scale 1
constexpr float kNarrowGuideHeight = 100;  // the same: four lines that wrap and buttons below

/// Two lines where they fit side by side with a message, three where they wrap.
float guide_height(const WindowShape& shape) noexcept {
  if (is_narrow(shape)) return kNarrowGuideHeight;
  return 16 + kLine * (static_cast<float>(shape.width) < 1250 * shape.scale ? 3 : 2);
}

PanelPlace& of(std::array<PanelPlace, kPanels>& places, Panel panel) {
  return places[static_cast<std::size_t>(panel)];
}

}  // namespace

std::string_view name_of(Panel panel) noexcept {
  return kNames[static_cast<std::size_t>(panel)];
}

bool is_narrow(const WindowShape& shape) noexcept {
  return static_cast<float>(shape.width) < 1000 * shape.scale ||
         static_cast<float>(shape.height) < 560 * shape.scale;
}

std::array<PanelPlace, kPanels> usual_places(const WindowShape& shape, Panel chosen) noexcept {
  std::array<PanelPlace, kPanels> places{};
  const float top = std::min(
      0.35F, guide_height(shape) * shape.scale / static_cast<float>(std::max(shape.height, 1)));
  const float rest = 1 - top;
  of(places, Panel::guide) = {0, 0, 1, top};
  if (is_narrow(shape)) {
    of(places, Panel::picture) = {0, top, 0.58F, rest};
    if (shape.expert && chosen == Panel::joint) chosen = Panel::scanner;
    of(places, chosen) = {0.58F, top, 0.42F, rest};
    return places;
  }
  const float upper = 0.66F * rest;
  const float scanner = 0.575F * rest;
  of(places, Panel::scanner) = {0.77F, top, 0.23F, scanner};
  of(places, Panel::session) = {0.77F, top + scanner, 0.23F, rest - scanner};
  if (shape.expert) {
    of(places, Panel::picture) = {0, top, 0.50F, rest};
    of(places, Panel::force) = {0.50F, top, 0.27F, 0.55F * rest};
    of(places, Panel::rates) = {0.50F, top + 0.55F * rest, 0.27F, 0.45F * rest};
    return places;
  }
  of(places, Panel::joint) = {0, top, 0.37F, upper};
  of(places, Panel::picture) = {0.37F, top, 0.40F, upper};
  of(places, Panel::force) = {0, top + upper, 0.59F, rest - upper};
  of(places, Panel::tissues) = {0.59F, top + upper, 0.18F, rest - upper};
  return places;
}

void PanelLayout::set_shape(const WindowShape& shape) {
  if (shape == shape_) return;
  shape_ = shape;
  if (shape_.expert && chosen_ == Panel::joint) chosen_ = Panel::scanner;
  ++version_;
}

void PanelLayout::choose(Panel panel) {
  if (panel == chosen_) return;
  chosen_ = panel;
  ++version_;
}

void PanelLayout::choose_next() {
  auto next = static_cast<std::size_t>(chosen_) + 1;
  if (next >= kPanels) next = static_cast<std::size_t>(Panel::joint);
  if (shape_.expert && next == static_cast<std::size_t>(Panel::joint)) ++next;
  choose(static_cast<Panel>(next));
}

PanelPlace PanelLayout::place(Panel panel) const {
  const PanelPlace usual = usual_places(shape_, chosen_)[static_cast<std::size_t>(panel)];
  const auto moved = moved_.find(panel);
  const bool own = !narrow() && !shape_.expert && usual.width > 0 && moved != moved_.end();
  return own ? moved->second : usual;
}

void PanelLayout::move(Panel panel, PanelPlace place) {
  if (narrow() || shape_.expert) return;
  place.width = std::clamp(place.width, 0.05F, 1.F);
  place.height = std::clamp(place.height, 0.05F, 1.F);
  place.x = std::clamp(place.x, 0.F, 1 - place.width);
  place.y = std::clamp(place.y, 0.F, 1 - place.height);
  moved_[panel] = place;
}

void PanelLayout::put_back() {
  moved_.clear();
  ++version_;
}

void PanelLayout::read(const std::filesystem::path& file) {
  std::ifstream in(file);
  in.imbue(std::locale::classic());
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    words.imbue(std::locale::classic());
    std::string name;
    PanelPlace place;
    if (!(words >> name >> place.x >> place.y >> place.width >> place.height)) continue;
    const auto* const known = std::find(kNames.begin(), kNames.end(), name);
    if (known == kNames.end()) continue;
    move(static_cast<Panel>(known - kNames.begin()), place);
  }
  ++version_;
}

Result<void> PanelLayout::write(const std::filesystem::path& file) const {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  for (const auto& [panel, p] : moved_)
    out << name_of(panel) << ' ' << p.x << ' ' << p.y << ' ' << p.width << ' ' << p.height << '\n';
  return write_text(file, out.str());
}

}  // namespace artus
