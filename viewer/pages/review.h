// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "artus/detail/anatomy/outside/outside_body.h"
#include "artus/detail/simulation/records.h"
#include "artus/detail/viewer/pages/page.h"

namespace artus {

/// A moment of an attempt: what the hands felt, and the picture that was on the screen.
struct ReviewMoment {
  double time = 0;  ///< s since the attempt began
  HapticSnapshot state;
  FrameInput picture;
};

/// An attempt as it is looked at again: moments in order of time.
struct ReviewFilm {
  std::vector<ReviewMoment> moments;

  [[nodiscard]] double length() const noexcept {  ///< s
    return moments.empty() ? 0 : moments.back().time;
  }
  /// The last moment at or before a time, or the first. Requires: there is one.
  [[nodiscard]] const ReviewMoment& at(double time) const noexcept;
  /// s, when the needle first went in; 0 when it never did.
  [[nodiscard]] double contact() const noexcept;
};

/// A fault to jump to.
struct ReviewFault {
  double time = 0;  ///< s since the attempt began
  std::string what;
  std::string cause;
  std::string mend;
};

/// What is looked at.
struct Review {
  std::string title;
  std::shared_ptr<const Scene> scene;
  SessionParams params;
  std::shared_ptr<const OutsideBody> outside;  ///< the person around the joint; null: none
  ReviewFilm film;
  std::optional<ReviewFilm> expert;  ///< shown beside, from the moment at which its needle went in
  std::vector<ReviewFault> faults;   ///< in any order
  std::optional<Vec3> target_J;
  bool in_plane = true;    ///< the needle is meant to lie in the picture
  bool of_expert = false;  ///< the film is not one's own
  std::function<std::string(const HapticSnapshot&)> why;  ///< what the truth says of the tip
};

/// Where one stands in a film.
class ReviewCursor {
 public:
  /// `faults`: s.
  ReviewCursor(double length, std::vector<double> faults);
  [[nodiscard]] double time() const noexcept { return time_; }  ///< s
  [[nodiscard]] bool playing() const noexcept { return playing_; }
  void play(bool playing) noexcept;
  void go_to(double time) noexcept;
  /// Time passes; stops at the end.
  void pass(double seconds) noexcept;
  /// To the next fault, or the one before; nowhere when there is none.
  void later_fault() noexcept;
  void earlier_fault() noexcept;
  /// The fault that one stands at or is nearest to within 2 s; by its place among the given.
  [[nodiscard]] std::optional<std::size_t> near() const noexcept;

 private:
  double length_;
  std::vector<double> faults_;
  double time_ = 0;
  bool playing_ = false;
};

/// A probe set right: where the needle lies in its plane.
struct MendedProbe {
  Pose X_JP = Pose::Identity();
  double turned = 0;  ///< rad about the beam, signed
  double moved = 0;   ///< m along its elevation, signed
};
/// The probe turned about its beam and moved along its elevation until shaft and tip are in the
/// plane: at most 45 degrees, else empty (the needle was never meant to lie in it). The lift from a
/// curved skin is taken away. Requires: rigid poses. Cost: one query.
[[nodiscard]] std::optional<MendedProbe> mend_probe(const Scene& scene, const Pose& X_JP,
                                                    const Pose& X_JN);

/// Shows an attempt again until one goes back: picture, the joint's inside or the expert or the
/// same moment with the probe set right beside it, depth and forces on one line of time with the
/// faults on it. False: the window was closed. Errors: those of PageWindow::show, of JointView.
[[nodiscard]] Result<bool> run_review(Screen& screen, const PageOptions& options,
                                      const Review& review);

}  // namespace artus
