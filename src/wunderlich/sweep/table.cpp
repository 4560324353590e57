#include "wunderlich/sweep/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "wunderlich/base/error.hpp"
#include "wunderlich/base/version.hpp"
#include "wunderlich/io/bytes.hpp"
#include "wunderlich/io/file.hpp"
#include "wunderlich/io/packed_mesh.hpp"
#include "wunderlich/scene/read.hpp"
#include "wunderlich/sweep/figures.hpp"
#include "wunderlich/sweep/slurm.hpp"

namespace wunderlich::sweep {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::ordered_json;

bool is_timing(const Collected& result) { return result.path.compare(0, 7, "timing.") == 0; }

/// Text as one cell.
std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c == '\n' ? ' ' : c;
  }
  out += '"';
  return out;
}

std::string number_cell(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

std::vector<double> decoded(const std::string& base64) {
  static const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int held = 0;
  for (const char c : base64) {
    const std::size_t value = letters.find(c);
    if (value == std::string::npos) break;
    bits = (bits << 6) | static_cast<std::uint32_t>(value);
    held += 6;
    if (held < 8) continue;
    held -= 8;
    bytes += static_cast<char>((bits >> held) & 0xff);
  }
  std::vector<double> out(bytes.size() / sizeof(double));
  std::memcpy(out.data(), bytes.data(), out.size() * sizeof(double));
  return out;
}

/// NumPy's format 1.0 (numpy.lib.format): a little-endian double array in row order.
std::string npy_header(std::size_t rows, std::size_t columns) {
  std::string dict = fmt::format("{{'descr': '<f8', 'fortran_order': False, 'shape': ({}, {}), }}", rows, columns);
  dict.append(63 - (10 + dict.size()) % 64, ' ');
  dict += '\n';
  std::string out("\x93NUMPY\x01\x00", 8);
  io::append(out, static_cast<std::uint16_t>(dict.size()));
  return out + dict;
}

struct Row {
  std::string key;
  std::optional<Record> record;
  Json body;
};

/// Rows one after the other: only one is in memory.
template <class Visit>
void each_row(const Sweep& sweep, Store& store, Visit visit) {
  for (std::size_t run = 0; run < run_count(sweep); ++run) {
    Row row{key_of(sweep, run), {}, {}};
    if (const Found* found = store.find(row.key)) {
      row.record = store.read(*found);
      if (!row.record->body.empty()) row.body = Json::parse(row.record->body);
    }
    visit(run, row);
  }
}

/// Writes under another name first.
class Stream {
 public:
  explicit Stream(const fs::path& path)
      : path_(path), draft_(io::sibling(path, "partial")), out_(draft_, std::ios::binary) {}
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;
  ~Stream() {
    std::error_code ignored;
    fs::remove(draft_, ignored);
  }
  Stream& operator<<(const std::string& text) {
    out_ << text;
    return *this;
  }
  void finish() {
    out_.close();
    if (!out_) throw InputError(path_.string() + ": cannot be written");
    fs::rename(draft_, path_);
  }

 private:
  fs::path path_, draft_;
  std::ofstream out_;
};

std::string head_row(const Sweep& sweep) {
  std::string out = "run,key";
  for (const Axis& axis : sweep.axes) {
    for (const std::string& name : axis.columns) out += fmt::format(",{}", cell(name));
  }
  out += ",status,reason";
  for (const bool timing : {false, true}) {
    for (const Collected& result : sweep.collected) {
      if (is_timing(result) == timing) out += fmt::format(",{}", cell(result.name));
    }
  }
  out += ",run_seconds\n";
  return out;
}

std::string csv_row(const Sweep& sweep, std::size_t run, const Row& row) {
  std::string out = fmt::format("{},{}", run, row.key);
  const std::vector<std::size_t> place = place_of(sweep, run);
  for (std::size_t a = 0; a < place.size(); ++a) {
    for (const std::string& word : sweep.axes[a].points[place[a]].words) out += fmt::format(",{}", cell(word));
  }
  out += row.record ? fmt::format(",{},{}", status_name(row.record->status), cell(row.record->reason)) : ",,";
  for (const bool timing : {false, true}) {
    for (const Collected& result : sweep.collected) {
      if (is_timing(result) == timing) out += fmt::format(",{}", number_cell(figure(row.body, result.path)));
    }
  }
  return out + fmt::format(",{}\n", number_cell(row.record && row.record->seconds > 0 ? row.record->seconds : kNone));
}

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

/// What the page draws: axes with their values, and one array a result.
struct PageData {
  Json axes = Json::array(), status = Json::array(), keys = Json::array(), results = Json::object(),
       reasons = Json::object();

  explicit PageData(const Sweep& sweep) {
    for (const Axis& axis : sweep.axes) {
      Json values = Json::array(), words = Json::array();
      for (const AxisPoint& point : axis.points) {
        Json numbers = Json::array();
        for (const double value : point.values) numbers.push_back(number_or_null(value));
        values.push_back(numbers);
        words.push_back(point.words);
      }
      axes.push_back({{"columns", axis.columns}, {"log", axis.logarithmic}, {"values", values}, {"words", words}});
    }
    for (const Collected& result : sweep.collected) results[result.name] = Json::array();
  }

  void add(const Sweep& sweep, const Row& row) {
    keys.push_back(row.key);
    status.push_back(row.record ? status_name(row.record->status) : "open");
    if (row.record && !row.record->reason.empty()) reasons[row.key] = row.record->reason;
    for (const Collected& result : sweep.collected) {
      results[result.name].push_back(number_or_null(figure(row.body, result.path)));
    }
  }
};

/// How the base scene is run: by its name if it is a shipped one, else from the sweep's folder.
std::string base_command(const Sweep& sweep) {
  const auto& shipped = scene::shipped_scenes();
  const bool known = std::any_of(shipped.begin(), shipped.end(), [&](const scene::ShippedScene& s) {
    return s.name == sweep.scene_name && scene::read_scene(s.name).written == sweep.scene_text;
  });
  return "wunderlich run " + (known ? sweep.scene_name : std::string(kSceneFile));
}

std::string command_of(const Sweep& sweep, const std::string& base, std::size_t run) {
  std::string out = base;
  for (const std::string& assignment : assignments_of(sweep, run)) out += " --set " + shell_word(assignment);
  return out;
}

/// HTML's own characters in a text.
std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '<')
      out += "&lt;";
    else if (c == '&')
      out += "&amp;";
    else
      out += c;
  }
  return out;
}

