// Logs of results: what a killed writer leaves is harmless.
#include "wunderlich/sweep/store.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "wunderlich/base/error.hpp"

namespace wunderlich::sweep {
namespace {

namespace fs = std::filesystem;

class StoreTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = fs::temp_directory_path() / ("wunderlich-store-" + std::to_string(::getpid()));
    fs::remove_all(folder);
  }
  void TearDown() override { fs::remove_all(folder); }

  static Record record(int i) {
    return {"key" + std::to_string(i), Status::done, "", 0, "{\"summary\":{\"time\":" + std::to_string(i) + "}}"};
  }
  fs::path log() const { return folder / "results" / "all.log"; }

  fs::path folder;
};

TEST(RecordLine, ComesBackAndKnowsDamage) {
  const Record record{"abc", Status::timed_out, "took \"long\"\nenough", 0.125, "{\"a\":[1,2.5]}"};
  std::string line = line_of(record);
  ASSERT_EQ(std::count(line.begin(), line.end(), '\n'), 1);
  line.pop_back();
  const auto again = parse_line(line);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->key, record.key);
  EXPECT_EQ(again->status, record.status);
  EXPECT_EQ(again->reason, record.reason);
  EXPECT_EQ(again->seconds, record.seconds);
  EXPECT_EQ(again->body, record.body);
  for (std::size_t i = 0; i < line.size(); ++i) {
    std::string damaged = line;
    damaged[i] = static_cast<char>(damaged[i] ^ 1);
    EXPECT_FALSE(parse_line(damaged)) << i;
    EXPECT_FALSE(parse_line(line.substr(0, i))) << i;
  }
}

TEST_F(StoreTest, FindsWhatWasAdded) {
  {
    Writer writer(folder, "all");
    for (int i = 0; i < 10; ++i) writer.add(record(i));
  }
  Store store(folder);
  EXPECT_EQ(store.size(), 10u);
  ASSERT_NE(store.find("key7"), nullptr);
  EXPECT_EQ(store.read(*store.find("key7")).body, record(7).body);
  EXPECT_EQ(store.find("key10"), nullptr);
}

TEST_F(StoreTest, ALineTornAnywhereIsCutOffAndTheRestGoesOn) {
  const std::string third = line_of(record(2));
  for (std::size_t cut = 0; cut < third.size(); cut += 7) {
    fs::remove_all(folder);
    {
      Writer writer(folder, "all");
      for (int i = 0; i < 3; ++i) writer.add(record(i));
    }
    fs::resize_file(log(), fs::file_size(log()) - third.size() + cut);
    EXPECT_EQ(Store(folder).size(), 2u);  // before anybody mends it
    {
      Writer writer(folder, "all");
      writer.add(record(5));
    }
    Store store(folder);
    EXPECT_EQ(store.size(), 3u) << cut;
    EXPECT_NE(store.find("key5"), nullptr);
    EXPECT_EQ(store.find("key2"), nullptr);
  }
}

TEST_F(StoreTest, HasOneWriterAtATime) {
  const Writer writer(folder, "all");
  EXPECT_THROW(Writer(folder, "all"), InputError);
  EXPECT_NO_THROW(Writer(folder, "shard-1-of-2"));
}

}  // namespace
}  // namespace wunderlich::sweep
