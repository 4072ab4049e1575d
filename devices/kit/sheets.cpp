// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/devices/kit/sheets.h"

#include <cstdint>
#include <system_error>
#include <vector>

#include <hpdf.h>

#include "artus/detail/anatomy/surfaces/surface_io.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/units.h"
#include "artus/detail/devices/kit/board.h"
#include "artus/detail/devices/kit/marker_dictionary.h"
#include "artus/detail/devices/kit/solid.h"

namespace artus::kit {
namespace {

constexpr double kPoint = 25.4e-3 / 72;  // m

/// Keeps the first thing that the library complains about.
void note_trouble(HPDF_STATUS code, HPDF_STATUS /*detail*/, void* first) {
  auto* kept = static_cast<HPDF_STATUS*>(first);
  if (*kept == HPDF_OK) *kept = code;
}

/// One page on landscape paper; lengths are metres from its middle, y up.
class Sheet {
 public:
  explicit Sheet(Paper paper) : document_(HPDF_New(note_trouble, &trouble_)) {
    if (document_ == nullptr) return;
    page_ = HPDF_AddPage(document_);
    width_ = paper == Paper::a4 ? 0.297 : 0.2794;
    height_ = paper == Paper::a4 ? 0.210 : 0.2159;
    HPDF_Page_SetWidth(page_, static_cast<float>(width_ / kPoint));
    HPDF_Page_SetHeight(page_, static_cast<float>(height_ / kPoint));
    font_ = HPDF_GetFont(document_, "Helvetica", nullptr);
  }
  ~Sheet() {
    if (document_ != nullptr) HPDF_Free(document_);
  }
  Sheet(const Sheet&) = delete;
  Sheet& operator=(const Sheet&) = delete;

  void black(double x, double y, double width, double height) {
    if (document_ == nullptr) return;
    HPDF_Page_SetGrayFill(page_, 0);
    HPDF_Page_Rectangle(page_, across(x), up(y), length(width), length(height));
    HPDF_Page_Fill(page_);
  }
  void line(double x0, double y0, double x1, double y1, double wide = 0.2e-3) {
    if (document_ == nullptr) return;
    HPDF_Page_SetLineWidth(page_, length(wide));
    HPDF_Page_MoveTo(page_, across(x0), up(y0));
    HPDF_Page_LineTo(page_, across(x1), up(y1));
    HPDF_Page_Stroke(page_);
  }
  void frame(double x, double y, double width, double height) {
    line(x, y, x + width, y);
    line(x + width, y, x + width, y + height);
    line(x + width, y + height, x, y + height);
    line(x, y + height, x, y);
  }
  void text(double x, double y, const std::string& words, double size = 3e-3) {
    if (document_ == nullptr) return;
    HPDF_Page_BeginText(page_);
    HPDF_Page_SetFontAndSize(page_, font_, length(size));
    HPDF_Page_TextOut(page_, across(x), up(y), words.c_str());
    HPDF_Page_EndText(page_);
  }
  /// Middle and side.
  void marker(int id, double x, double y, double side) {
    const MarkerCells cells = cells_of_marker(id);
    const double cell = side / 6;
    for (std::size_t row = 0; row < 6; ++row) {
      std::size_t from = 0;
      while (from < 6) {  // black cells beside each other as one: no hair lines between them
        std::size_t to = from;
        while (to < 6 && !cells[row][to]) ++to;
        if (to > from)
          black(x - side / 2 + static_cast<double>(from) * cell,
                y + side / 2 - static_cast<double>(row + 1) * cell,
                static_cast<double>(to - from) * cell, cell);
        from = to + 1;
      }
    }
  }
  /// A label with its marker, to cut out along its frame.
  void label(int id, double x, double y, double side, double outer) {
    frame(x - outer / 2, y - outer / 2, outer, outer);
    marker(id, x, y, side);
    text(x - outer / 2 + 0.3e-3, y - outer / 2 + 0.3e-3, std::to_string(id), 1.6e-3);
  }
  void ruler(double x, double y) {
    constexpr double kLength = 0.1;
    line(x, y, x + kLength, y);
    for (int i = 0; i <= 10; ++i)
      line(x + i * kLength / 10, y, x + i * kLength / 10, y + (i % 5 == 0 ? 4e-3 : 2.5e-3));
    text(x + kLength + 2e-3, y, "this line is 100 mm: measure it (--ruler-mm tells another)",
         2.2e-3);
  }
  [[nodiscard]] double half_width() const { return width_ / 2; }
  [[nodiscard]] double half_height() const { return height_ / 2; }

  [[nodiscard]] Result<void> write(const std::filesystem::path& file) {
    std::string bytes;
    if (document_ != nullptr && HPDF_SaveToStream(document_) == HPDF_OK) {
      bytes.resize(HPDF_GetStreamSize(document_));
      auto size = static_cast<HPDF_UINT32>(bytes.size());
      HPDF_ReadFromStream(document_, reinterpret_cast<HPDF_BYTE*>(bytes.data()), &size);
      bytes.resize(size);
    }
    if (trouble_ != HPDF_OK || bytes.empty())
      return fail(ErrorCode::failed, "the library of PDF fails with " + std::to_string(trouble_),
                  file.string());
    return write_text(file, bytes);
  }

