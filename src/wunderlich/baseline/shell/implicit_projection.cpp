#include "wunderlich/baseline/shell/implicit_projection.hpp"

#include <algorithm>

namespace wunderlich::baseline::shell {

namespace {

constexpr double kDependentRows = 1e-6;  // of the least that a row's own product can be

using Triplets = std::vector<Eigen::Triplet<double>>;

std::size_t at(int index) { return static_cast<std::size_t>(index); }

int column_of(const ImplicitSystem& system, const Hold& hold, std::size_t axis, int point) {
  const int unknown = hold.unknown[axis][at(point)];
  return unknown < 0 ? -1 : system.first[axis] + unknown;
}

/// A of the axes and the boundary rows, which stay as they are. Returns the largest value on A's diagonal.
double add_constant(const ImplicitSystem& system, const Shell& shell, const Hold& hold,
                    const std::array<Sparse, 3>& implicit, Triplets& out) {
  double largest = 0;
  int row = system.first[3] + static_cast<int>(system.rows.size());
  for (std::size_t a = 0; a < 3; ++a) {
    for (int k = 0; k < implicit[a].outerSize(); ++k) {
      for (Sparse::InnerIterator it(implicit[a], k); it; ++it) {
        if (it.row() < it.col()) continue;
        out.emplace_back(system.first[a] + static_cast<int>(it.row()), system.first[a] + k, it.value());
        if (it.row() == it.col()) largest = std::max(largest, it.value());
      }
    }
    const Sparse boundary = shell.boundary.rows() > 0 ? Sparse(shell.boundary * selection(hold, a)) : Sparse();
    for (int k = 0; k < boundary.outerSize(); ++k) {
      for (Sparse::InnerIterator it(boundary, k); it; ++it)
        out.emplace_back(row + static_cast<int>(it.row()), system.first[a] + k, it.value());
    }
    row += static_cast<int>(shell.boundary.rows());
  }
  return largest;
}

/// Residuals and gradients of the lengths at x, those into the matrix.
void linearise(ImplicitSystem& system, const Hold& hold, const Points& x) {
  double* values = system.matrix.valuePtr();
  for (const auto& points : system.place) {
    for (const auto& axes : points) {
      for (const int place : axes) {
        if (place >= 0) values[place] = 0;
      }
    }
  }
  for (std::size_t r = 0; r < system.rows.size(); ++r) {
    const Length& row = system.rows[r];
    const Vec3 d = (x.row(row.points[1]) - x.row(row.points[0])).transpose();
    system.right[system.first[3] + static_cast<int>(r)] = -0.5 * (d.squaredNorm() / row.rest - row.rest);
    for (std::size_t side = 0; side < 2; ++side) {
      for (std::size_t a = 0; a < 3; ++a) {
        const int place = system.place[r][side][a];
        const double sign = (side == 0 ? -1.0 : 1.0) * hold.sign[at(row.points[side])];
        if (place >= 0) values[place] += sign * d[static_cast<int>(a)] / row.rest;
      }
    }
  }
}

}  // namespace

ImplicitSystem make_implicit_system(const Shell& shell, const Hold& hold, const std::array<Sparse, 3>& implicit) {
  ImplicitSystem system;
  for (const auto& set : shell.lengths) {
    for (const Length& row : set) {
      if (can_move(row, hold)) system.rows.push_back(row);
    }
  }
  for (std::size_t a = 0; a < 3; ++a) system.first[a + 1] = system.first[a] + hold.unknown_count[a];
  const int size = system.first[3] + static_cast<int>(system.rows.size()) + 3 * static_cast<int>(shell.boundary.rows());
  Triplets triplets;
  const double largest = add_constant(system, shell, hold, implicit, triplets);
  for (int r = system.first[3]; r < size; ++r) triplets.emplace_back(r, r, -kDependentRows / largest);
  const auto each = [&](const auto& use) {
    for (std::size_t r = 0; r < system.rows.size(); ++r) {
      for (std::size_t side = 0; side < 2; ++side) {
        for (std::size_t a = 0; a < 3; ++a) use(r, side, a, column_of(system, hold, a, system.rows[r].points[side]));
      }
    }
  };
  each([&](std::size_t r, std::size_t, std::size_t, int column) {
    if (column >= 0) triplets.emplace_back(system.first[3] + static_cast<int>(r), column, 0.0);
  });
  system.matrix.resize(size, size);
  system.matrix.setFromTriplets(triplets.begin(), triplets.end());
  system.place.resize(system.rows.size());
  each([&](std::size_t r, std::size_t side, std::size_t a, int column) {
    double* values = system.matrix.valuePtr();
    system.place[r][side][a] =
        column < 0 ? -1
                   : static_cast<int>(&system.matrix.coeffRef(system.first[3] + static_cast<int>(r), column) - values);
  });
  system.factor = std::make_unique<Factor>();
  system.factor->analyzePattern(system.matrix);
  system.right.setZero(size);
  return system;
}

bool factor_at(ImplicitSystem& system, const Hold& hold, const Points& x) {
  system.right.setZero();
  linearise(system, hold, x);
  system.factor->factorize(system.matrix);
  return system.factor->info() == Eigen::Success;
}

void move_as_factored(ImplicitSystem& system, const Shell& shell, const Hold& hold, const Points& push, Points& x) {
  system.right.head(system.first[3]).setZero();
  int row = system.first[3] + static_cast<int>(system.rows.size());
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    for (int p = 0; p < shell.point_count(); ++p) {
      if (const int column = column_of(system, hold, a, p); column >= 0)
        system.right[column] += hold.sign[at(p)] * push(p, axis);
    }
    if (shell.boundary.rows() == 0) continue;
    system.right.segment(row, shell.boundary.rows()) = -(shell.boundary * x.col(axis));
    row += static_cast<int>(shell.boundary.rows());
  }
  const Eigen::VectorXd solution = system.factor->solve(system.right);
  for (std::size_t a = 0; a < 3; ++a) add_change(hold, a, solution.segment(system.first[a], hold.unknown_count[a]), x);
}

bool move_implicitly(ImplicitSystem& system, const Shell& shell, const Hold& hold, const Points& push, Points& x) {
  if (!factor_at(system, hold, x)) return false;
  move_as_factored(system, shell, hold, push, x);
  return true;
}

}  // namespace wunderlich::baseline::shell
