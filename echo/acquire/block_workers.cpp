// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/acquire/block_workers.h"

#include <algorithm>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace artus {

struct BlockWorkers::Arena {
  tbb::task_arena tasks;
};

BlockWorkers::BlockWorkers(int n_threads)
    : arena_(new Arena{tbb::task_arena(n_threads == 0 ? tbb::task_arena::automatic : n_threads)}) {}
BlockWorkers::~BlockWorkers() = default;

int BlockWorkers::workers() const noexcept {
  return arena_->tasks.max_concurrency();
}

void BlockWorkers::run(const Work& work, const void* body,
                       void (*call)(const void*, int, int, int)) {
  const int n = work.n;
  const int size = work.block;
  arena_->tasks.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<int>(0, blocks_of(n, size), 1),
        [n, size, body, call](const tbb::blocked_range<int>& range) {
          for (int b = range.begin(); b < range.end(); ++b) {
            call(body, tbb::this_task_arena::current_thread_index(), b * size,
                 std::min(n, (b + 1) * size));
          }
        },
        tbb::simple_partitioner{});
  });
}

void BlockWorkers::enter(const void* task, void (*call)(const void*)) {
  arena_->tasks.execute([&] { call(task); });
}

}  // namespace artus
