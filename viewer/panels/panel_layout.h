// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "artus/core/result.h"

namespace artus {

enum class Panel { guide, picture, joint, scanner, session, tissues, force, rates, n_panels };
inline constexpr auto kPanels = static_cast<std::size_t>(Panel::n_panels);
[[nodiscard]] std::string_view name_of(Panel panel) noexcept;

/// A panel's place as shares of the window.
struct PanelPlace {
  float x = 0;
  float y = 0;
  float width = 0;  ///< 0: not shown
  float height = 0;
  friend bool operator==(const PanelPlace&, const PanelPlace&) = default;
};

/// What decides where panels stand.
struct WindowShape {
  int width = 1280;  ///< pixels
  int height = 720;  ///< pixels
  float scale = 1;   ///< of letters, 1: 13 pixels
  bool expert = false;
  friend bool operator==(const WindowShape&, const WindowShape&) = default;
};

/// A window too small for its letters: the picture and one other panel are shown.
[[nodiscard]] bool is_narrow(const WindowShape& shape) noexcept;

/// Where each panel stands before a person moves it: all of the window is covered, nothing
/// overlaps. `chosen`: the panel beside the picture of a narrow window.
[[nodiscard]] std::array<PanelPlace, kPanels> usual_places(const WindowShape& shape,
                                                           Panel chosen) noexcept;

/// The panels' places with what a person changed.
class PanelLayout {
 public:
  static constexpr float kGuideShare = 0.62F;  ///< of its width that the task has; beside: messages

  /// Called once a picture. Places are taken anew when the shape changed.
  void set_shape(const WindowShape& shape);
  void choose(Panel panel);
  /// The next panel beside the picture of a narrow window.
  void choose_next();
  [[nodiscard]] Panel chosen() const noexcept { return chosen_; }
  [[nodiscard]] bool narrow() const noexcept { return is_narrow(shape_); }
  [[nodiscard]] PanelPlace place(Panel panel) const;
  /// Grows whenever places were taken anew, and the panels must be put there.
  [[nodiscard]] int version() const noexcept { return version_; }
  /// A person moved a panel; it stays within the window.
  void move(Panel panel, PanelPlace place);
  /// Forgets what people moved.
  void put_back();

  /// Lines "panel x y width height". A file that is not there or not readable is the usual layout.
  void read(const std::filesystem::path& file);
  [[nodiscard]] Result<void> write(const std::filesystem::path& file) const;

 private:
  WindowShape shape_;
  Panel chosen_ = Panel::joint;
  std::map<Panel, PanelPlace> moved_;
  int version_ = 1;
};

}  // namespace artus
