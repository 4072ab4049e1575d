// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <utility>

#include <imgui.h>

#include "artus/detail/core/units.h"
#include "artus/detail/viewer/joint3d/joint_view.h"
#include "artus/detail/viewer/pages/page_gui.h"
#include "artus/detail/viewer/pages/review.h"
#include "artus/detail/viewer/panels/lesson.h"
#include "artus/detail/viewer/panels/panels.h"
#include "artus/detail/viewer/panels/shade.h"
#include "artus/simulation/simulation.h"

namespace artus {
namespace {

constexpr ImU32 kDepthColour = IM_COL32(120, 190, 255, 255);
constexpr ImU32 kForceColour = IM_COL32(255, 120, 90, 255);
constexpr ImU32 kThumbColour = IM_COL32(140, 230, 140, 255);
constexpr ImU32 kFaultColour = IM_COL32(255, 190, 60, 255);
constexpr Shade kFaultText{1, 0.75F, 0.25F};

constexpr int kStepsToRest = 12;  // of the tissue at 40 Hz: some of its relaxation times

/// Draws the picture of any moment. Knobs that stood otherwise need other tables.
class MomentPicture {
 public:
  MomentPicture(std::shared_ptr<const Scene> scene, const SessionParams& params)
      : scene_(std::move(scene)), params_(params) {}

  void draw(FrameInput input) {
    if (!simulation_ || !(controls_ == input.controls)) make(input.controls);
    input.number = ++number_;
    // Any moment may follow any other: what gives way comes to rest in it first.
    ImagedBody body;
    for (int k = 0; k < (params_.deform ? kStepsToRest : 1); ++k)
      body = simulation_->advance(input);
    const Frame& frame = simulation_->render(input, body);
    image_.width = frame.width;
    image_.height = frame.height;
    image_.pixel = frame.pixel;
    image_.grey = frame.image;
    image_.input = input;
    image_.probe_width = params_.transducer.width;
    image_.body = simulation_->drawn_scene();
    texture_.set_grey(frame.width, frame.height, frame.image);
  }

  [[nodiscard]] const ImageSnapshot& image() const noexcept { return image_; }
  [[nodiscard]] const GlTexture& texture() const noexcept { return texture_; }

 private:
  void make(const ImageControls& controls) {
    SessionParams params = params_;
    params.image.depth = controls.depth;
    params.image.gain_db = controls.gain_db;
    params.image.tgc_db_cm_mhz = controls.tgc_db_cm_mhz;
    params.image.dynamic_range_db = controls.dynamic_range_db;
    params.transducer.frequency = controls.frequency;
    params.transducer.elevation_focus = controls.elevation_focus;
    simulation_ = std::make_unique<Simulation>(scene_, params);
    controls_ = controls;
  }

  std::shared_ptr<const Scene> scene_;
  SessionParams params_;
  std::unique_ptr<Simulation> simulation_;
  ImageControls controls_;
  ImageSnapshot image_;
  GlTexture texture_;
  std::uint64_t number_ = 0;
};

constexpr double kSeen = 0.5;  // s into a fault, when there is something to see of it: the report's

std::vector<double> times_of(const std::vector<ReviewFault>& faults) {
  std::vector<double> times;
  for (const ReviewFault& fault : faults) times.push_back(fault.time + kSeen);
  return times;
}

/// N along the needle, positive against insertion.
double axial_force(const HapticSnapshot& state) {
  double sum = 0;
  for (const double part : state.axial) sum += part;
  return std::abs(sum);
}

/// The window of a review between its opening and its end.
class ReviewGui {
 public:
  ReviewGui(Screen& screen, const PageOptions& options, const Review& review)
      : options_(options),
        review_(review),
        gui_(screen, options_),
        cursor_(review.film.length(), times_of(review.faults)),
        yours_(review.scene, review.params),
        beside_(review.scene, review.params) {
    if (!review.faults.empty()) cursor_.go_to(review.faults.front().time + kSeen);
  }

  [[nodiscard]] Result<bool> run() {
    auto joint = JointView::make(review_.scene->shared_joint(), review_.params.transducer.width,
                                 needle_length_of(review_.params), review_.outside);
    ARTUS_TRY(joint);
    joint_ = std::move(*joint);
    ARTUS_TRY(gui_.begin("review"));
    const auto closed = gui_.run([this](const UserEvent& event) { act(event); }, [this] { look(); },
                                 [this] { return over_; });
    ARTUS_TRY(closed);
    return !*closed;
  }

 private:
  enum class Beside { inside, expert, mended };

