// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/exchange/remote_command.h"

#include "artus/core/markup.h"
#include "artus/core/text_lines.h"

namespace artus {
namespace {}  // namespace

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
