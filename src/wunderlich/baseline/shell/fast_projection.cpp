#include "wunderlich/baseline/shell/fast_projection.hpp"

#include <algorithm>
#include <cmath>

namespace wunderlich::baseline::shell {

namespace {

constexpr double kDependent = 1e-10;

int unknown_of(const Hold& hold, std::size_t axis, int point) {
  return hold.unknown[axis][static_cast<std::size_t>(point)];
}

/// For each unknown of each axis, the rows that it moves.
std::array<std::vector<std::vector<int>>, 3> rows_of_unknowns(const std::vector<Length>& rows, const Hold& hold) {
  std::array<std::vector<std::vector<int>>, 3> result;
  for (std::size_t a = 0; a < 3; ++a) {
    result[a].resize(static_cast<std::size_t>(hold.unknown_count[a]));
    for (std::size_t r = 0; r < rows.size(); ++r) {
      for (const int p : rows[r].points) {
        if (const int k = unknown_of(hold, a, p); k >= 0)
          result[a][static_cast<std::size_t>(k)].push_back(static_cast<int>(r));
      }
    }
  }
  return result;
}

/// How a row sees the unknown: +1, -1, or 0 where it moves both of its points alike.
double sign_of(const Length& row, const Hold& hold, std::size_t axis, int unknown) {
  return (unknown_of(hold, axis, row.points[1]) == unknown ? 1.0 : 0.0) -
         (unknown_of(hold, axis, row.points[0]) == unknown ? 1.0 : 0.0);
}

/// Adds the products of all pairs of rows that share an unknown; `value` is filled in later.
void add_products(LengthSystem& system, const Hold& hold) {
  const auto rows_of = rows_of_unknowns(system.rows, hold);
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t k = 0; k < rows_of[a].size(); ++k) {
      for (const int r : rows_of[a][k]) {
        for (const int s : rows_of[a][k]) {
          if (s > r) continue;
          const auto sign = [&](int i) {
            return sign_of(system.rows[static_cast<std::size_t>(i)], hold, a, static_cast<int>(k));
          };
          RowProduct product{0, r, s, Vec3::Zero()};
          product.weight[static_cast<int>(a)] = sign(r) * sign(s) / hold.mass[a][k];
          if (product.weight[static_cast<int>(a)] != 0) system.products.push_back(product);
        }
      }
    }
  }
  const auto before = [](const RowProduct& p, const RowProduct& q) {
    return p.row != q.row ? p.row < q.row : p.other < q.other;
  };
  std::sort(system.products.begin(), system.products.end(), before);
  std::vector<RowProduct> merged;
  for (const RowProduct& p : system.products) {
    const bool same = !merged.empty() && merged.back().row == p.row && merged.back().other == p.other;
    if (same) merged.back().weight += p.weight;
    if (!same) merged.push_back(p);
  }
  system.products = std::move(merged);
}

void assemble(LengthSystem& system) {
  double* values = system.matrix.valuePtr();
  double largest = 0;
  for (const RowProduct& p : system.products) {
    const double value =
        system.direction.row(p.row).cwiseProduct(system.direction.row(p.other)).dot(p.weight.transpose());
    values[p.value] = value;
    if (p.row == p.other) largest = std::max(largest, value);
  }
  for (const RowProduct& p : system.products) {
    if (p.row == p.other) values[p.value] += kDependent * largest;
  }
}

}  // namespace

LengthSystem make_length_system(const std::vector<Length>& set, const Hold& hold) {
  LengthSystem system;
  for (const Length& row : set) {
    bool moves = false;
    for (std::size_t a = 0; a < 3; ++a)
      moves |= unknown_of(hold, a, row.points[0]) != unknown_of(hold, a, row.points[1]);
    if (moves) system.rows.push_back(row);
  }
  add_products(system, hold);
  const auto count = static_cast<Eigen::Index>(system.rows.size());
  std::vector<Eigen::Triplet<double>> triplets;
  for (const RowProduct& p : system.products) triplets.emplace_back(p.row, p.other, 1.0);
  system.matrix.resize(count, count);
  system.matrix.setFromTriplets(triplets.begin(), triplets.end());
  for (RowProduct& p : system.products) {
    p.value = static_cast<int>(&system.matrix.coeffRef(p.row, p.other) - system.matrix.valuePtr());
  }
  system.factor = std::make_unique<Factor>();
  system.factor->analyzePattern(system.matrix);
  system.direction.resize(count, 3);
  system.residual.resize(count);
  return system;
}

