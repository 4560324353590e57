// Processes of a pool: what one does wrong harms no other.
#include "wunderlich/sweep/pool.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <map>
#include <thread>

namespace wunderlich::sweep {
namespace {

std::map<std::size_t, Done> run(const PoolOptions& options, std::size_t count,
                                const std::function<std::string(std::size_t)>& work) {
  std::map<std::size_t, Done> all;
  std::size_t given = 0;
  run_pool(
      options, [&] { return given < count ? static_cast<long>(given++) : -1L; }, work,
      [&](const Done& done) { EXPECT_TRUE(all.emplace(done.item, done).second) << done.item; }, [] { return true; });
  return all;
}

TEST(Pool, DoesEveryItemOnce) {
  const auto all = run({3, 0}, 100, [](std::size_t i) { return std::string(i, 'x'); });
  ASSERT_EQ(all.size(), 100u);
  for (const auto& [item, done] : all) {
    EXPECT_EQ(done.result.size(), item);
    EXPECT_TRUE(done.failure.empty());
  }
}

TEST(Pool, ResultsMayBeLarge) {
  const auto all = run({2, 0}, 4, [](std::size_t i) { return std::string(3'000'000 + i, 'y'); });
  for (const auto& [item, done] : all) EXPECT_EQ(done.result.size(), 3'000'000 + item);
}

TEST(Pool, OneThatDiesSaysHowAndTheOthersGoOn) {
  const auto all = run({2, 0}, 20, [](std::size_t i) {
    if (i == 3) std::raise(SIGKILL);
    if (i == 7) ::_exit(5);
    return std::to_string(i);
  });
  ASSERT_EQ(all.size(), 20u);
  EXPECT_NE(all.at(3).failure.find("signal 9"), std::string::npos);
  EXPECT_NE(all.at(7).failure.find("code 5"), std::string::npos);
  EXPECT_FALSE(all.at(3).timed_out);
  for (const auto& [item, done] : all) EXPECT_EQ(done.failure.empty(), item != 3 && item != 7) << item;
}

TEST(Pool, OneThatHangsIsEnded) {
  const auto start = std::chrono::steady_clock::now();
  const auto all = run({2, 0.3}, 6, [](std::size_t i) {
    if (i == 1) std::this_thread::sleep_for(std::chrono::hours(1));
    return std::to_string(i);
  });
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
  EXPECT_TRUE(all.at(1).timed_out);
  EXPECT_NE(all.at(1).failure.find("0.3 s"), std::string::npos);
  for (const auto& [item, done] : all) EXPECT_EQ(done.failure.empty(), item != 1) << item;
}

TEST(Pool, StopsWhenToldTo) {
  std::size_t given = 0, finished = 0;
  run_pool(
      {2, 0}, [&] { return static_cast<long>(given++); },
      [](std::size_t) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        return std::string();
      },
      [&](const Done&) { ++finished; }, [&] { return finished < 10; });
  EXPECT_GE(finished, 10u);
  EXPECT_LE(finished, 12u);
}

}  // namespace
}  // namespace wunderlich::sweep
