// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/trainer/teacher_board.h"

#include <algorithm>
#include <array>

#include <opencv2/imgcodecs.hpp>

#include "artus/detail/core/units.h"
#include "artus/detail/reports/mark_words.h"

namespace artus {
namespace {

constexpr std::size_t kLongest = 400;  // bytes of a remark
constexpr std::size_t kMostAsked = 100;

struct NamedAid {
  const char* name;
  double LessonAids::*value;
};
constexpr std::array<NamedAid, 5> kAids{{{"needle_overlay", &LessonAids::needle},
                                         {"tip_marker", &LessonAids::tip},
                                         {"target_glow", &LessonAids::target},
                                         {"labels", &LessonAids::labels},
                                         {"plane_beam", &LessonAids::plane}}};

const NamedAid* find_aid(const std::string& name) {
  const auto found = std::find_if(kAids.begin(), kAids.end(),
                                  [&](const NamedAid& aid) { return name == aid.name; });
  return found == kAids.end() ? nullptr : &*found;
}

bool is_share(const nlohmann::json& command, const char* key) {
  return command.contains(key) && command[key].is_number() && command[key].get<double>() >= 0 &&
         command[key].get<double>() <= 1;
}

std::string text_in(const nlohmann::json& command, const char* key) {
  return command.contains(key) && command[key].is_string() ? command[key].get<std::string>() : "";
}

}  // namespace

Result<TeacherCommand> parse_teacher_command(const std::string& text) {
  const auto refuse = [](const char* why) {
    return fail(ErrorCode::malformed, why, "command");
  };
  const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object()) return refuse("it is no object of JSON");
  const std::string what = text_in(json, "do");
  const bool has_on = json.contains("on") && json["on"].is_boolean();
  TeacherCommand command;
  if (what == "freeze") {
    if (!has_on) return refuse("freeze needs \"on\": true or false");
    command.kind = TeacherCommand::Kind::freeze;
    command.value = json["on"].get<bool>() ? 1 : 0;
  } else if (what == "point") {
    command.kind = TeacherCommand::Kind::point;
    const bool away = !json.contains("x") && !json.contains("y");
    if (!away && !(is_share(json, "x") && is_share(json, "y")))
      return refuse("x and y of a point are 0 to 1 across and down the picture");
    if (!away) command.at = {json["x"].get<double>(), json["y"].get<double>()};
  } else if (what == "aid") {
    command.kind = TeacherCommand::Kind::aid;
    command.text = text_in(json, "name");
    if (find_aid(command.text) == nullptr) return refuse("there is no aid of that name");
    if (!has_on) return refuse("aid needs \"on\": true or false");
    command.value = json["on"].get<bool>() ? 1 : 0;
  } else if (what == "remark") {
    command.text = text_in(json, "text");
    if (command.text.empty() || command.text.size() > kLongest)
      return refuse("the text of a remark has 1 to 400 bytes");
  } else {
    return refuse("\"do\" is freeze, point, aid or remark");
  }
  return command;
}

void TeacherBoard::take_image(const ImageSnapshot& image) {
  const std::lock_guard<std::mutex> lock(mutex_);
  picture_.width = image.width;
  picture_.height = image.height;
  picture_.number = image.input.number;
  picture_.grey = image.grey;
}

void TeacherBoard::tell(nlohmann::json state) {
  const std::lock_guard<std::mutex> lock(mutex_);
  state_ = std::move(state);
}

void TeacherBoard::ask(TeacherCommand command) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (asked_.size() < kMostAsked) asked_.push_back(std::move(command));
}

std::vector<TeacherCommand> TeacherBoard::take() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(asked_, {});
}

nlohmann::json TeacherBoard::state() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  nlohmann::json state = state_.is_object() ? state_ : nlohmann::json::object();
  state["running"] = state_.is_object();
  state["picture"] = picture_.number;
  return state;
}

