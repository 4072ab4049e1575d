// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/exchange/transform_graph.h"

#include <cctype>
#include <deque>

#include "artus/detail/exchange/reference_frame.h"

namespace artus {
namespace {

struct FoundHand {
  std::optional<Pose> pose;
  std::string taken;
  Eigen::Matrix3d given = Eigen::Matrix3d::Identity();
};

Result<FoundHand> find_hand(const TransformGraph& graph, const std::string& name,
                            const std::vector<std::string>& also) {
  const auto asked = frames_of_transform(name);
  if (!asked) return fail(ErrorCode::invalid, "'" + name + "' must have the form <tool>To<frame>");
  std::vector<std::string> tools{asked->first};
  tools.insert(tools.end(), also.begin(), also.end());
  const std::string to =
      !graph.knows(asked->second) && asked->second == "Reference" ? "Tracker" : asked->second;
  for (const std::string& tool : tools) {
    FoundHand found;
    auto pose = graph.find(tool, to, &found.given);
    ARTUS_TRY(pose);
    if (!*pose) continue;
    const bool other = tool != asked->first || to != asked->second;
    found.pose = *pose;
    if (other) found.taken = tool + " in " + to;
    return found;
  }
  return FoundHand{};
}

}  // namespace

std::optional<std::pair<std::string, std::string>> frames_of_transform(std::string_view name) {
  for (std::size_t at = name.rfind("To"); at != std::string_view::npos && at > 0;
       at = name.rfind("To", at - 1))
    if (at + 2 < name.size() && std::isupper(static_cast<unsigned char>(name[at + 2])) != 0)
      return std::pair(std::string(name.substr(0, at)), std::string(name.substr(at + 2)));
  return std::nullopt;
}

void TransformGraph::set(std::string_view name, const igtl::Matrix& matrix) {
  const auto frames = frames_of_transform(name);
  if (!frames) return;
  const auto put = [&](const std::string& from, const std::string& to, bool forward) {
    for (Edge& edge : edges_[from])
      if (edge.name == name && edge.forward == forward) {
        edge.matrix = matrix;
        return;
      }
    edges_[from].push_back({to, std::string(name), matrix, forward});
  };
  put(frames->first, frames->second, true);
  put(frames->second, frames->first, false);
}

bool TransformGraph::knows(std::string_view frame) const {
  return edges_.find(frame) != edges_.end();
}

Result<std::optional<Pose>> TransformGraph::find(std::string_view from, std::string_view to,
                                                 Eigen::Matrix3d* given) const {
  std::map<std::string, const Edge*, std::less<>> came{{std::string(from), nullptr}};
  std::map<std::string, std::string, std::less<>> before;
  std::deque<std::string> next{std::string(from)};
  while (!next.empty() && came.find(to) == came.end()) {
    const std::string here = next.front();
    next.pop_front();
    const auto edges = edges_.find(here);
    if (edges == edges_.end()) continue;
    for (const Edge& edge : edges->second)
      if (came.emplace(edge.to, &edge).second) {
        before[edge.to] = here;
        next.push_back(edge.to);
      }
  }
  if (came.find(to) == came.end() || edges_.find(from) == edges_.end())
    return std::optional<Pose>();
  Pose pose = Pose::Identity();  // from the last frame of the way back to the first
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  for (std::string here(to); here != from; here = before[here]) {
    const Edge& edge = *came[here];
    const auto rigid = rigid_from(edge.matrix);
    if (!rigid) return fail(ErrorCode::invalid, rigid.error().message, edge.name);
    pose = pose * (edge.forward ? *rigid : rigid->inverse());
    const Eigen::Matrix3d own = edge.matrix.leftCols<3>();
    turn = turn * (edge.forward ? own : Eigen::Matrix3d(own.inverse()));
  }
  if (given != nullptr) *given = turn;
  return std::optional<Pose>(pose);
}

Result<FoundHands> find_hands(const TransformGraph& graph, const std::string& probe,
                              const std::string& needle) {
  const auto first = find_hand(graph, probe, {});
  ARTUS_TRY(first);
  const bool asked = needle != "NeedleToReference";  // a name of the user's own is meant as it is
  const auto second =
      find_hand(graph, needle,
                asked ? std::vector<std::string>()
                      : std::vector<std::string>{"NeedleTip", "StylusTip", "Stylus"});
  ARTUS_TRY(second);
  return FoundHands{first->pose,   second->pose, first->taken,
                    second->taken, first->given, second->given};
}

}  // namespace artus