  void act(const UserEvent& event) {
    constexpr double kStep = 0.1;  // s an arrow
    constexpr double kSpeed = 4;   // s of film a second of a stick
    if (const auto* pad = std::get_if<PadEvent>(&event))
      cursor_.go_to(cursor_.time() + kSpeed * pad->left_x * pad->seconds);
    const auto* request = std::get_if<ActionEvent>(&event);
    if (request == nullptr) return;
    const double step = request->fine ? 0.2 * kStep : kStep;
    switch (request->action) {
      case Action::left:
        return cursor_.go_to(cursor_.time() - step);
      case Action::right:
        return cursor_.go_to(cursor_.time() + step);
      case Action::cine_back:
        return cursor_.earlier_fault();
      case Action::cine_forward:
        return cursor_.later_fault();
      case Action::pause:
      case Action::choose_entry:
        return cursor_.play(!cursor_.playing());
      case Action::labels:
      case Action::freeze:
        truth_ = !truth_;
        return;
      case Action::dual:
      case Action::reset:
        return turn_page();
      case Action::let_go:
      case Action::explore:
      case Action::finish:
        over_ = true;
        return;
      default:
        return;
    }
  }

  void turn_page() {
    shown_beside_ = -1;
    if (page_ == Beside::inside)
      page_ = review_.expert ? Beside::expert : Beside::mended;
    else if (page_ == Beside::expert)
      page_ = Beside::mended;
    else
      page_ = Beside::inside;
    if (page_ == Beside::mended && !review_.in_plane) page_ = Beside::inside;
  }

  /// Pictures of the moment, when it is another than the one that was drawn last.
  void draw_pictures(const ReviewMoment& now) {
    if (shown_ != now.time) yours_.draw(now.picture);
    shown_ = now.time;
    if (page_ == Beside::inside || shown_beside_ == now.time) return;
    shown_beside_ = now.time;
    mended_.reset();
    if (page_ == Beside::expert) {
      beside_.draw(expert_now().picture);
    } else if (now.picture.has_needle != 0 && now.state.inserted != 0) {
      mended_ = mend_probe(*review_.scene, to_pose(now.picture.X_JP), to_pose(now.picture.X_JN));
      if (!mended_) return;
      FrameInput input = now.picture;
      input.X_JP = to_plain(mended_->X_JP);
      beside_.draw(input);
    }
  }

  [[nodiscard]] const ReviewMoment& expert_now() const {
    const double from = review_.expert->contact() - review_.film.contact();
    return review_.expert->at(std::max(0.0, cursor_.time() + from));
  }

  void look() {
    cursor_.pass(ImGui::GetIO().DeltaTime);
    const ReviewMoment& now = review_.film.at(cursor_.time());
    draw_pictures(now);
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos(ImVec2(0, 0));
    ImGui::SetNextWindowSize(size);
    ImGui::Begin("###review", nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoScrollbar);
    draw_buttons();
    const float height = 0.56F * size.y;
    ImGui::BeginChild("###yours", ImVec2(0.49F * size.x, height));
    draw_yours(now);
    ImGui::EndChild();
    ImGui::SameLine();
    ImGui::BeginChild("###beside", ImVec2(0, height));
    draw_beside(now);
    ImGui::EndChild();
    draw_time_line(0.2F * size.y);
    draw_texts(now);
    ImGui::End();
  }

  void button(const char* which, Action action, bool on = false) {
    if (on) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
    const std::string key = options_.keys.said_key(action, options_.language);
    const std::string name = std::string(translate(options_.language, which)) + " (" + key +
                             ")###" + std::string(name_of(action));
    if (ImGui::Button(name.c_str())) act(ActionEvent{action, false});
    if (on) ImGui::PopStyleColor();
    ImGui::SameLine();
  }

  void draw_buttons() {
    button(cursor_.playing() ? msgid("stop") : msgid("play"), Action::pause, cursor_.playing());
    button(msgid("truth"), Action::labels, truth_);
    button(msgid("other picture"), Action::dual);
    button(msgid("earlier fault"), Action::cine_back);
    button(msgid("later fault"), Action::cine_forward);
    button(msgid("Back"), Action::let_go);
    ImGui::TextUnformatted(review_.title.c_str());
  }

  /// A picture as large as there is room, under its title. Where its corner is, and its scale.
  std::pair<ImVec2, float> draw_image(const MomentPicture& picture, const std::string& title) {
    ImGui::TextUnformatted(title.c_str());
    const ImVec2 room = ImGui::GetContentRegionAvail();
    const auto width = static_cast<float>(picture.image().width);
    const auto height = static_cast<float>(picture.image().height);
    const float scale = std::min(room.x / width, room.y / height);
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::Image(to_imgui(picture.texture().id()), ImVec2(scale * width, scale * height));
    return {corner, scale};
  }

