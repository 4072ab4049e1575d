// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/session/shm/seqlock.h"

#include <memory>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/no_alloc.h"

namespace artus {
namespace {

struct Sample {
  std::array<std::uint64_t, 40> words{};
};

struct OddSize {
  std::array<char, 13> text{};
};

TEST(Seqlock, AFreshOneHoldsZeros) {
  const Seqlock<Sample> lock;
  Sample sample;
  sample.words.fill(7);
  ASSERT_TRUE(lock.load(sample));
  EXPECT_EQ(sample.words[39], 0U);
}

TEST(Seqlock, GivesBackWhatWasStored) {
  Seqlock<OddSize> lock;
  const OddSize stored{{'a', 'b', 'c', 'd', 'e', 'f', 'g', 'h', 'i', 'j', 'k', 'l', 'm'}};
  lock.store(stored);
  OddSize loaded;
  ASSERT_TRUE(lock.load(loaded));
  EXPECT_EQ(loaded.text, stored.text);
  EXPECT_EQ(lock.sequence(), 2U);
}

TEST(Seqlock, APrefixLeavesTheRestAsItWas) {
  Seqlock<Sample> lock;
  Sample sample;
  sample.words.fill(1);
  lock.store(sample);
  sample.words.fill(2);
  lock.store_prefix(sample, 16);
  ASSERT_TRUE(lock.load(sample));
  EXPECT_EQ(sample.words[1], 2U);
  EXPECT_EQ(sample.words[2], 1U);
}

TEST(Seqlock, AReaderOfAWriterThatDiedInTheMiddleGivesUp) {
  Seqlock<Sample> lock;
  auto* sequence = reinterpret_cast<std::atomic<std::uint64_t>*>(&lock);
  sequence->store(5);
  Sample sample;
  EXPECT_FALSE(lock.load(sample));
  lock.store(sample);  // the next writer takes it up
  EXPECT_TRUE(lock.load(sample));
  EXPECT_EQ(lock.sequence(), 6U);
}

TEST(Seqlock, NoReaderEverSeesHalfOfAValue) {
  constexpr std::uint64_t kWrites = 20000;
  auto lock = std::make_unique<Seqlock<Sample>>();
  std::atomic<bool> done{false};
  std::atomic<std::uint64_t> torn{0};
  std::atomic<std::uint64_t> backwards{0};
  std::atomic<std::uint64_t> whole{0};
  const auto read = [&] {
    Sample sample;
    std::uint64_t last = 0;
    while (!done.load()) {
      if (!lock->try_load(sample)) {
        std::this_thread::yield();
        continue;
      }
      for (const std::uint64_t word : sample.words) torn += word == sample.words[0] ? 0 : 1;
      backwards += sample.words[0] >= last ? 0 : 1;
      last = sample.words[0];
      ++whole;
    }
  };
  std::vector<std::thread> readers;
  for (int i = 0; i < 3; ++i) readers.emplace_back(read);
  Sample sample;
  std::uint64_t written = 0;
  while (written < kWrites || whole.load() < 100) {
    sample.words.fill(++written);
    lock->store(sample);
    if (written % 64 == 0) std::this_thread::yield();
  }
  done = true;
  for (std::thread& reader : readers) reader.join();
  EXPECT_EQ(torn.load(), 0U);
  EXPECT_EQ(backwards.load(), 0U);
}

TEST(Seqlock, NeitherSideAllocates) {
  if (!test::AllocationCounter::supported()) GTEST_SKIP() << "no allocation counter in this build";
  Seqlock<Sample> lock;
  Sample sample;
  const test::AllocationCounter counter;
  lock.store(sample);
  EXPECT_TRUE(lock.load(sample));
  EXPECT_EQ(counter.count(), 0);
}

}  // namespace
}  // namespace artus
