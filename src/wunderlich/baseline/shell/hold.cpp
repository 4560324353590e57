#include "wunderlich/baseline/shell/hold.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace wunderlich::baseline::shell {

namespace {

using constraint::Orientation;
using constraint::Support;

double node_u(const Shell& shell, int node) { return shell.strip.length * node / shell.strip.segments; }

bool in_force(const Support& support, double time) { return time < support.release; }

/// Points that satisfy `test` of (u, v).
template <typename Test>
std::vector<int> points_where(const Shell& shell, Test&& test) {
  std::vector<int> points;
  for (int p = 0; p < shell.point_count(); ++p) {
    if (test(shell.flat[static_cast<std::size_t>(p)])) points.push_back(p);
  }
  return points;
}

std::vector<int> nearest_to(const Shell& shell, Vec2 weight, Vec2 center) {
  double nearest = std::numeric_limits<double>::infinity();
  const auto distance = [&](const Vec2& at) { return (at - center).cwiseProduct(weight).norm(); };
  for (const Vec2& at : shell.flat) nearest = std::min(nearest, distance(at));
  const double slack = 1e-6 * shell.mesh.cell_width;
  return points_where(shell, [&](const Vec2& at) { return distance(at) < nearest + slack; });
}

/// The point that a pin holds, or the two that have it in their middle: of all nearest ones, the farthest apart.
std::vector<int> pinned_points(const Shell& shell, int node) {
  const std::vector<int> nearest = nearest_to(shell, Vec2::Ones(), {node_u(shell, node), 0});
  if (nearest.size() < 2) return nearest;
  const auto gap = [&](int p) {
    return (shell.flat[static_cast<std::size_t>(p)] - shell.flat[static_cast<std::size_t>(nearest[0])]).norm();
  };
  return {nearest[0], *std::max_element(nearest.begin(), nearest.end(), [&](int p, int q) { return gap(p) < gap(q); })};
}

std::vector<int> held_points(const Shell& shell, const Support& support) {
  const double slack = 1e-6 * shell.mesh.cell_length;
  if (support.orientation == Orientation::free) return pinned_points(shell, support.node);
  if (support.segment < 0 && support.node == 0) {
    return points_where(shell, [&](const Vec2& at) { return at.x() < slack; });
  }
  if (support.segment < 0 && support.node == shell.strip.segments) {
    return points_where(shell, [&](const Vec2& at) { return at.x() > shell.strip.length - slack; });
  }
  const double middle = node_u(shell, support.segment < 0 ? support.node : support.segment) +
                        (support.segment < 0 ? 0 : 0.5 * shell.strip.length / shell.strip.segments);
  return points_where(shell, [&](const Vec2& at) { return std::abs(at.x() - middle) < shell.mesh.cell_length; });
}

bool moves_as_one(const Support& support) { return support.orientation == Orientation::full; }

bool is_pair(const Support& support, const std::vector<int>& points) {
  return support.orientation == Orientation::free && points.size() == 2;
}

/// Gives the coordinates that no support owns unknowns of their own.
void number_free(Hold& hold) {
  for (std::size_t a = 0; a < 3; ++a) {
    for (int& index : hold.unknown[a]) {
      if (index == -2) index = hold.unknown_count[a]++;
    }
  }
}

/// Points in the column nearest to the node.
std::vector<int> column_of(const Shell& shell, int node) {
  return nearest_to(shell, Vec2::UnitX(), {node_u(shell, node), 0});
}

void add_load(const Shell& shell, const constraint::Load& load, const Points& x, double time, Points& force) {
  const constraint::LoadKey key = constraint::load_at(load, time);
  const std::vector<int> column = column_of(shell, load.node);
  Vec3 center = Vec3::Zero();
  for (const int p : column) center += x.row(p).transpose() / static_cast<double>(column.size());
  Mat3 spread = Mat3::Zero();
  for (const int p : column) {
    const Vec3 arm = x.row(p).transpose() - center;
    spread += arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose();
    force.row(p) += key.force.transpose() / static_cast<double>(column.size());
  }
  if (key.torque.isZero()) return;
  // Points in one line cannot take a torque about it.
  const Vec3 turn = spread.fullPivLu().solve(key.torque);
  for (const int p : column) force.row(p) += turn.cross(x.row(p).transpose() - center).transpose();
}

}  // namespace

std::string unsupported(const geometry::RibbonSpec& strip, const constraint::Surroundings& surroundings) {
  if (strip.closure == geometry::Closure::loop) return "the shells are open strips";
  if (!strip.spacing.empty()) return "the shells have columns of equal length";
  if (surroundings.contact.self) return "the shells do not feel themselves";
  for (const Support& support : surroundings.supports) {
    if (support.orientation == Orientation::about_tangent)
      return "the shells know no support that turns about the tangent";
  }
  for (const constraint::Load& load : surroundings.loads) {
    if (load.frame == constraint::LoadFrame::material) return "the shells know no load in material axes";
  }
  return {};
}