/// What is kept of a run, as a part of the page of all runs.
std::string run_entry(const Sweep& sweep, const std::string& base, std::size_t run, const Row& row) {
  if (!row.record) return "";
  std::string out = fmt::format("<h2 id=\"{}\">run {}: {}</h2>\n<pre>", row.key, run, status_name(row.record->status));
  if (!row.record->reason.empty()) out += escaped(row.record->reason) + "\n";
  out += escaped(command_of(sweep, base, run)) + "\n";
  out += escaped(row.record->body);  // as it is: taking it apart for a nicer look would cost a tenth of a small run
  return out + "</pre>\n";
}

std::string runs_head(const Sweep& sweep) {
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{0}: runs</title><style>body {{ font: "
      "14px/1.4 "
      "system-ui, sans-serif; margin: 2em }} h2 {{ font-size: 1em }} h2:target {{ background: #fde7b0 "
      "}}</style></head>\n"
      "<body><h1>{0}: runs</h1>\n",
      escaped(sweep.name));
}

std::size_t longest_field(const Sweep& sweep, Store& store) {
  std::size_t longest = 0;
  each_row(sweep, store, [&](std::size_t, const Row& row) {
    if (!row.body.contains("fields")) return;
    longest = std::max(longest, decoded(row.body["fields"].begin()->get<std::string>()).size());
  });
  return longest;
}

void write_fields(const fs::path& folder, const Sweep& sweep, Store& store) {
  if (sweep.fields.empty()) return;
  const std::size_t columns = longest_field(sweep, store);
  for (const std::string& field : sweep.fields) {
    Stream out(folder / (field + ".npy"));
    out << npy_header(run_count(sweep), columns);
    each_row(sweep, store, [&](std::size_t, const Row& row) {
      std::vector<double> values;
      if (row.body.contains("fields")) values = decoded(row.body["fields"][field].get<std::string>());
      values.resize(columns, kNone);
      std::string bytes;
      for (const double value : values) io::append(bytes, value);
      out << bytes;
    });
    out.finish();
  }
}

}  // namespace

std::size_t collect(const fs::path& folder, const Sweep& sweep, std::string_view page) {
  Store store(folder);
  Stream table(folder / "table.csv"), runs(folder / "runs.html");
  table << head_row(sweep);
  runs << runs_head(sweep);
  PageData data(sweep);
  const std::string base = base_command(sweep);
  std::size_t there = 0;
  each_row(sweep, store, [&](std::size_t run, const Row& row) {
    there += row.record.has_value();
    table << csv_row(sweep, run, row);
    data.add(sweep, row);
    runs << run_entry(sweep, base, run, row);
  });
  runs << "</body></html>\n";
  runs.finish();
  table.finish();
  write_fields(folder, sweep, store);
  const Json all = {{"name", sweep.name},
                    {"title", sweep.title},
                    {"scene", sweep.scene_name},
                    {"text", sweep.text},
                    {"program", program},
                    {"version", version},
                    {"axes", data.axes},
                    {"status", data.status},
                    {"keys", data.keys},
                    {"results", data.results},
                    {"reasons", data.reasons},
                    {"kept", std::find(sweep.keep.begin(), sweep.keep.end(), "html") != sweep.keep.end()}};
  io::write_file(folder / "report.html",
                 io::filled_page(page, all.dump(-1, ' ', false, Json::error_handler_t::replace)));
  return there;
}

}  // namespace wunderlich::sweep
