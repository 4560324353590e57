#include "wunderlich/io/checkpoint.hpp"

#include <cstring>
#include <limits>
#include <random>

#include "io/sample.hpp"
#include "wunderlich/io/bytes.hpp"

namespace wunderlich::io {
namespace {

using testing::input_error;
using CheckpointTest = testing::Folder;

Checkpoint sample() {
  Checkpoint out;
  out.texts = {{"scene", "ribbon: {}\n"}, {"", "empty key"}, {"unicode", "η′ \xff broken"}};
  out.arrays = {{"r",
                 {1.0 / 3, -0.0, 5e-324, 1.7976931348623157e308, std::numeric_limits<double>::quiet_NaN(),
                  -std::numeric_limits<double>::infinity(), 0.5}},
                {"none", {}}};
  return out;
}

TEST_F(CheckpointTest, KeepsEveryBit) {
  const Checkpoint in = sample();
  write_checkpoint(root / "checkpoint", in);
  const Checkpoint out = read_checkpoint(root / "checkpoint");
  EXPECT_EQ(out.texts, in.texts);
  ASSERT_EQ(out.arrays.size(), 2u);
  ASSERT_EQ(out.arrays.at("r").size(), in.arrays.at("r").size());
  EXPECT_EQ(std::memcmp(out.arrays.at("r").data(), in.arrays.at("r").data(), 7 * sizeof(double)), 0);
  EXPECT_TRUE(out.arrays.at("none").empty());
}

TEST_F(CheckpointTest, RefusesEveryCut) {
  const std::string whole = encode_checkpoint(sample());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_NE(input_error([&] { decode_checkpoint(whole.substr(0, size), "run/checkpoint"); }).find("run/checkpoint"),
              std::string::npos);
  }
  EXPECT_THROW(decode_checkpoint(whole + "x", "c"), InputError);
}

TEST_F(CheckpointTest, RefusesEveryFlippedBit) {
  const std::string whole = encode_checkpoint(sample());
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    std::string damaged = whole;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << bit % 8));
    EXPECT_THROW(decode_checkpoint(damaged, "c"), InputError) << "bit " << bit;
  }
}

TEST_F(CheckpointTest, RefusesAnotherVersionByName) {
  Checkpoint future = sample();
  future.version = 7;
  EXPECT_NE(input_error([&] { decode_checkpoint(encode_checkpoint(future), "c"); }).find("version 7"),
            std::string::npos);
}

std::string sealed(const std::string& payload) {
  std::string out = encode_checkpoint({}).substr(0, 12);
  append(out, static_cast<std::uint64_t>(payload.size()));
  append(out, checksum(payload));
  return out + payload;
}

/// Damage that the checksum does not see: the reader itself must hold.
TEST_F(CheckpointTest, SurvivesForgedContent) {
  const std::string whole = encode_checkpoint(sample());
  const std::string payload = whole.substr(28);
  ASSERT_EQ(sealed(payload), whole);
  std::mt19937 generator(1);
  int refused = 0;
  for (int k = 0; k < 20000; ++k) {
    std::string forged = payload;
    for (unsigned flips = 1 + generator() % 4; flips > 0; --flips) {
      forged[generator() % forged.size()] = static_cast<char>(generator());
    }
    if (k % 3 == 0) forged.resize(generator() % forged.size());
    try {
      decode_checkpoint(sealed(forged), "c");
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 10000);
  // An array of 2^60 elements; a number where an object belongs; an array that is no whole number of doubles.
  for (const char* bad : {"\x9b\x10", "\x01",
                          "\xa2\x65texts\xa0\x66"
                          "arrays\xa1\x61r\x41x"}) {
    EXPECT_THROW(decode_checkpoint(sealed(bad), "c"), InputError);
  }
}

}  // namespace
}  // namespace wunderlich::io