  void draw_yours(const ReviewMoment& now) {
    const std::string title =
        fill(translate(options_.language,
                       review_.of_expert ? msgid("The expert, at {} s") : msgid("You, at {} s")),
             {number(options_.language, now.time, 1)});
    const auto [corner, scale] = draw_image(yours_, title);
    if (truth_) draw_truth(now, corner, scale);
  }

  /// Structures' names, the shaft where it truly is, its tip, and the target.
  void draw_truth(const ReviewMoment& now, const ImVec2& corner, float scale) {
    const ImageSnapshot& image = yours_.image();
    const auto per_mm = scale * static_cast<float>(kMillimetre / image.pixel);
    const auto place = [&](const Vec3& p_J) {
      const ImagePoint p = point_on_picture(image, p_J);
      return ImVec2(corner.x + per_mm * static_cast<float>(p.x_mm),
                    corner.y + per_mm * static_cast<float>(p.y_mm));
    };
    const ImVec2 size(scale * static_cast<float>(image.width),
                      scale * static_cast<float>(image.height));
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->PushClipRect(corner, ImVec2(corner.x + size.x, corner.y + size.y), true);
    const float radius = 6 * gui_.scale();
    if (now.picture.has_needle != 0) {
      const Pose X_JN = to_pose(now.picture.X_JN);
      const ImVec2 tip = place(X_JN.translation());
      outlined_line(list, tip, place(X_JN * Vec3(0, 0, -needle_length_of(review_.params))));
      list->AddCircle(tip, radius, kForceColour, 0, 2 * gui_.scale());
    }
    if (review_.target_J)
      list->AddCircle(place(*review_.target_J), radius, kThumbColour, 0, 2 * gui_.scale());
    std::vector<NamedPoint> names;
    for (const PictureLabel& label :
         find_picture_labels(*image.body, to_pose(now.picture.X_JP), image.width * image.pixel,
                             image.height * image.pixel, options_.language))
      names.push_back({label.name, per_mm * static_cast<float>(label.x_mm),
                       per_mm * static_cast<float>(label.y_mm)});
    draw_names(list, corner, size, names);
    list->PopClipRect();
  }

  void draw_beside(const ReviewMoment& now) {
    const Language language = options_.language;
    if (page_ == Beside::inside) return draw_inside(now);
    if (page_ == Beside::expert) {
      draw_image(beside_, fill(translate(language, "The expert, at {} s"),
                               {number(language, expert_now().time, 1)}));
      return;
    }
    if (!mended_) {
      ImGui::TextWrapped("%s", translate(language, "The needle is not in the body here"));
      return;
    }
    draw_image(beside_,
               fill(translate(language, "The probe corrected: turned {} degrees, moved {} mm"),
                    {number(language, std::abs(mended_->turned) / kDegree, 0),
                     number(language, std::abs(mended_->moved) / kMillimetre, 1)}));
  }

  void draw_inside(const ReviewMoment& now) {
    ImGui::TextUnformatted(translate(options_.language, "Inside the joint"));
    const ImVec2 room = ImGui::GetContentRegionAvail();
    const std::optional<EntryChoice> no_entry;
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const unsigned texture =
        joint_->draw(static_cast<int>(room.x), static_cast<int>(room.y),
                     {now.state, to_pose(now.state.X_JN), state_of(*yours_.image().body),
                      &yours_.image(), yours_.texture(), no_entry});
    if (texture != 0)
      ImGui::Image(to_imgui(texture), room, ImVec2(0, 1), ImVec2(1, 0));
    else
      ImGui::TextUnformatted(translate(options_.language, "The joint is being drawn ..."));
    ImGui::SetCursorScreenPos(corner);
    ImGui::InvisibleButton("joint", room);
    const ImVec2 drag = ImGui::GetIO().MouseDelta;
    if (!ImGui::IsItemActive()) return;
    joint_->camera().yaw += 0.01 * drag.x;
    joint_->camera().pitch = std::clamp(joint_->camera().pitch + 0.01 * drag.y, -1.5, 1.5);
  }

