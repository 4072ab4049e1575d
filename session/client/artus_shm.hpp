// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cerrno>
#include <stdexcept>
#include <string>
#include <system_error>

#include "artus_shm.h"

namespace artus_shm {

/// The C++ client of artus' shared memory: owns the link, closes it when it goes.
class Link {
 public:
  /// Opens POS, or POS-PROBE for ARTUS_SHM_ROLE_PROBE, as its writer, and FORCE. Errors:
  /// std::system_error; EPROTO another version, EPERM others may touch the segment, EBUSY another
  /// device program writes for that role.
  explicit Link(const std::string& prefix = {}, int role = ARTUS_SHM_ROLE_ALL) {
    if (artus_shm_open_role(&link_, prefix.c_str(), role) != 0)
      throw std::system_error(errno, std::generic_category(),
                              prefix + (link_.refusal != nullptr ? link_.refusal : ""));
  }
  ~Link() { artus_shm_close(&link_); }
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  /// Numbers the sample and publishes it.
  void write(artus_shm_pos pos) noexcept {
    pos.sample = ++sample_;
    artus_shm_write_pos(&link_, &pos);
  }

  /// The newest force; zero with ARTUS_SHM_SILENT in its status when artus is silent for 20 ms, and
  /// with ARTUS_SHM_FORCE_INVALID beside when FORCE holds what cannot be a force.
  [[nodiscard]] artus_shm_force read() noexcept {
    artus_shm_force force;
    artus_shm_read_force(&link_, &force);
    return force;
  }

 private:
  artus_shm_link link_{};
  unsigned long long sample_ = 0;
};

}  // namespace artus_shm
