// Cost of finding near edges of a strip, as its facets grow in number: of a strip straight, coiled, and in a pile.
// Counters: pairs found, and seconds per edge (200n is 200 ns).
#include <benchmark/benchmark.h>

#include <cmath>

#include "wunderlich/contact/near_pairs.hpp"

namespace {

using namespace wunderlich;
using contact::Extent;

enum class Form { straight, coil, pile };

/// Centerline and direction of the rulings at a share u of a strip 2 m long and 30 mm wide.
void place(Form form, double u, Vec3& r, Vec3& ruling) {
  if (form == Form::straight) {
    r = {2 * u, 0, 0};
    ruling = Vec3::UnitY();
  } else if (form == Form::coil) {
    const double angle = 2 / 0.03 * u;
    r = {0.03 * std::cos(angle), 0.03 * std::sin(angle), 0.1 * u};
    ruling = Vec3::UnitZ();
  } else {  // folds 80 mm long that turn in their plane, 1 mm above each other
    const double fold = 25 * u, way = 0.08 * std::abs(2 * (fold - std::floor(fold)) - 1);
    const Vec3 along(std::cos(7 * u), std::sin(7 * u), 0);
    r = (way - 0.04) * along + 0.025 * u * Vec3::UnitZ();
    ruling = along.cross(Vec3::UnitZ());
  }
}

/// Rims and rulings, widened by half of a millimetre.
std::vector<Extent> edges_of(Form form, int facets) {
  std::vector<Vec3> vertices;
  for (int i = 0; i <= facets; ++i) {
    Vec3 r, ruling;
    place(form, static_cast<double>(i) / facets, r, ruling);
    vertices.push_back(r - 0.015 * ruling);
    vertices.push_back(r + 0.015 * ruling);
  }
  std::vector<Extent> edges;
  const auto add = [&](std::size_t a, std::size_t b) {
    Extent edge{vertices[a], vertices[a]};
    edge.add(vertices[b]);
    edge.widen(5e-4);
    edges.push_back(edge);
  };
  for (std::size_t i = 0; i + 1 < vertices.size(); ++i) {
    if (i % 2 == 0) add(i, i + 1);
    if (i + 2 < vertices.size()) add(i, i + 2);
  }
  return edges;
}

void FindNear(benchmark::State& state, Form form) {
  const std::vector<Extent> edges = edges_of(form, static_cast<int>(state.range(0)));
  contact::ExtentTree tree;
  std::vector<contact::Near> pairs;
  for (auto _ : state) {
    contact::build_tree(edges, contact::grid_over(edges), tree);
    contact::find_near(tree, pairs);
    benchmark::ClobberMemory();
  }
  state.counters["pairs"] = static_cast<double>(pairs.size());
  state.counters["per_edge"] = benchmark::Counter(
      static_cast<double>(edges.size()), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void BuildTree(benchmark::State& state) {
  const std::vector<Extent> edges = edges_of(Form::pile, static_cast<int>(state.range(0)));
  contact::ExtentTree tree;
  for (auto _ : state) {
    contact::build_tree(edges, contact::grid_over(edges), tree);
    benchmark::ClobberMemory();
  }
}

#define SIZES ->Arg(100)->Arg(400)->Arg(1600)->Arg(6400)->Unit(benchmark::kMicrosecond)
BENCHMARK_CAPTURE(FindNear, straight, Form::straight) SIZES;
BENCHMARK_CAPTURE(FindNear, coil, Form::coil) SIZES;
BENCHMARK_CAPTURE(FindNear, pile, Form::pile) SIZES;
BENCHMARK(BuildTree) SIZES;

}  // namespace
