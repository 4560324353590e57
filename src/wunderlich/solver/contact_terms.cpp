// Derivatives of contact's barrier and of friction: each point adds squares of a few vectors of eight.
#include <algorithm>
#include <cmath>

#include "wunderlich/contact/barrier.hpp"
#include "wunderlich/math/four.hpp"
#include "wunderlich/solver/chain_contact.hpp"
#include "wunderlich/solver/coulomb.hpp"

namespace wunderlich::solver {

using geometry::Chain;
using geometry::Kinematics;
using geometry::Ribbon;
using math::all;
using math::Four;
using math::four;

namespace {

/// A vector in a term's eight coordinates.
struct Eight {
  Four low, high;
};

/// A symmetric matrix in them.
struct EightSquare {
  Four rows[16] = {};
  /// += factor x x^T
  void add(double factor, const Eight& x) {
    const Four low = all(factor) * x.low, high = all(factor) * x.high;
    for (int i = 0; i < 4; ++i) {
      rows[2 * i] += all(x.low[i]) * low;
      rows[2 * i + 1] += all(x.low[i]) * high;
      rows[8 + 2 * i] += all(x.high[i]) * low;
      rows[9 + 2 * i] += all(x.high[i]) * high;
    }
  }
  void store(math::Mat8& out) const {
    for (int i = 0; i < 16; ++i) math::store(rows[i], out.data() + 4 * i);
  }
};

/// One segment's facet under way: sums over its points.
struct FacetSums {
  Vec3 d2, d3;
  double eta_free[2];  ///< 1 or 0
  Eight gradient{all(0), all(0)};
  EightSquare hessian{}, geometric{};
  Four leverage[3] = {all(0), all(0), all(0)};  ///< F arm^T, by rows, of the forces F
  Four slanting[2] = {all(0), all(0)};          ///< F times what the point moves along d3 with each eta
  double keeping[3] = {0, 0, 0};  ///< forces times second derivatives of what points keep: by eta's first, both, second
};

/// A point's arm from the segment's far node, and its way along d3 with eta at the segment's start and end.
struct Lever {
  Vec3 arm;
  double slant[2];
};

/// How far the point moves in a direction with each of the coordinates.
inline Eight moved(const FacetSums& sums, const Lever& lever, const Vec3& direction) {
  const double along = sums.d3.dot(direction);
  const Vec3 turned = lever.arm.cross(direction);
  return {Four{direction[0], direction[1], direction[2], turned[0]},
          Four{turned[1], turned[2], lever.slant[0] * along, lever.slant[1] * along}};
}

/// A force of a given size along the way that `move` is.
inline void add_force(double size, const Eight& move, const Lever& lever, FacetSums& sums) {
  sums.gradient.low += all(size) * move.low;
  sums.gradient.high += all(size) * move.high;
  const Four force = all(size) * move.low, arm = four(lever.arm);  // in the fourth lane is what nobody reads
  for (int i = 0; i < 3; ++i) sums.leverage[i] += all(force[i]) * arm;
  for (int c = 0; c < 2; ++c) sums.slanting[c] += all(lever.slant[c]) * force;
}

/// What a point keeps grows as rulings lean: its gap shrinks.
void add_keeping(const ContactFacet& facet, const Touch& touch, double force, Eight& nearer, FacetSums& sums) {
  const double side = 2 * facet.sag[0] * touch.v, ruling = 2 * facet.sag[1];
  const double longer = side * facet.length_at(touch.v), leans = ruling * facet.eta_at(touch.share);
  const double early = sums.eta_free[0] * (1 - touch.share), late = sums.eta_free[1] * touch.share;
  nearer.high += Four{0, 0, sums.eta_free[0] * longer - early * leans, -sums.eta_free[1] * longer - late * leans};
  sums.keeping[0] += force * (sums.eta_free[0] * side * touch.v + ruling * early * early);
  sums.keeping[1] += force * (ruling * early * late - sums.eta_free[0] * sums.eta_free[1] * side * touch.v);
  sums.keeping[2] += force * (sums.eta_free[1] * side * touch.v + ruling * late * late);
}

/// The force that the barrier's first derivative is, and both parts of the Hessian, of one point.
void add_touch(const Ribbon& ribbon, const ContactProblem& problem, const Chain& chain, const ContactPoints& points,
               const Touch& touch, const Mat3& to_space, FacetSums& sums) {
  const std::size_t count = problem.solids.size(), s = touch.facet / count;
  const double eta = (1 - touch.share) * chain.eta[s] + touch.share * chain.eta[s + 1];
  const Lever lever{((touch.share - 1) * ribbon.rest_length[s] + touch.v * eta) * sums.d3 + touch.v * sums.d2,
                    {sums.eta_free[0] * (1 - touch.share) * touch.v, sums.eta_free[1] * touch.share * touch.v}};
  const double weight = problem.stiffness * touch.area, gap = points.gap[touch.point];
  const contact::BarrierSlopes slopes = contact::barrier_slopes(gap, problem.distance, touch.log);
  const double first = weight * slopes.first;
  Eight nearer = moved(sums, lever, to_space * points.normal[touch.point]);
  add_keeping(points.facets[touch.facet], touch, -first, nearer, sums);
  sums.hessian.add(weight * slopes.second, nearer);
  add_force(first, nearer, lever, sums);
  const contact::Bend bend = contact::bend(problem.solids[touch.facet % count].shape, points.at[touch.point]);
  for (int c = 0; c < 2; ++c) {
    if (bend.curvature[c] == 0) continue;
    sums.geometric.add(first * bend.curvature[c], moved(sums, lever, to_space * bend.direction[c]));
  }
}

/// Way along the solid's surface and the point's arm.
struct Slide {
  Vec3 way, arm;
};

Slide slide_of(const Friction& friction, const Kinematics& k) {
  const Mat3& frame = k.frame[friction.segment];
  const Vec3 arm = friction.along * frame.col(2) + friction.across * frame.col(1);
  const Vec3 way = k.r[friction.segment + 1] + arm - friction.from;
  return {way - friction.normal.dot(way) * friction.normal, arm};
}

/// Force times way, smooth at rest.   @eq Li2020:14
void add_friction(const Friction& friction, double slip, bool settled, const Slide& slide, FacetSums& sums) {
  const double way = slide.way.norm();
  const Pull pull = pull_of(way, slip, settled);
  const Vec3 onward = way > 0 ? Vec3((1 / way) * slide.way) : friction.normal.unitOrthogonal();
  const Lever lever{slide.arm, {0, 0}};
  const Eight along = moved(sums, lever, onward);
  sums.hessian.add(friction.force * pull.along, along);
  sums.hessian.add(friction.force * pull.across, moved(sums, lever, friction.normal.cross(onward)));
  add_force(friction.force * pull.across * way, along, lever, sums);
}

/// The sums as a term, with the second derivative of the points' places: how levers turn.
void finish(const FacetSums& sums, math::SurfaceTerm& term) {
  sums.hessian.store(term.hessian);
  term.hessian(6, 6) += sums.keeping[0];
  term.hessian(6, 7) += sums.keeping[1];
  term.hessian(7, 6) += sums.keeping[1];
  term.hessian(7, 7) += sums.keeping[2];
  sums.geometric.store(term.geometric);
  math::store(sums.gradient.low, term.gradient.data());
  math::store(sums.gradient.high, term.gradient.data() + 4);
  Mat3 leverage;
  for (int i = 0; i < 3; ++i) leverage.row(i) = math::first_three(sums.leverage[i]).transpose();
  term.geometric.block<3, 3>(3, 3) += 0.5 * (leverage + leverage.transpose()) - leverage.trace() * Mat3::Identity();
  for (int c = 0; c < 2; ++c) {
    const Vec3 part = sums.d3.cross(math::first_three(sums.slanting[c]));
    term.geometric.block<3, 1>(3, 6 + c) += part;
    term.geometric.block<1, 3>(6 + c, 3) += part.transpose();
  }
}

}  // namespace

void add_contact(const Ribbon& ribbon, const ContactProblem& problem, const Chain& chain, const Kinematics& k,
                 const ContactPoints& points, math::ChainSystem& system) {
  const std::size_t count = problem.solids.size();
  auto touch = points.touches.rbegin();
  auto friction = problem.friction.begin();
  const auto touches = [&](std::size_t s) { return touch != points.touches.rend() && touch->facet / count == s; };
  const auto rubs = [&](std::size_t s) { return friction != problem.friction.end() && friction->segment == s; };
  for (std::size_t s = ribbon.rest_length.size(); s-- > 0;) {
    if (!touches(s) && !rubs(s)) continue;
    const int node = static_cast<int>(s);
    const auto is_free = [&](int end) { return geometry::eta_is_free(ribbon, end) ? 1.0 : 0.0; };
    FacetSums sums{k.frame[s].col(1), k.frame[s].col(2), {is_free(node), is_free(node + 1)}};
    while (touches(s)) {
      const std::size_t facet = touch->facet;
      const Mat3 to_space = problem.solids[facet % count].pose.frame.toRotationMatrix();
      for (; touch != points.touches.rend() && touch->facet == facet; ++touch)
        add_touch(ribbon, problem, chain, points, *touch, to_space, sums);
    }
    for (; rubs(s); ++friction) add_friction(*friction, problem.slip, points.settled, slide_of(*friction, k), sums);
    system.surfaces.emplace_back().node = node;
    finish(sums, system.surfaces.back());
  }
  add_mesh_contact(ribbon, problem.meshes, chain, k, points.meshes, system);
}

double friction_value(const ContactProblem& problem, const Kinematics& k) {
  double sum = 0;
  for (const Friction& friction : problem.friction) {
    sum += friction.force * sliding_value(slide_of(friction, k).way.norm(), problem.slip);
  }
  return sum;
}

double friction_work(const ContactProblem& problem, const Kinematics& k) {
  double work = 0;
  for (const Friction& friction : problem.friction) {
    const Vec3 way = slide_of(friction, k).way;
    work -= friction.force * pull_of(way.norm(), problem.slip) * way.dot(friction.carried);
  }
  return work;
}

}  // namespace wunderlich::solver
