// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/exchange/remote_command.h"

#include <algorithm>
#include <array>
#include <optional>

#include "artus/detail/core/markup.h"
#include "artus/detail/core/text_lines.h"

namespace artus {
namespace {

/// Text of an attribute as it was meant: the five entities of XML are read.
std::string unescaped(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, char>, 5> kEntities{
      {{"&lt;", '<'}, {"&gt;", '>'}, {"&amp;", '&'}, {"&quot;", '"'}, {"&apos;", '\''}}};
  std::string out;
  while (!text.empty()) {
    const auto entity =
        std::find_if(kEntities.begin(), kEntities.end(), [&](const auto& candidate) {
          return text.substr(0, candidate.first.size()) == candidate.first;
        });
    const bool found = entity != kEntities.end();
    out += found ? entity->second : text.front();
    text.remove_prefix(found ? entity->first.size() : 1);
  }
  return out;
}

/// The first tag up to its '>', which may stand in quotes; nullopt when tag or quote has no end.
std::optional<std::string_view> first_tag(std::string_view text) {
  char quote = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quote != 0)
      quote = c == quote ? '\0' : quote;
    else if (c == '"' || c == '\'')
      quote = c;
    else if (c == '>')
      return text.substr(0, i + 1);
  }
  return std::nullopt;
}

/// What stands in quotes of either kind behind `name` in a whole tag, blanks about '=' or not.
std::optional<std::string_view> attribute(std::string_view tag, std::string_view name) {
  constexpr std::string_view kBlank = " \t\r\n";
  const auto skip = [&](std::size_t n) {
    tag.remove_prefix(std::min(n, tag.size()));
  };
  skip(tag.find_first_of(" \t\r\n/>"));  // the element's name
  while (true) {
    skip(tag.find_first_not_of(kBlank));
    const std::string_view key = tag.substr(0, tag.find_first_of(" \t\r\n=/>"));
    skip(key.size());
    skip(tag.find_first_not_of(kBlank));
    if (key.empty() || tag.empty() || tag.front() != '=') return std::nullopt;
    skip(1);
    skip(tag.find_first_not_of(kBlank));
    if (tag.empty() || (tag.front() != '"' && tag.front() != '\'')) return std::nullopt;
    const char quote = tag.front();
    skip(1);
    const std::string_view value = tag.substr(0, tag.find(quote));
    if (key == name) return value;
    skip(value.size() + 1);
  }
}

}  // namespace

Result<RemoteCommand> remote_command_of(const igtl::CommandText& command) {
  RemoteCommand out{command.name, {}};
  const std::string_view content = trimmed(command.content);
  if (content.empty() || content.front() != '<') {
    out.value = std::string(content);
    return out;
  }
  const auto tag = first_tag(content);
  if (!tag) return fail(ErrorCode::malformed, "the command's XML has no end");
  for (const std::string_view key : {"Value", "value"}) {
    const auto value = attribute(*tag, key);
    if (!value) continue;
    out.value = unescaped(trimmed(*value));
    break;
  }
  return out;
}

igtl::Message answer_message(const igtl::Message& asked, const igtl::CommandText& command,
                             const RemoteAnswer& answer) {
  igtl::CommandText said = command;
  said.encoding = 3;
  said.content = std::string("<Command><Result>") + (answer.done ? "true" : "false") +
                 "</Result><Message>" + escape_markup(answer.text) + "</Message></Command>";
  igtl::Message message;
  message.type = "RTS_COMMAND";
  message.device = asked.device;
  message.time = igtl::utc_time_now();
  message.id = asked.id;
  message.content = igtl::pack_command(said);
  message.meta = {{"Status", answer.done ? "SUCCESS" : "FAIL", 3}};
  if (!answer.done) message.meta.push_back({"ErrorMessage", answer.text, 3});
  return message;
}

}  // namespace artus
