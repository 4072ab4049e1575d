// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/exchange/remote_command.h"

namespace artus {
namespace {

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '&':
        out += "&amp;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank(" \t\r\n\0", 5);
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

}  // namespace

RemoteCommand remote_command_of(const igtl::CommandText& command) {
  RemoteCommand out{command.name, {}};
  const std::string_view content = trimmed(command.content);
  if (content.empty() || content.front() != '<') {
    out.value = std::string(content);
    return out;
  }
  for (const std::string_view key : {" Value=\"", " value=\""}) {
    const std::size_t begin = content.find(key);
    if (begin == std::string_view::npos) continue;
    const std::string_view rest = content.substr(begin + key.size());
    out.value = std::string(trimmed(rest.substr(0, rest.find('"'))));
    break;
  }
  return out;
}

igtl::Message answer_message(const igtl::Message& asked, const igtl::CommandText& command,
                             const RemoteAnswer& answer) {
  igtl::CommandText said = command;
  said.encoding = 3;
  said.content = std::string("<Command><Result>") + (answer.done ? "true" : "false") +
                 "</Result><Message>" + escaped(answer.text) + "</Message></Command>";
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
