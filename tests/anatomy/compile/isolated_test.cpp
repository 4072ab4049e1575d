// SPDX-License-Identifier: AGPL-3.0-or-later
// Work that crashes, throws or hangs does so in its own process.
#include "artus/detail/anatomy/compile/mesh/isolated.h"

#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

namespace artus {
namespace {

constexpr double kPatience = 60;  // s

TEST(RunIsolated, GivesBackEveryByte) {
  std::string bytes(1'000'000, '\0');
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * i % 251);
  EXPECT_EQ(run_isolated([&] { return bytes; }, kPatience), bytes);
  EXPECT_EQ(run_isolated([] { return std::string(); }, kPatience), std::string());
}

TEST(RunIsolated, ACrashIsEmptyAndTheCallerLives) {
  EXPECT_EQ(run_isolated([]() -> std::string { std::abort(); }, kPatience), std::nullopt);
}

TEST(RunIsolated, AnExceptionIsEmpty) {
  EXPECT_EQ(run_isolated([]() -> std::string { throw std::runtime_error("no"); }, kPatience),
            std::nullopt);
}

TEST(RunIsolated, WhatHangsIsEndedWhenItsTimeIsUp) {
  const auto start = std::chrono::steady_clock::now();
  const auto result = run_isolated(
      []() -> std::string {
        for (;;) std::this_thread::sleep_for(std::chrono::seconds(1));
      },
      0.2);
  EXPECT_EQ(result, std::nullopt);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
}

TEST(RunIsolated, OfSeveralEachGivesItsOwnBytesInOrderHoweverManyRunAtOnce) {
  std::vector<std::function<std::string()>> works;
  for (int i = 0; i < 6; ++i)
    works.emplace_back([i]() -> std::string {
      if (i == 3) std::abort();
      std::this_thread::sleep_for(std::chrono::milliseconds(20 * (6 - i)));
      return std::string(100'000, static_cast<char>('a' + i));
    });
  for (const std::size_t at_once : {0U, 1U, 2U, 10U}) {
    const auto results = run_isolated(works, kPatience, at_once);
    ASSERT_EQ(results.size(), 6U);
    for (std::size_t i = 0; i < 6; ++i) {
      if (i == 3) {
        EXPECT_EQ(results[i], std::nullopt);
      } else {
        EXPECT_EQ(results[i], std::string(100'000, static_cast<char>('a' + i))) << i;
      }
    }
  }
}

TEST(PeakMemory, CountsAChildThatHeldMoreThanThis) {
  const double before = peak_memory();
  ASSERT_GT(before, 0);
  const auto more = static_cast<std::size_t>(before) + 50'000'000;
  const auto done = run_isolated(
      [more] {
        std::string held(more, 'x');  // written, so it is there
        return std::string(1, held[more / 2]);
      },
      kPatience);
  ASSERT_EQ(done, std::string("x"));
  EXPECT_GT(peak_memory(), before + 40'000'000);
}

TEST(RunIsolated, ChangesNothingInTheCaller) {
  int value = 1;
  const auto result = run_isolated(
      [&value] {
        value = 2;
        return std::to_string(value);
      },
      kPatience);
  EXPECT_EQ(result, "2");
  EXPECT_EQ(value, 1);
}

}  // namespace
}  // namespace artus
