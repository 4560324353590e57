#include "wunderlich/scene/text.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace wunderlich::scene {
namespace {

constexpr double pi = std::numbers::pi;

TEST(ParseNumber, ReadsDecimalsAndMultiplesOfPi) {
  const std::vector<std::pair<std::string, double>> cases = {
      {"0", 0},
      {"-1", -1},
      {"+2.5", 2.5},
      {".5", 0.5},
      {"5.", 5},
      {"1e-3", 1e-3},
      {"1.5E+2", 150},
      {"pi", pi},
      {"-pi", -pi},
      {"2pi", 2 * pi},
      {"2 pi", 2 * pi},
      {"-pi/2", -pi / 2},
      {"5/2 pi", 2.5 * pi},
      {"5*pi/4", 5 * pi / 4},
      {"5pi/4", 5 * pi / 4},
      {"1/3", 1.0 / 3.0},
      {"2 * 3 / 4", 1.5},
      {"1e2pi", 100 * pi},
      {" 7 ", 7},
      {"250*pi", 250 * pi},
  };
  for (const auto& [text, value] : cases) {
    const auto parsed = parse_number(text);
    ASSERT_TRUE(parsed.has_value()) << text;
    EXPECT_DOUBLE_EQ(*parsed, value) << text;
  }
}

TEST(ParseNumber, RefusesEverythingElse) {
  for (const char* text :
       {"",    " ",    "-",   "e5", ".",  "1e",   "0x10", "1_000", "1,5", "nan", ".nan",   ".inf", "inf",
        "1 2", "pi 2", "pie", "2*", "/2", "1//2", "--1",  "1-2",   "pip", "one", "1 pi 2", "2**3", "1e5e5"}) {
    EXPECT_FALSE(parse_number(text).has_value()) << text;
  }
}

TEST(ParseNumber, SaysInfinityForWhatIsTooLarge) {
  EXPECT_TRUE(std::isinf(parse_number("1e999").value()));
  EXPECT_TRUE(std::isinf(parse_number("1/0").value()));
  EXPECT_TRUE(std::isinf(parse_number("1e200*1e200").value()));
  EXPECT_EQ(parse_number("1e-999").value(), 0);
}

TEST(ParseWhole, TakesDigitsOnly) {
  EXPECT_EQ(parse_whole("50"), 50);
  EXPECT_EQ(parse_whole("-3"), -3);
  for (const char* text : {"", "-", "5.0", "1e3", "0x1", "99999999999999999999", " 5"}) {
    EXPECT_FALSE(parse_whole(text).has_value()) << text;
  }
}

TEST(Nearest, FindsTypingErrorsAndNothingElse) {
  const std::vector<std::string> words{"length", "width", "segments", "closure"};
  EXPECT_EQ(nearest("lenght", words), "length");
  EXPECT_EQ(nearest("widht", words), "width");
  EXPECT_EQ(nearest("segment", words), "segments");
  EXPECT_EQ(nearest("colour", words), "");
  EXPECT_EQ(nearest("gravity", words), "");
  EXPECT_EQ(nearest(std::string(100000, 'a'), words), "");
}

TEST(FirstBadByte, AcceptsTextAndRefusesTheRest) {
  EXPECT_FALSE(
      first_bad_byte("a\tb\r\nM\xc3\xb6"
                     "bius \xe2\x82\xac \xf0\x9f\x98\x80"));
  for (const std::string bad :
       {"\xff", "\xc3", "\xc0\xaf", "\xed\xa0\x80", "\xf5\x80\x80\x80", "\x01", "\x80", "\xe2\x82"}) {
    EXPECT_EQ(first_bad_byte("ab" + bad), 2u);
  }
  EXPECT_EQ(first_bad_byte(std::string("a\0b", 3)), 1u);
}

TEST(Shown, IsOneShortLine) {
  EXPECT_EQ(shown("a\nb\x01"), "a b?");
  EXPECT_EQ(shown(std::string(100, 'x')), std::string(60, 'x') + "...");
  EXPECT_EQ(shown("\xff"), "?");
}

}  // namespace
}  // namespace wunderlich::scene