std::string TeacherBoard::picture() const {
  Picture picture;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    picture = picture_;
  }
  if (picture.width <= 0 || picture.height <= 0) return "";
  const cv::Mat grey(picture.height, picture.width, CV_8UC1, picture.grey.data());
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", grey, bytes);
  return {bytes.begin(), bytes.end()};
}

TeacherFollow::TeacherFollow(TeacherBoard& board, const Scenario& scenario, const LessonAids& aids,
                             double rate, Language language)
    : board_(&board), scenario_(scenario), aids_(aids), period_(1 / rate), language_(language) {
  static_cast<void>(board.take());  // what was asked of the attempt before
}

void TeacherFollow::obey(const TeacherCommand& command, double time) {
  switch (command.kind) {
    case TeacherCommand::Kind::freeze:
      frozen_ = command.value > 0;
      events_.push_back(
          {time, "teacher:freeze", "", command.value, "the teacher froze the picture"});
      return;
    case TeacherCommand::Kind::point:
      point_ = command.at;
      if (point_)
        events_.push_back({time, "teacher:point", "", 0, "the teacher pointed at the picture"});
      return;
    case TeacherCommand::Kind::aid: {
      const NamedAid* aid = find_aid(command.text);
      if (aid == nullptr) return;
      aids_.*(aid->value) = command.value;
      changed_ = true;
      aided_ = aided_ || command.value > 0;
      events_.push_back(
          {time, "teacher:aid:" + command.text, "", command.value, "the teacher switched an aid"});
      return;
    }
    case TeacherCommand::Kind::remark:
      remark_ = command.text;
      remarked_ = time;
      events_.push_back({time, "remark", "", 0, command.text});
      return;
  }
}

void TeacherFollow::lead(const LessonView& view, Lesson& lesson) {
  constexpr double kEvery = 0.1;  // s between two states
  constexpr double kStands = 10;  // s that a remark is shown
  const double time = period_ * static_cast<double>(view.now.input.tick);
  for (const TeacherCommand& command : board_->take()) obey(command, time);
  lesson.frozen = std::exchange(frozen_, std::nullopt);
  lesson.pointed = point_;
  if (changed_) lesson.aids = aids_;
  if (!remark_.empty() && time - remarked_ < kStands)
    lesson.remark = fill(translate(language_, "Teacher: {}"), {remark_});
  if (told_ >= 0 && time >= told_ && time - told_ < kEvery) return;
  told_ = time;
  board_->tell(state_of(view, lesson));
}

nlohmann::json TeacherFollow::state_of(const LessonView& view, const Lesson& lesson) const {
  const auto mm = [](double length) {
    return length / kMillimetre;
  };
  auto steps = nlohmann::json::array();
  for (const LessonStep& step : lesson.steps)
    steps.push_back({{"text", step.text}, {"done", step.done}});
  auto marks = nlohmann::json::array();
  for (const Mark& mark : scenario_.pass) marks.push_back(mark_words(language_, mark));
  auto aids = nlohmann::json::object();
  for (const NamedAid& aid : kAids) aids[aid.name] = aids_.*(aid.value) > 0;
  const NeedleReading& needle = view.needle;
  return {{"title", lesson.title},
          {"goal", lesson.goal},
          {"clock", lesson.clock},
          {"late", lesson.late},
          {"patient", lesson.patient},
          {"steps", steps},
          {"marks", marks},
          {"aids", aids},
          {"needle",
           {{"inside", needle.inside},
            {"depth_mm", mm(needle.depth)},
            {"layer", needle.layer},
            {"on_bone", needle.on_bone},
            {"beside_plane_mm", mm(needle.plane_offset)},
            {"plane_angle_deg", needle.plane_angle / kDegree},
            {"to_target_mm",
             mm((to_pose(view.now.X_JN).translation() - scenario_.target.point).norm())}}},
          {"given_ml", view.now.feedback.plunger.given / kCubicCentimetre}};
}

}  // namespace artus