void linearise(LengthSystem& system, const Points& x) {
  for (std::size_t r = 0; r < system.rows.size(); ++r) {
    const Length& row = system.rows[r];
    const Vec3 d = (x.row(row.points[1]) - x.row(row.points[0])).transpose();
    const auto i = static_cast<Eigen::Index>(r);
    system.direction.row(i) = d.transpose() / row.rest;
    system.residual[i] = 0.5 * (d.squaredNorm() / row.rest - row.rest);
  }
}

double max_length_error(const std::vector<Length>& rows, const Points& x) {
  double error = 0;
  for (const Length& row : rows) {
    error = std::max(error, std::abs((x.row(row.points[1]) - x.row(row.points[0])).norm() / row.rest - 1));
  }
  return error;
}

bool project_lengths(LengthSystem& system, const Hold& hold, Points& x) {
  if (system.rows.empty()) return true;
  linearise(system, x);
  assemble(system);
  system.factor->factorize(system.matrix);
  if (system.factor->info() != Eigen::Success) return false;
  const Eigen::VectorXd lambda = system.factor->solve(system.residual);
  for (std::size_t a = 0; a < 3; ++a) {
    const auto column = static_cast<Eigen::Index>(a);
    Eigen::VectorXd change = Eigen::VectorXd::Zero(hold.unknown_count[a]);
    for (std::size_t r = 0; r < system.rows.size(); ++r) {
      const auto i = static_cast<Eigen::Index>(r);
      const double pull = lambda[i] * system.direction(i, column);
      const int from = unknown_of(hold, a, system.rows[r].points[0]),
                to = unknown_of(hold, a, system.rows[r].points[1]);
      if (from >= 0) change[from] += pull / hold.mass[a][static_cast<std::size_t>(from)];
      if (to >= 0) change[to] -= pull / hold.mass[a][static_cast<std::size_t>(to)];
    }
    add_change(hold, a, change, x);
  }
  return true;
}

BoundarySystem make_boundary_system(const Sparse& boundary, const Hold& hold) {
  BoundarySystem system;
  if (boundary.rows() == 0) return system;
  for (std::size_t a = 0; a < 3; ++a) {
    const Sparse rows = boundary * selection(hold, a);
    Eigen::VectorXd mobility(hold.unknown_count[a]);
    for (Eigen::Index k = 0; k < mobility.size(); ++k) mobility[k] = 1 / hold.mass[a][static_cast<std::size_t>(k)];
    system.to_unknowns[a] = mobility.asDiagonal() * Sparse(rows.transpose());
    Sparse matrix = rows * system.to_unknowns[a];
    Sparse shift(matrix.rows(), matrix.cols());
    shift.setIdentity();
    matrix += kDependent * matrix.diagonal().maxCoeff() * shift;
    system.factor[a] = std::make_unique<Factor>(matrix);
  }
  return system;
}

bool project_boundary(const BoundarySystem& system, const Sparse& boundary, const Hold& hold, Points& x) {
  if (boundary.rows() == 0) return true;
  for (std::size_t a = 0; a < 3; ++a) {
    if (system.factor[a]->info() != Eigen::Success) return false;
    const Eigen::VectorXd residual = boundary * x.col(static_cast<Eigen::Index>(a));
    add_change(hold, a, -(system.to_unknowns[a] * system.factor[a]->solve(residual)), x);
  }
  return true;
}

}  // namespace wunderlich::baseline::shell