 private:
  [[nodiscard]] float across(double x) const {
    return static_cast<float>((x + width_ / 2) / kPoint);
  }
  [[nodiscard]] float up(double y) const { return static_cast<float>((y + height_ / 2) / kPoint); }
  [[nodiscard]] static float length(double l) { return static_cast<float>(l / kPoint); }

  HPDF_STATUS trouble_ = HPDF_OK;
  HPDF_Doc document_;
  HPDF_Page page_ = nullptr;
  HPDF_Font font_ = nullptr;
  double width_ = 0;
  double height_ = 0;
};

void draw_cross(Sheet& sheet, double x, double y) {
  constexpr double kArm = 2e-3;
  sheet.line(x - kArm, y, x + kArm, y, 0.15e-3);
  sheet.line(x, y - kArm, x, y + kArm, 0.15e-3);
}

Result<void> write_markers(const std::filesystem::path& file, Paper paper, Hand hand) {
  Sheet sheet(paper);
  const double top = sheet.half_height();
  sheet.text(-0.12, top - 15e-3,
             std::string("artus hands: labels, for a syringe in the ") +
                 (hand == Hand::right ? "right" : "left") +
                 " hand. Cut along the lines, glue flat, numbers as drawn.");
  const auto prism = [&sheet](const PrismSize& size, int first, double x, double y) {
    for (int row = 0; row < 2; ++row)
      for (int k = 0; k < 3; ++k)
        sheet.label(first + 3 * row + k, x + k * size.face, y - row * size.face, size.side,
                    size.face);
  };
  sheet.text(-0.12, top - 26e-3, "probe: three faces, two rows; the upper row away from its face");
  prism(kProbePrism, kProbeId, -0.1065, top - 44e-3);
  sheet.text(-0.01, top - 26e-3, "syringe: the lower row towards the needle");
  prism(kSyringePrism, kSyringeId, 0.0, top - 44e-3);
  sheet.text(0.08, top - 26e-3, "plunger");
  sheet.label(kPlungerId, 0.088, top - 44e-3, kPlungerSide, 16e-3);
  const double y = top - 110e-3;
  sheet.text(-0.12, y + 9e-3, "marks for the probe's face, where the needle's tip touches it");
  sheet.frame(-0.12, y - kFaceWidth / 2, kFaceLength, kFaceWidth);
  for (const double x : {-kTouchSpan, 0.0, kTouchSpan})
    draw_cross(sheet, -0.12 + kFaceLength / 2 + x, y);
  sheet.ruler(-0.12, -top + 15e-3);
  return sheet.write(file);
}

Result<void> write_ground(const std::filesystem::path& file, Paper paper) {
  Sheet sheet(paper);
  for (const Marker& marker : make_sheet_body().markers)
    sheet.marker(marker.id, marker.centre().x(), marker.centre().y(), marker.side);
  sheet.frame(-0.09, -0.05, 0.18, 0.1);
  draw_cross(sheet, 0, 0);
  sheet.text(-0.085, 0.043, "artus hands: the block stands here, its middle on the cross");
  sheet.text(-0.02, -0.08, "this edge towards the camera", 2.8e-3);
  sheet.ruler(-0.085, -0.045);
  return sheet.write(file);
}

Result<void> write_board(const std::filesystem::path& file, Paper paper) {
  Sheet sheet(paper);
  const double side = kBoardSquare;
  const double x0 = -kBoardColumns * side / 2;
  const double y0 = kBoardRows * side / 2;
  for (int row = 0; row < kBoardRows; ++row)
    for (int column = 0; column < kBoardColumns; ++column)
      if ((row + column) % 2 == 0)
        sheet.black(x0 + column * side, y0 - (row + 1) * side, side, side);
  for (const Marker& marker : make_board().markers)
    sheet.marker(marker.id, marker.centre().x(), marker.centre().y(), marker.side);
  sheet.text(-0.11, sheet.half_height() - 10e-3,
             "artus hands: for the camera. Lay it under glass or glue it on glass: it must be flat",
             2.5e-3);
  sheet.ruler(-0.1, -sheet.half_height() + 5e-3);
  return sheet.write(file);
}

}  // namespace

Result<void> write_sheets(const std::filesystem::path& folder, Paper paper, Hand hand) {
  ARTUS_TRY(write_markers(folder / "markers.pdf", paper, hand));
  ARTUS_TRY(write_ground(folder / "sheet.pdf", paper));
  return write_board(folder / "board.pdf", paper);
}

Result<void> write_parts(const std::filesystem::path& folder, Hand hand, double barrel) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  ARTUS_TRY(write_surface(make_probe_mock(hand), folder / "probe.stl", kMillimetre));
  ARTUS_TRY(write_surface(make_syringe_clip(barrel), folder / "syringe.stl", kMillimetre));
  ARTUS_TRY(write_surface(make_plunger_flag(hand), folder / "plunger.stl", kMillimetre));
  return write_surface(make_divot_plate(), folder / "divots.stl", kMillimetre);
}

}  // namespace artus::kit
