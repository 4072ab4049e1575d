// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>

namespace artus {

/// The threads that share the lines or rows of an image: work is cut into fixed blocks, so that
/// what a block computes does not depend on how many threads there are.
class BlockWorkers {
 public:
  /// Lines or rows that one task takes.
  static constexpr int kBlock = 8;

  /// `n_threads` 0: as many as the machine has.
  explicit BlockWorkers(int n_threads);
  ~BlockWorkers();
  BlockWorkers(const BlockWorkers&) = delete;
  BlockWorkers& operator=(const BlockWorkers&) = delete;
  BlockWorkers(BlockWorkers&&) = delete;
  BlockWorkers& operator=(BlockWorkers&&) = delete;

  [[nodiscard]] static int blocks_of(int n, int size = kBlock) noexcept {
    return (n + size - 1) / size;
  }

  /// How many threads may work at once.
  [[nodiscard]] int workers() const noexcept;

  /// Runs body(worker, first, last), worker < workers(), over [0, n), `size` (> 0) a block, and
  /// waits.
  template <class Body>
  void for_blocks(int n, const Body& body, int size = kBlock) {
    run({n, size}, &body, [](const void* what, int block, int first, int last) {
      (*static_cast<const Body*>(what))(block, first, last);
    });
  }
  /// Runs task() where parallel loops use these threads alone, and waits.
  template <class Task>
  void execute(const Task& task) {
    enter(&task, [](const void* what) { (*static_cast<const Task*>(what))(); });
  }

 private:
  struct Work {
    int n;
    int block;
  };
  void run(const Work& work, const void* body, void (*call)(const void*, int, int, int));
  void enter(const void* task, void (*call)(const void*));

  struct Arena;
  std::unique_ptr<Arena> arena_;
};

}  // namespace artus
