// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/reports/views_page.h"

#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"
#include "artus/detail/reports/html_page.h"
#include "artus/detail/viewer/words/anatomy_names.h"

namespace artus {
namespace {

std::vector<std::string> row_of(const SeenStructure& seen, const ViewSight& sight,
                                Language language) {
  const std::string range =
      printed("%.0f - %.0f", sight.least / kMillimetre, sight.most / kMillimetre);
  const std::string depth =
      seen.share > 0 ? printed("%.1f", seen.depth / kMillimetre) : std::string("-");
  const std::string fault = to_sentence(seen.fault, language);
  return {clinical_name(language, seen.structure), range, depth,
          fault.empty() ? translate(language, "yes") : fault};
}

}  // namespace

std::string to_sentence(SightFault fault, Language language) {
  switch (fault) {
    case SightFault::not_seen:
      return translate(language, "not in the picture");
    case SightFault::depth:
      return translate(language, "at another depth");
    case SightFault::order:
      return translate(language, "nearer to the skin than what should lie before it");
    case SightFault::side:
      return translate(language, "on the other side");
    case SightFault::none:
      break;
  }
  return {};
}

std::string make_views_page(const std::string& joint, const std::vector<ShownView>& views,
                            Language language) {
  HtmlPage page(fill(translate(language, "Standard views of {}"), {joint}), language);
  for (const ShownView& shown : views) {
    page.open_card(shown.view.name);
    page.picture(shown.picture, shown.view.title);
    page.paragraph(shown.view.shows);
    page.paragraph(fill(translate(language, "Source: {}"), {shown.view.source}));
    std::vector<std::vector<std::string>> rows;
    for (std::size_t i = 0; i < shown.seen.size(); ++i)
      rows.push_back(row_of(shown.seen[i], shown.view.sights[i], language));
    page.table({{translate(language, "structure"), ""},
                {translate(language, "expected, mm"),
                 translate(language, "depth of its upper border below the skin")},
                {translate(language, "is, mm"), ""},
                {translate(language, "as described"), ""}},
               rows);
    page.close_card();
  }
  return page.text();
}

}  // namespace artus
