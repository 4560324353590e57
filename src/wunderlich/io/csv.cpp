#include "wunderlich/io/csv.hpp"

#include <fmt/format.h>

#include <cmath>
#include <initializer_list>
#include <stdexcept>

namespace wunderlich::io {

namespace {

/// Shortest text that reads back as the same double, whatever the locale.
void add_row(std::string& out, std::initializer_list<double> values, const char* file) {
  const char* separator = "";
  for (const double value : values) {
    if (!std::isfinite(value)) throw std::domain_error(fmt::format("{}: a value is not finite", file));
    fmt::format_to(std::back_inserter(out), "{}{}", separator, value);
    separator = ",";
  }
  out += '\n';
}

}  // namespace

std::string centerline_csv(const std::vector<CenterlineSample>& centerline) {
  std::string out = "u,x,y,z,d1x,d1y,d1z,d2x,d2y,d2z,d3x,d3y,d3z,kappa,tau,eta,eta_prime";
  const bool several = !centerline.empty() && centerline.back().ribbon > 0;
  out += several ? ",ribbon\n" : "\n";
  for (const CenterlineSample& p : centerline) {
    add_row(out,
            {p.u, p.r.x(), p.r.y(), p.r.z(), p.d1.x(), p.d1.y(), p.d1.z(), p.d2.x(), p.d2.y(), p.d2.z(), p.d3.x(),
             p.d3.y(), p.d3.z(), p.kappa, p.tau, p.eta, p.eta_prime},
            "centerline.csv");
    if (several) out.insert(out.size() - 1, fmt::format(",{}", p.ribbon));
  }
  return out;
}

std::string history_csv(const std::vector<HistoryRow>& history) {
  std::string out =
      "time,elastic,kinetic,gravity,total,max_length_error,max_torsion_mismatch,max_ruling_ratio,area_error,iterations,"
      "step_us\n";
  for (const HistoryRow& row : history) {
    add_row(out,
            {row.time, row.energy.elastic, row.energy.kinetic, row.energy.gravity, row.energy.total(),
             row.constraints.max_length_error, row.constraints.max_torsion_mismatch, row.constraints.max_ruling_ratio,
             row.area_error, static_cast<double>(row.iterations), row.step_us},
            "history.csv");
  }
  return out;
}

}  // namespace wunderlich::io