  /// One curve in its share of the line's height.
  void draw_curve(const ImVec2& from, const ImVec2& size, ImU32 colour, const char* name,
                  const std::function<double(const HapticSnapshot&)>& value) {
    const auto& moments = review_.film.moments;
    double most = 1e-9;
    for (const ReviewMoment& m : moments) most = std::max(most, value(m.state));
    const double length = std::max(review_.film.length(), 1e-3);
    std::vector<ImVec2> points;
    const std::size_t step = std::max<std::size_t>(1, moments.size() / 1000);
    for (std::size_t i = 0; i < moments.size(); i += step)
      points.emplace_back(
          from.x + size.x * static_cast<float>(moments[i].time / length),
          from.y + size.y * static_cast<float>(1 - 0.95 * value(moments[i].state) / most));
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddPolyline(points.data(), static_cast<int>(points.size()), colour, false,
                      1.3F * gui_.scale());
    const std::string said =
        std::string(translate(options_.language, name)) + " " + number(options_.language, most, 1);
    list->AddText(ImVec2(from.x + 4, from.y), colour, said.c_str());
  }

  void draw_time_line(float height) {
    const ImVec2 from = ImGui::GetCursorScreenPos();
    const ImVec2 size(ImGui::GetContentRegionAvail().x, height);
    ImGui::InvisibleButton("###time", size);
    const double length = std::max(review_.film.length(), 1e-3);
    if (ImGui::IsItemActive()) {
      cursor_.play(false);
      cursor_.go_to(length * (ImGui::GetIO().MousePos.x - from.x) / size.x);
    }
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImVec2 end(from.x + size.x, from.y + size.y);
    list->AddRectFilled(from, end, IM_COL32(25, 25, 30, 255));
    const bool thumb =
        std::any_of(review_.film.moments.begin(), review_.film.moments.end(),
                    [](const ReviewMoment& m) { return m.state.feedback.plunger.thumb_force > 0; });
    const ImVec2 row(size.x, size.y / (thumb ? 3 : 2));
    draw_curve(from, row, kDepthColour, msgid("depth, mm"), [](const HapticSnapshot& s) {
      return s.inserted != 0 ? s.feedback.depth / kMillimetre : 0;
    });
    draw_curve(ImVec2(from.x, from.y + row.y), row, kForceColour, msgid("force, N"), axial_force);
    if (thumb)
      draw_curve(
          ImVec2(from.x, from.y + 2 * row.y), row, kThumbColour, msgid("thumb, N"),
          [](const HapticSnapshot& s) { return std::max(0.0, s.feedback.plunger.thumb_force); });
    const auto x_of = [&](double time) {
      return from.x + size.x * static_cast<float>(time / length);
    };
    const float wing = 6 * gui_.scale();
    for (const ReviewFault& fault : review_.faults) {
      const float x = x_of(fault.time);
      list->AddLine(ImVec2(x, from.y), ImVec2(x, end.y), kFaultColour, gui_.scale());
      list->AddTriangleFilled(ImVec2(x - wing, from.y), ImVec2(x + wing, from.y),
                              ImVec2(x, from.y + 1.5F * wing), kFaultColour);
    }
    const float x = x_of(cursor_.time());
    list->AddLine(ImVec2(x, from.y), ImVec2(x, end.y), IM_COL32(255, 255, 255, 255),
                  1.5F * gui_.scale());
  }

  void draw_texts(const ReviewMoment& now) {
    const auto wrapped = [](const std::string& said) {
      ImGui::TextWrapped("%s", said.c_str());
    };
    if (truth_ && review_.why) wrapped(review_.why(now.state));
    if (review_.faults.empty()) return wrapped(translate(options_.language, "No fault stood out"));
    const auto near = cursor_.near();
    if (!near) return;
    const ReviewFault& fault = review_.faults[*near];
    wrapped_text(fill(translate(options_.language, "{}: {}"),
                      {number(options_.language, fault.time, 1) + " s", fault.what}),
                 kFaultText);
    wrapped(fill(translate(options_.language, "Why: {}"), {fault.cause}));
    wrapped(fill(translate(options_.language, "Do: {}"), {fault.mend}));
  }

  const PageOptions& options_;
  const Review& review_;
  PageGui gui_;
  ReviewCursor cursor_;
  MomentPicture yours_;
  MomentPicture beside_;
  std::unique_ptr<JointView> joint_;
  std::optional<MendedProbe> mended_;
  Beside page_ = Beside::inside;
  double shown_ = -1;         // s, moment of the drawn picture
  double shown_beside_ = -1;  // s
  bool truth_ = false;
  bool over_ = false;
};

}  // namespace

Result<bool> run_review(Screen& screen, const PageOptions& options, const Review& review) {
  if (review.film.moments.empty()) return true;
  ReviewGui gui(screen, options, review);
  return gui.run();
}

}  // namespace artus
