// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <utility>

#include <imgui.h>

#include "artus/detail/viewer/joint3d/gl_objects.h"
#include "artus/detail/viewer/pages/page.h"
#include "artus/detail/viewer/pages/page_gui.h"
#include "artus/detail/viewer/panels/panels.h"
#include "artus/detail/viewer/panels/shade.h"

namespace artus {
namespace {

ImVec4 colour_of(Tone tone) {
  switch (tone) {
    case Tone::heading:
      return {1, 0.88F, 0.4F, 1};
    case Tone::good:
      return {0.55F, 0.95F, 0.55F, 1};
    case Tone::bad:
      return {1, 0.6F, 0.45F, 1};
    case Tone::dim:
      return {0.65F, 0.65F, 0.65F, 1};
    case Tone::plain:
      break;
  }
  return {0.9F, 0.9F, 0.9F, 1};
}

void draw_lines(const std::vector<PageLine>& lines) {
  for (const PageLine& line : lines) wrapped_text(line.text, colour_of(line.tone));
}

}  // namespace

/// The page that is shown and what was done with it.
class PageWindow::Shown {
 public:
  Shown(Screen& screen, PageOptions options)
      : options_(std::move(options)), gui_(screen, options_) {}

  [[nodiscard]] Result<PageAnswer> show(Page page) {
    page_ = std::move(page);
    answer_.reset();
    scroll_ = true;
    ARTUS_TRY(gui_.begin(page_.name, page_.bar != nullptr || page_.choices.empty()));
    const auto closed = gui_.run([this](const UserEvent& event) { act(event); }, [this] { look(); },
                                 [this] { return over(); });
    ARTUS_TRY(closed);
    if (*closed) return PageAnswer{PageAnswer::Kind::closed, 0};
    return answer_.value_or(PageAnswer{PageAnswer::Kind::done, 0});
  }

 private:
  bool over() const { return answer_ || (page_.done && page_.done()); }

  void act(const UserEvent& event) {
    Action action = Action::none;
    if (const auto* request = std::get_if<ActionEvent>(&event)) action = request->action;
    if (const auto* pad = std::get_if<PadEvent>(&event)) action = tilt(*pad);
    const PageMove move = move_on_page(action, page_.at, page_.choices.size());
    scroll_ = scroll_ || move.at != page_.at;
    page_.at = move.at;
    if (move.chosen) answer_ = PageAnswer{PageAnswer::Kind::chosen, page_.at};
    if (move.back && page_.may_back) answer_ = PageAnswer{PageAnswer::Kind::back, 0};
  }

  /// A stick held up or down goes on every quarter of a second.
  Action tilt(const PadEvent& pad) {
    constexpr double kAgain = 0.25;  // s
    constexpr double kTilted = 0.3;
    if (std::abs(pad.left_y) < kTilted) return Action::none;
    held_ += pad.seconds;
    if (held_ < kAgain) return Action::none;
    held_ = 0;
    return pad.left_y > 0 ? Action::down : Action::up;
  }

