#include "wunderlich/sweep/figures.hpp"

#include <charconv>
#include <limits>

#include "wunderlich/io/summary_json.hpp"

namespace wunderlich::sweep {

using Json = nlohmann::ordered_json;

namespace {

/// `energy.normalized`, `ends.1.force.0`, `kappa_zeros.count`, `shape.max_kappa`: in the summary, or at the top.
const Json* at_path(const Json& body, const std::string& path) {
  const Json* here = path.compare(0, 6, "shape.") == 0 ? &body : body.contains("summary") ? &body["summary"] : nullptr;
  for (std::size_t begin = 0; here != nullptr && begin <= path.size();) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    const std::string part = path.substr(begin, end - begin);
    begin = end + 1;
    if (here->is_array() && !part.empty() && part.find_first_not_of("0123456789") == std::string::npos) {
      std::size_t index = here->size();
      std::from_chars(part.data(), part.data() + part.size(), index);
      here = index < here->size() ? &(*here)[index] : nullptr;
    } else {
      here = here->is_object() && here->contains(part) ? &(*here)[part] : nullptr;
    }
  }
  return here;
}

/// A run that has everything a run can have.
Json example() {
  Summary summary;
  summary.contact.emplace();
  summary.closure_error = 0;
  summary.ends.resize(2);
  summary.stability.emplace();
  Json shape = {{"max_kappa", 0}, {"max_tau", 0}, {"max_eta", 0}};
  return {{"summary", Json::parse(io::summary_json(summary))}, {"shape", shape}};
}

void add_names(const Json& value, const std::string& path, std::vector<std::string>& names) {
  if (value.is_number() || value.is_boolean()) names.push_back(path);
  if (value.is_array()) names.push_back(path + ".count");
  if (!value.is_object()) return;
  for (const auto& [name, item] : value.items()) add_names(item, path.empty() ? name : path + "." + name, names);
}

}  // namespace

double figure(const Json& body, const std::string& path) {
  constexpr std::string_view count = ".count";
  if (path.size() > count.size() && path.compare(path.size() - count.size(), count.size(), count) == 0) {
    const Json* list = at_path(body, path.substr(0, path.size() - count.size()));
    return list != nullptr && list->is_array() ? static_cast<double>(list->size()) : kNone;
  }
  const Json* value = at_path(body, path);
  if (value == nullptr) return kNone;
  if (value->is_boolean()) return value->get<bool>() ? 1 : 0;
  return value->is_number() ? value->get<double>() : kNone;
}

bool is_figure(const std::string& path) {
  // Lists may be longer than in the example, and of numbers.
  return figure(example(), path) == figure(example(), path) ||
         (path.compare(0, 12, "kappa_zeros.") == 0 && path.find_first_not_of("0123456789", 12) == std::string::npos);
}

std::vector<std::string> figure_names() {
  const Json all = example();
  std::vector<std::string> names;
  add_names(all["summary"], "", names);
  add_names(all["shape"], "shape", names);
  return names;
}

}  // namespace wunderlich::sweep
