// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <sstream>
#include <string_view>

#include "artus/detail/anatomy/compile/check/misplaced.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

/// Axes of the body: how far to the outer side (for a joint of a known side), to the front, upward.
enum Axis { lateral, anterior, superior };
constexpr std::array<const char*, 3> kToward{"lateral", "anterior", "superior"};
constexpr std::array<const char*, 3> kAway{"medial", "posterior", "inferior"};

/// A named thing and its middle.
struct Place {
  std::string name;
  std::vector<std::string> words;
  Vec3 position = Vec3::Zero();
};

/// What anatomy knows of two bones: the first lies so of the second. Source: [Gray2020].
struct Order {
  std::string_view first, second;
  Axis axis;
};
constexpr std::array<Order, 12> kOrders{{{"fibula", "tibia", lateral},
                                         {"humerus", "scapula", lateral},
                                         {"humerus", "glenoid", lateral},
                                         {"acromion", "coracoid", lateral},
                                         {"coracoid", "glenoid", anterior},
                                         {"femur", "acetabulum", lateral},
                                         {"femur", "pelvis", lateral},
                                         {"femur", "tibia", superior},
                                         {"patella", "femur", anterior},
                                         {"patella", "tibia", anterior},
                                         {"trochanter", "femoral_head", lateral},
                                         {"acromion", "glenoid", superior}}};

std::vector<std::string> words_of(const std::string& name) {
  std::vector<std::string> words;
  std::string word;
  std::istringstream in(name);
  while (std::getline(in, word, '_')) words.push_back(word);
  return words;
}

bool has_word(const Place& place, std::string_view word) {
  if (word.find('_') != std::string_view::npos) return place.name.rfind(word, 0) == 0;
  return std::find(place.words.begin(), place.words.end(), word) != place.words.end();
}

std::vector<Place> places_of(const JointFile& file, const PreparedSurfaces& surfaces) {
  std::vector<Place> places;
  for (std::size_t i = 0; i < file.structures.size(); ++i) {
    if (!surfaces.structures[i]) continue;
    const SurfaceMesh& mesh = surfaces.structures[i]->mesh;
    Vec3 sum = Vec3::Zero();
    double area = 0;
    for (const Triangle& t : mesh.triangles) {
      sum += triangle_area(mesh, t) * triangle_centre(mesh, t);
      area += triangle_area(mesh, t);
    }
    const std::string& name = file.structures[i].name;
    places.push_back({name, words_of(name), sum / area});
  }
  for (const Landmark& mark : file.landmarks)
    places.push_back({mark.name, words_of(mark.name), mark.position});
  return places;
}

/// Unit vectors of the joint frame for the three axes; zero for lateral without a side.
std::array<Vec3, 3> directions_of(const JointFile& file) {
  std::array<Vec3, 3> directions{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  for (std::size_t k = 0; k < 3 && k < file.axes.size(); ++k) {
    const Vec3 axis = Vec3::Unit(static_cast<Eigen::Index>(k));
    const char letter = file.axes[k];
    if (letter == 'A' || letter == 'P') directions[anterior] = letter == 'A' ? axis : Vec3(-axis);
    if (letter == 'S' || letter == 'I') directions[superior] = letter == 'S' ? axis : Vec3(-axis);
    if ((letter == 'L' || letter == 'R') && file.side != "none")
      directions[lateral] = (letter == 'L') == (file.side == "left") ? axis : Vec3(-axis);
  }
  return directions;
}

/// Pairs that speak for or against an axis.
struct Votes {
  std::size_t right = 0;
  std::vector<std::string> wrong;
};

class Voting {
 public:
  Voting(const JointFile& file, const PreparedSurfaces& surfaces)
      : places_(places_of(file, surfaces)), directions_(directions_of(file)) {
    for (const Place& a : places_)
      for (const Place& b : places_) {
        if (&a == &b) continue;
        for (std::size_t axis = 0; axis < 3; ++axis) vote_words(a, b, axis);
        for (const Order& order : kOrders)
          if (has_word(a, order.first) && has_word(b, order.second) && !has_word(a, order.second))
            vote(a, b, order.axis);
      }
  }
  [[nodiscard]] const std::array<Votes, 3>& votes() const noexcept { return votes_; }

 private:
  /// "lateral_meniscus" and "medial_meniscus" differ in one word, which says how they lie.
  void vote_words(const Place& a, const Place& b, std::size_t axis) {
    if (a.words.size() != b.words.size()) return;
    std::size_t n_different = 0;
    bool opposite = false;
    for (std::size_t i = 0; i < a.words.size(); ++i) {
      if (a.words[i] == b.words[i]) continue;
      ++n_different;
      opposite = a.words[i] == kToward.at(axis) && b.words[i] == kAway.at(axis);
    }
    if (n_different == 1 && opposite) vote(a, b, axis);
  }
  void vote(const Place& a, const Place& b, std::size_t axis) {
    constexpr double kClear = 2 * kMillimetre;
    const double ahead = (a.position - b.position).dot(directions_.at(axis));
    if (ahead > kClear) ++votes_.at(axis).right;
    if (ahead < -kClear)
      votes_.at(axis).wrong.push_back("'" + a.name + "' lies " + kAway.at(axis) + " of '" + b.name +
                                      "'");
  }

  std::vector<Place> places_;
  std::array<Vec3, 3> directions_;
  std::array<Votes, 3> votes_;
};

}  // namespace

std::vector<Finding> find_mirrored(const JointFile& file, const PreparedSurfaces& surfaces) {
  std::vector<Finding> findings;
  const Voting voting(file, surfaces);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Votes& votes = voting.votes().at(axis);
    if (votes.wrong.size() <= votes.right) continue;
    std::string message = votes.wrong.front();
    for (std::size_t i = 1; i < votes.wrong.size() && i < 3; ++i) message += ", " + votes.wrong[i];
    message +=
        " by the file's axes = \"" + file.axes + "\"" +
        (axis == lateral ? " and side = \"" + file.side + "\"" : "") + " (" +
        std::to_string(votes.wrong.size()) + " such pairs, " + std::to_string(votes.right) +
        " that fit): " +
        (axis == lateral ? "the joint is mirrored or of the other side: correct 'side' or 'axes'"
                         : "set 'axes' to those of the surfaces");
    findings.push_back({Verdict::look, "mirrored", "joint", 0, std::move(message)});
  }
  return findings;
}

}  // namespace artus