  void look() {
    if (page_.refresh) page_.refresh(page_);
    if (options_.watch) options_.watch(page_);
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const float edge = 18 * gui_.scale();
    ImGui::SetNextWindowPos(ImVec2(0, 0));
    ImGui::SetNextWindowSize(size);
    ImGui::Begin("###page", nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus |
                     ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
    const bool about = std::any_of(page_.choices.begin(), page_.choices.end(), [](const auto& c) {
      return c.picture != nullptr || !c.about.empty();
    });
    const float left = about ? 0.5F * size.x : 0.94F * size.x;
    const float foot = 2.2F * ImGui::GetFrameHeightWithSpacing();
    ImGui::SetCursorPos(ImVec2(edge, edge));
    ImGui::BeginChild("###left", ImVec2(left - 2 * edge, size.y - 2 * edge - foot));
    draw_left();
    ImGui::EndChild();
    if (about) {
      ImGui::SetCursorPos(ImVec2(left, edge));
      ImGui::BeginChild("###right", ImVec2(size.x - left - edge, size.y - 2 * edge - foot));
      draw_right();
      ImGui::EndChild();
    }
    ImGui::SetCursorPos(ImVec2(edge, size.y - edge - foot / 2));
    draw_foot();
    ImGui::End();
  }

  void draw_left() {
    ImGui::SetWindowFontScale(1.5F);
    draw_lines({{page_.title, Tone::heading}});
    ImGui::SetWindowFontScale(1);
    ImGui::Dummy(ImVec2(0, 4 * gui_.scale()));
    draw_lines(page_.lines);
    draw_bar();
    ImGui::Dummy(ImVec2(0, 4 * gui_.scale()));
    const float right = ImGui::GetWindowContentRegionMax().x;
    for (std::size_t i = 0; i < page_.choices.size(); ++i) {
      const PageChoice& choice = page_.choices[i];
      const std::string name = choice.name + "###choice" + std::to_string(i);
      ImGui::PushStyleColor(ImGuiCol_Text, colour_of(choice.tone));
      // What is chosen stands out more than what the pointer passes.
      ImGui::PushStyleColor(ImGuiCol_Header, ImVec4(0.22F, 0.42F, 0.75F, 0.95F));
      ImGui::PushStyleColor(ImGuiCol_HeaderHovered, i == page_.at
                                                        ? ImVec4(0.24F, 0.46F, 0.80F, 1)
                                                        : ImVec4(0.20F, 0.24F, 0.32F, 0.8F));
      if (ImGui::Selectable(name.c_str(), i == page_.at))
        answer_ = PageAnswer{PageAnswer::Kind::chosen, i};
      const ImVec2 path = ImGui::GetIO().MouseDelta;
      if (ImGui::IsItemHovered() && (path.x != 0 || path.y != 0)) page_.at = i;
      if (i == page_.at && scroll_) ImGui::SetScrollHereY();
      if (!choice.beside.empty()) {
        ImGui::SameLine(right - ImGui::CalcTextSize(choice.beside.c_str()).x);
        ImGui::TextUnformatted(choice.beside.c_str());
      }
      ImGui::PopStyleColor(3);
    }
    scroll_ = false;
  }

  /// How far what is waited for has come, and since when.
  void draw_bar() {
    if (!page_.bar) return;
    const auto [step, fraction] = page_.bar();
    ImGui::ProgressBar(static_cast<float>(std::clamp(fraction, 0.0, 1.0)),
                       ImVec2(0.9F * ImGui::GetContentRegionAvail().x, 0));
    draw_lines({{step, Tone::dim}});
  }

  void draw_right() {
    if (page_.at >= page_.choices.size()) return;
    const PageChoice& choice = page_.choices[page_.at];
    if (choice.picture != nullptr && choice.picture->width > 0) {
      const PagePicture& picture = *choice.picture;
      if (shown_ != choice.picture) texture_.set_grey(picture.width, picture.height, picture.grey);
      shown_ = choice.picture;
      const ImVec2 room = ImGui::GetContentRegionAvail();
      const float scale = std::min(room.x / static_cast<float>(picture.width),
                                   0.62F * room.y / static_cast<float>(picture.height));
      ImGui::Image(to_imgui(texture_.id()), ImVec2(scale * static_cast<float>(picture.width),
                                                   scale * static_cast<float>(picture.height)));
      ImGui::Dummy(ImVec2(0, 4 * gui_.scale()));
    }
    draw_lines(choice.about);
  }

  void draw_foot() {
    if (page_.choices.empty()) return;
    const Language language = options_.language;
    const auto key = [&](Action action) {
      return options_.keys.said_key(action, language);
    };
    const std::string said =
        page_.may_back
            ? fill(translate(language, "{} and {} choose, {} goes on, {} goes back"),
                   {key(Action::up), key(Action::down), key(Action::accept), key(Action::let_go)})
            : fill(translate(language, "{} and {} choose, {} goes on"),
                   {key(Action::up), key(Action::down), key(Action::accept)});
    draw_lines({{said, Tone::dim}});
  }

  PageOptions options_;
  PageGui gui_;
  GlTexture texture_;
  std::shared_ptr<const PagePicture> shown_;
  Page page_;
  std::optional<PageAnswer> answer_;
  bool scroll_ = true;
  double held_ = 0;  // s
};

PageWindow::PageWindow(Screen& screen, PageOptions options)
    : shown_(std::make_unique<Shown>(screen, std::move(options))) {}
PageWindow::~PageWindow() = default;

Result<PageAnswer> PageWindow::show(Page page) {
  return shown_->show(std::move(page));
}

}  // namespace artus
