// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/exchange/landmark_registration.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include <Eigen/Eigenvalues>

#include "artus/detail/core/csv.h"
#include "artus/detail/core/known_names.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/text_cursor.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/text_lines.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

/// How far the points spread across the line that fits them best, m.
double spread_across_line(const Eigen::Matrix3Xd& points) {
  const Eigen::Matrix3Xd centred = points.colwise() - points.rowwise().mean();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> scatter(centred * centred.transpose(),
                                                               Eigen::EigenvaluesOnly);
  const double across = std::max(0.0, scatter.eigenvalues()(1));  // they ascend
  return std::sqrt(across / static_cast<double>(points.cols()));
}

/// How far points lie from their middle, m (rms).
double spread(const Eigen::Matrix3Xd& points) {
  const Eigen::Matrix3Xd centred = points.colwise() - points.rowwise().mean();
  return std::sqrt(centred.squaredNorm() / static_cast<double>(points.cols()));
}

/// The unit that the touched points seem to be in, when it is not the millimetre.
const char* find_other_unit(double touched, double known) {
  struct Unit {
    const char* name;
    double millimetres;
  };
  constexpr double kAlike = 1.25;
  for (const Unit& unit : {Unit{"metres", 1e3}, Unit{"centimetres", 10}, Unit{"inches", 25.4}}) {
    const double ratio = touched * unit.millimetres / known;
    if (ratio < kAlike && ratio > 1 / kAlike) return unit.name;
  }
  return nullptr;
}

std::string list_residuals(const std::vector<LandmarkPair>& pairs, const Registration& fit) {
  std::string list;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const std::string text = printed(" %.2f mm", fit.residuals[i] / kMillimetre);
    list += (list.empty() ? "" : ", ") + pairs[i].name + text;
  }
  return list;
}

Result<LandmarkPair> parse_pair(const std::vector<std::string>& fields, const CompiledJoint& joint,
                                const std::string& where) {
  if (fields.size() != 4)
    return fail(ErrorCode::malformed, "every line must be landmark,x_mm,y_mm,z_mm", where);
  const auto at = find_name(item_names(joint.landmarks), fields[0], "landmark", where);
  ARTUS_TRY(at);
  LandmarkPair pair{fields[0], joint.landmarks[*at].position, Vec3::Zero()};
  for (Eigen::Index i = 0; i < 3; ++i) {
    const auto number = parse_number(fields[static_cast<std::size_t>(i) + 1]);
    if (!number || !std::isfinite(*number))
      return fail(ErrorCode::malformed, "a coordinate is not a finite number", where);
    pair.p_R[i] = *number * kMillimetre;
  }
  return pair;
}

}  // namespace

Result<Registration> register_landmarks(const std::vector<LandmarkPair>& pairs, double limit) {
  constexpr std::size_t kFewest = 3;
  constexpr double kFlattest = 2e-3;  // m
  if (pairs.size() < kFewest)
    return fail(ErrorCode::invalid, "a registration needs at least three landmarks");
  const auto n = static_cast<Eigen::Index>(pairs.size());
  Eigen::Matrix3Xd touched(3, n);
  Eigen::Matrix3Xd known(3, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    touched.col(i) = pairs[static_cast<std::size_t>(i)].p_R;
    known.col(i) = pairs[static_cast<std::size_t>(i)].p_J;
  }
  const double spread_touched = spread(touched);
  const double spread_known = spread(known);
  if (const char* unit = find_other_unit(spread_touched, spread_known)) {
    return fail(
        ErrorCode::invalid,
        printed("the touched points spread over %.3g mm, the landmarks over %.3g mm: these look "
                "like %s, but x_mm, y_mm and z_mm must be millimetres",
                spread_touched / kMillimetre, spread_known / kMillimetre, unit));
  }
  if (spread_across_line(touched) < kFlattest || spread_across_line(known) < kFlattest)
    return fail(ErrorCode::invalid,
                "the landmarks lie on one line: touch another one away from it, or the rotation "
                "around that line remains unknown");
  Registration fit;
  fit.X_JR.matrix() = Eigen::umeyama(touched, known, false);
  double sum = 0;
  for (const LandmarkPair& pair : pairs) {
    fit.residuals.push_back((fit.X_JR * pair.p_R - pair.p_J).norm());
    sum += fit.residuals.back() * fit.residuals.back();
  }
  fit.rms = std::sqrt(sum / static_cast<double>(pairs.size()));
  if (!(fit.rms <= limit)) {
    const std::string text =
        printed("the landmarks fit to only %.2f mm; the limit is %.2f mm: ", fit.rms / kMillimetre,
                limit / kMillimetre);
    return fail(ErrorCode::invalid, text + list_residuals(pairs, fit));
  }
  return fit;
}

Result<std::vector<LandmarkPair>> parse_landmark_pairs(std::string_view text,
                                                       const std::string& name,
                                                       const CompiledJoint& joint) {
  std::vector<LandmarkPair> pairs;
  const auto read = [&](std::string_view line, const std::string& where) -> Result<void> {
    const std::vector<std::string> cells = csv_cells(line);
    if (pairs.empty() && cells.front() == "landmark") return {};  // the header
    auto pair = parse_pair(cells, joint, where);
    ARTUS_TRY(pair);
    if (std::any_of(pairs.begin(), pairs.end(),
                    [&](const LandmarkPair& other) { return other.name == pair->name; }))
      return fail(ErrorCode::invalid, "landmark '" + pair->name + "' is given twice", where);
    pairs.push_back(std::move(*pair));
    return {};
  };
  ARTUS_TRY(for_lines(text, name, read));
  return pairs;
}

Result<std::vector<LandmarkPair>> read_landmark_pairs(const std::filesystem::path& file,
                                                      const CompiledJoint& joint) {
  const auto text = read_bytes(file);
  ARTUS_TRY(text);
  return parse_landmark_pairs(*text, file.string(), joint);
}

}  // namespace artus
