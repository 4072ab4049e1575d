# SPDX-License-Identifier: AGPL-3.0-or-later
# Writes OUT, a header with the digest of all SOURCES, whatever their order, and of LIBRARIES, the versions of
# those that shape what is compiled. Left alone when nothing changed.
cmake_minimum_required(VERSION 3.25)
set(digests "")
foreach(source ${SOURCES})
  file(SHA256 ${source} digest)
  list(APPEND digests ${digest})
endforeach()
list(SORT digests)
string(SHA256 digest "${digests} ${LIBRARIES}")
string(SUBSTRING ${digest} 0 16 digest)
file(CONFIGURE OUTPUT ${OUT} CONTENT "#pragma once
#include <cstdint>
namespace artus {
/// What compiles joints, by content: a kept joint that another one made is not taken for this one's.
inline constexpr std::uint64_t kCompilerVersion = 0x${digest};
}  // namespace artus
")
