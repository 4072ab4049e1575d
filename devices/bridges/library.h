// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>

#include <dlfcn.h>

namespace artus::bridge {

/// A maker's library, opened at run time: nothing of it is needed to build.
class Library {
 public:
  /// The first of the names that can be opened; why() is empty then. It stays open to the end of
  /// the program, since its own threads may run in it.
  template <class... Names>
  explicit Library(Names... names) {
    for (const char* name : {names...}) {
      handle_ = dlopen(name, RTLD_NOW | RTLD_GLOBAL);
      if (handle_ != nullptr) {
        why_.clear();
        return;
      }
      if (why_.empty()) why_ = dlerror();
    }
  }
  /// Finds a function; one that is missing stands in why().
  template <class Function>
  void find(const char* name, Function& function) {
    if (handle_ == nullptr) return;
    function = reinterpret_cast<Function>(dlsym(handle_, name));
    if (function == nullptr) why_ += std::string(why_.empty() ? "" : ", ") + name + " is missing";
  }
  /// What is wrong; empty: nothing.
  [[nodiscard]] const std::string& why() const noexcept { return why_; }

 private:
  void* handle_ = nullptr;
  std::string why_;
};

}  // namespace artus::bridge
