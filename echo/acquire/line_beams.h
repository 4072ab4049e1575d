// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "artus/detail/echo/acquire/beam_shape.h"
#include "artus/detail/echo/acquire/propagation.h"
#include "artus/detail/echo/probe/placed_line.h"

namespace artus {

/// The beams of one scanline after the other: that of the middle plane and those of the planes
/// beside it. Only some lines of a row are followed in all planes; a plane of a line between two
/// of those is blended of theirs, and followed where they met something else. In tissue that gives
/// way lines near each other are guided by one of them. Room that is used again from row to row.
class LineBeams {
 public:
  /// Forgets the lines before: of another scene, or not beside the next ones.
  void begin_row(int n_planes);

  /// Goes on to line `l` of a row of neighbours, whose lines come in order. Requires: begin_row;
  /// all four stay as they are until the next line.
  void go_to(const BeamTracer& tracer, const BeamShape& shape, std::span<const PlacedLine> row,
             std::size_t l);

  /// The line's beam in the middle plane, and its path.
  [[nodiscard]] const BeamTrace& central() const noexcept { return *now_->central; }
  [[nodiscard]] const BeamPath& path() const noexcept { return *now_->path; }
  /// Its beam in elevation plane `p`, which hears scatterers; valid until the next two are asked
  /// for. Requires: BeamShape::hears_speckle(p).
  [[nodiscard]] const BeamTrace& plane(int p);

 private:
  static constexpr int kNoLine = -1;
  struct Guide {
    int line = kNoLine;
    BeamTrace trace;
    BeamPath path;
  };
  struct Line {
    int line = kNoLine;
    const BeamTrace* central = nullptr;  // `own`, or a guide's
    const BeamPath* path = nullptr;
    BeamTrace own;
    BeamPath own_path;
    std::vector<BeamTrace> sides;  // (n_planes), followed lines alone
  };
  void follow(std::size_t l, Line& line, const Line* like);
  void follow_middle(std::size_t l, Line& line, const BeamTrace* like);
  void follow_side(int p, const Line& line, BeamTrace& trace, const BeamTrace* like) noexcept;
  [[nodiscard]] std::size_t followed(std::size_t k) const noexcept;

  const BeamTracer* tracer_ = nullptr;
  const BeamShape* shape_ = nullptr;
  std::span<const PlacedLine> row_;
  std::size_t at_ = 0;        // of the row
  std::size_t n_beside_ = 0;  // lines on either side of one that it guides
  std::size_t n_parts_ = 0;   // of the row, between lines that are followed
  int n_planes_ = 0;
  double share_ = 0;  // of the way from the line followed before to the next one
  std::array<Guide, 2> guides_;
  std::array<Line, 2> followed_;
  Line between_;
  const Line* now_ = nullptr;
  const Line* before_ = nullptr;
  const Line* behind_ = nullptr;
  BeamPath plane_;
  std::array<BeamTrace, 2> sides_;  // of a line between, one after the other
  std::size_t next_side_ = 0;
};

}  // namespace artus
