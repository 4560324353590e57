#include <cstdlib>
#include <limits>
#include <locale>
#include <nlohmann/json.hpp>
#include <sstream>

#include "io/sample.hpp"
#include "wunderlich/base/version.hpp"
#include "wunderlich/io/csv.hpp"
#include "wunderlich/io/summary_json.hpp"

namespace wunderlich::io {
namespace {

using testing::input_error;
using testing::sample_run;

std::vector<std::vector<std::string>> cells(const std::string& csv) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream fields(line);
    rows.emplace_back();
    for (std::string field; std::getline(fields, field, ',');) rows.back().push_back(field);
  }
  return rows;
}

struct CommaLocale : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  std::string do_grouping() const override { return "\3"; }
};

TEST(CenterlineCsv, HasTheAgreedColumnsAndExactNumbers) {
  const auto samples = sample_run().frames.back().centerline;
  const std::locale before = std::locale::global(std::locale(std::locale(), new CommaLocale));
  const auto rows = cells(centerline_csv(samples));
  std::locale::global(before);
  const std::vector<std::string> header{"u",   "x",   "y",   "z",   "d1x",   "d1y", "d1z", "d2x",      "d2y",
                                        "d2z", "d3x", "d3y", "d3z", "kappa", "tau", "eta", "eta_prime"};
  EXPECT_EQ(rows.front(), header);
  ASSERT_EQ(rows.size(), samples.size() + 1);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    ASSERT_EQ(rows[i + 1].size(), header.size());
    const auto value = [&](std::size_t k) { return std::strtod(rows[i + 1][k].c_str(), nullptr); };
    EXPECT_EQ(value(0), samples[i].u);
    EXPECT_EQ(value(3), samples[i].r.z());
    EXPECT_EQ(value(5), samples[i].d1.y());
    EXPECT_EQ(value(12), samples[i].d3.z());
    EXPECT_EQ(value(13), samples[i].kappa);
    EXPECT_EQ(value(14), samples[i].tau);
    EXPECT_EQ(value(15), samples[i].eta);
    EXPECT_EQ(value(16), samples[i].eta_prime);
  }
}

TEST(HistoryCsv, HasTheAgreedColumns) {
  const RunOutput run = sample_run();
  const auto rows = cells(history_csv(run.history));
  EXPECT_EQ(rows.front(), (std::vector<std::string>{"time", "elastic", "kinetic", "gravity", "total",
                                                    "max_length_error", "max_torsion_mismatch", "max_ruling_ratio",
                                                    "area_error", "iterations", "step_us"}));
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[2], (std::vector<std::string>{"0.5", "0.1", "0.25", "-0.3333333333333333", "0.016666666666666663",
                                               "1e-15", "4e-15", "0.3", "0", "4", "0"}));
}

TEST(Tables, NeverHoldWhatIsNotANumber) {
  RunOutput run = sample_run();
  run.history[1].energy.kinetic = std::numeric_limits<double>::infinity();
  EXPECT_THROW(history_csv(run.history), std::domain_error);
  run.frames[0].centerline[2].tau = std::nan("");
  EXPECT_THROW(centerline_csv(run.frames[0].centerline), std::domain_error);
  run.summary.ends[1].torque.y() = std::nan("");
  try {
    summary_json(run.summary);
    FAIL();
  } catch (const std::domain_error& error) {
    EXPECT_STREQ(error.what(), "summary.json: ends.1.torque.1 is not finite");
  }
}

TEST(SummaryJson, HasTheAgreedKeys) {
  Summary summary = sample_run().summary;
  summary.closure_error = 1e-16;
  const auto json = nlohmann::json::parse(summary_json(summary));
  for (const char* key : {"program", "version", "scene", "model", "method", "converged", "segments", "time", "steps",
                          "energy", "constraints", "area_error", "timing", "closure_error", "ends", "stability",
                          "topology", "kappa_zeros", "warnings"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  EXPECT_EQ(json["program"], "wunderlich");
  EXPECT_EQ(json["version"], version);
  EXPECT_EQ(json["model"], "ribbon");
  EXPECT_EQ(json["converged"], true);
  for (const char* key : {"elastic", "kinetic", "gravity", "total", "normalized"})
    EXPECT_TRUE(json["energy"].contains(key));
  EXPECT_DOUBLE_EQ(json["energy"]["total"].get<double>(), 0.2 + 0.25 - 1.0 / 3);
  for (const char* key :
       {"max_length_error", "max_parallel_error", "max_binormal", "max_torsion_mismatch", "max_ruling_ratio"}) {
    EXPECT_TRUE(json["constraints"].contains(key)) << key;
  }
  for (const char* key : {"wall_seconds", "step_us_median", "step_us_p95", "iterations_mean"}) {
    EXPECT_TRUE(json["timing"].contains(key)) << key;
  }
  EXPECT_EQ(json["ends"][0]["force"], (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(json["ends"][1]["torque"], (std::vector<double>{0, 0.1, 0}));
  EXPECT_EQ(json["stability"]["negative_modes"], 0);
  for (const char* key : {"twist", "writhe", "link"}) EXPECT_TRUE(json["topology"].contains(key)) << key;
  EXPECT_FALSE(json.contains("failure"));
}

TEST(SummaryJson, LeavesOutWhatDoesNotApply) {
  Summary summary;
  summary.failure = "too many iterations";
  const auto json = nlohmann::json::parse(summary_json(summary));
  EXPECT_FALSE(json.contains("closure_error"));
  EXPECT_FALSE(json.contains("stability"));
  EXPECT_FALSE(json.contains("contact"));
  EXPECT_EQ(json["ends"], nlohmann::json::array());
  EXPECT_EQ(json["failure"], "too many iterations");
}

TEST(SummaryJson, ReadsBackAsItWas) {
  Summary summary = sample_run().summary;
  summary.closure_error = 1.0 / 3e16;
  summary.failure = "why \xff not";  // not UTF-8: written all the same
  const std::string text = summary_json(summary);
  const Summary read = parse_summary(text, "summary.json");
  EXPECT_EQ(summary_json(read), text);
  EXPECT_EQ(*read.closure_error, *summary.closure_error);
  EXPECT_EQ(read.timing.phases, summary.timing.phases);
  EXPECT_EQ(read.ends[1].torque, summary.ends[1].torque);
}

TEST(SummaryJson, RefusesWhatIsNoSummary) {
  for (const char* bad : {"", "{", "[]", "{}", "null", R"({"scene": 3})"}) {
    EXPECT_NE(input_error([&] { parse_summary(bad, "x/summary.json"); }).find("x/summary.json: not a summary"),
              std::string::npos)
        << bad;
  }
}

}  // namespace
}  // namespace wunderlich::io