std::string overlapping(const Shell& shell, const constraint::Surroundings& surroundings) {
  std::array<std::vector<bool>, 3> owned;
  for (auto& axis : owned) axis.assign(static_cast<std::size_t>(shell.point_count()), false);
  for (const Support& support : surroundings.supports) {
    const std::vector<int> points = held_points(shell, support);
    for (std::size_t a = 0; a < 3; ++a) {
      if (!support.hold_position[a] && !moves_as_one(support)) continue;
      for (const int p : points) {
        if (owned[a][static_cast<std::size_t>(p)]) return "two supports hold one point of the mesh";
        owned[a][static_cast<std::size_t>(p)] = true;
      }
    }
  }
  return {};
}

double largest_shift(const Shell& shell, const constraint::Surroundings& surroundings) {
  double most = 0;
  for (const Support& support : surroundings.supports) {
    if (support.orientation != Orientation::free) continue;
    const std::vector<int> points = pinned_points(shell, support.node);
    const Vec2 middle = 0.5 * (shell.flat[static_cast<std::size_t>(points.front())] +
                               shell.flat[static_cast<std::size_t>(points.back())]);
    most = std::max(most, (middle - Vec2(node_u(shell, support.node), 0)).norm());
  }
  for (const constraint::Load& load : surroundings.loads) {
    const std::vector<int> points = column_of(shell, load.node);
    double u = 0;
    for (const int p : points) u += shell.flat[static_cast<std::size_t>(p)].x() / static_cast<double>(points.size());
    most = std::max(most, std::abs(u - node_u(shell, load.node)));
  }
  return most;
}

Hold make_hold(const Shell& shell, const constraint::Surroundings& surroundings, double time) {
  const auto count = static_cast<std::size_t>(shell.point_count());
  Hold hold;
  for (auto& axis : hold.unknown) axis.assign(count, -2);
  hold.sign.assign(count, 1);
  for (const Support& support : surroundings.supports) {
    if (!in_force(support, time)) continue;
    const std::vector<int> points = held_points(shell, support);
    if (is_pair(support, points)) hold.sign[static_cast<std::size_t>(points[1])] = -1;
    for (std::size_t a = 0; a < 3; ++a) {
      if (!support.hold_position[a] && !moves_as_one(support)) continue;
      const bool alone = support.hold_position[a] && !is_pair(support, points);
      const int index = alone ? -1 : hold.unknown_count[a]++;
      for (const int p : points) hold.unknown[a][static_cast<std::size_t>(p)] = index;
    }
  }
  number_free(hold);
  for (std::size_t a = 0; a < 3; ++a) {
    hold.mass[a].assign(static_cast<std::size_t>(hold.unknown_count[a]), 0);
    for (std::size_t p = 0; p < count; ++p) {
      if (hold.unknown[a][p] >= 0) hold.mass[a][static_cast<std::size_t>(hold.unknown[a][p])] += shell.mass[p];
    }
  }
  return hold;
}

void set_offset(const Shell& shell, const constraint::Surroundings& surroundings, double start, double time,
                Points& offset) {
  offset.setZero(shell.point_count(), 3);
  for (const Support& support : surroundings.supports) {
    if (!in_force(support, start)) continue;
    const Pose pose = constraint::pose_at(support.motion, time);
    const double u = node_u(shell, support.node);
    for (const int p : held_points(shell, support)) {
      const Vec2& flat = shell.flat[static_cast<std::size_t>(p)];
      const Vec3 arm = moves_as_one(support) ? Vec3(pose.frame * Vec3(0, flat.y(), flat.x() - u)) : Vec3::Zero();
      for (int a = 0; a < 3; ++a) {
        if (support.hold_position[static_cast<std::size_t>(a)]) offset(p, a) = pose.position[a] + arm[a];
        if (!support.hold_position[static_cast<std::size_t>(a)]) offset(p, a) = arm[a];
      }
    }
  }
}

Sparse selection(const Hold& hold, std::size_t axis) {
  std::vector<Eigen::Triplet<double>> triplets;
  for (std::size_t p = 0; p < hold.unknown[axis].size(); ++p) {
    if (hold.unknown[axis][p] >= 0) triplets.emplace_back(static_cast<int>(p), hold.unknown[axis][p], hold.sign[p]);
  }
  Sparse matrix(static_cast<Eigen::Index>(hold.unknown[axis].size()), hold.unknown_count[axis]);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  return matrix;
}

void add_change(const Hold& hold, std::size_t axis, const Eigen::VectorXd& change, Points& x) {
  for (std::size_t p = 0; p < hold.unknown[axis].size(); ++p) {
    const int k = hold.unknown[axis][p];
    if (k >= 0) x(static_cast<Eigen::Index>(p), static_cast<Eigen::Index>(axis)) += hold.sign[p] * change[k];
  }
}

void add_loads(const Shell& shell, const constraint::Surroundings& surroundings, const Points& x, double time,
               Points& force) {
  for (int p = 0; p < shell.point_count(); ++p) {
    force.row(p) += shell.mass[static_cast<std::size_t>(p)] * surroundings.gravity.transpose();
  }
  for (const constraint::Load& load : surroundings.loads) add_load(shell, load, x, time, force);
}

}  // namespace wunderlich::baseline::shell
