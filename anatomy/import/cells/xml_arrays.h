// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "artus/core/result.h"

namespace artus {

/// A tag of an XML file: `<Name a="b">`, `</Name>` (is_end) or `<Name/>` (is_empty).
struct XmlTag {
  std::string name;
  std::map<std::string, std::string, std::less<>> attributes;
  bool is_end = false;
  bool is_empty = false;
  std::size_t end = 0;  ///< where the text behind it begins

  [[nodiscard]] std::string attribute(std::string_view key) const;
};

/// The tag that follows in `bytes` from `at` on, which goes behind it; comments and declarations
/// are passed over. nullopt: there is none.
[[nodiscard]] std::optional<XmlTag> next_tag(std::string_view bytes, std::size_t& at);

/// How VTK's XML files store arrays.
struct XmlArrayForm {
  bool is_big_endian = false;
  bool has_long_header = false;  ///< sizes are of 64 bits
  bool is_compressed = false;    ///< by zlib
  std::string_view appended;     ///< what follows the underscore of AppendedData
  bool appended_is_raw = false;
};

/// The numbers of a DataArray, whose text is `text`. Errors: corrupt (cut off, more promised than
/// there is), malformed (no number), unsupported (a type of samples), naming `where`.
[[nodiscard]] Result<std::vector<double>> read_xml_array(const XmlTag& tag, std::string_view text,
                                                         const XmlArrayForm& form,
                                                         const std::string& where);

}  // namespace artus
