#include "wunderlich/geometry/surface.hpp"

#include <cassert>
#include <cmath>

namespace wunderlich::geometry {

namespace {

double triangle_area(const Vec3& a, const Vec3& b, const Vec3& c) { return 0.5 * (b - a).cross(c - a).norm(); }

/// Mean of the two ways to cut a quadrilateral; one and the same when it is planar and convex.
double quad_area(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const double one = triangle_area(a, b, c) + triangle_area(a, c, d);
  const double other = triangle_area(a, b, d) + triangle_area(b, c, d);
  return 0.5 * (one + other);
}

double segment_area(const Ribbon& ribbon, const State& state, std::size_t s) {
  const Mat3 frame = state.q[s].toRotationMatrix();
  const Vec3 before = frame.col(1) + state.eta[s] * frame.col(2);
  const Vec3 after = frame.col(1) + state.eta[s + 1] * frame.col(2);
  const Vec3& a = state.r[s];
  const Vec3& b = state.r[s + 1];
  const double half = 0.5 * ribbon.width;
  const double slope = state.eta[s + 1] - state.eta[s];
  const double length = (b - a).dot(frame.col(2));
  if (half * std::abs(slope) < std::abs(length)) {
    return quad_area(a - half * before, a + half * before, b + half * after, b - half * after);
  }
  if (slope == 0) return 0;  // a segment of no length
  // The rulings meet at v = -length/slope, inside the strip: a bow tie of two triangles.
  const double v = -length / slope;
  const Vec3 crossing = 0.5 * ((a + v * before) + (b + v * after));
  return triangle_area(a - half * before, b - half * after, crossing) +
         triangle_area(a + half * before, b + half * after, crossing);
}

/// What a cross-section of the rendered surface needs.
struct Station {
  Vec3 r;
  Quat frame;
  double u, eta, kappa, tau;
};

double mix(double a, double b, double t) { return a + (b - a) * t; }

Station sample(const Ribbon& ribbon, const State& state, const Strains& strain, const std::vector<Quat>& frames,
               std::size_t s, double t) {
  const double l = ribbon.rest_length[s];
  const Vec3 tangent_a = frames[s] * Vec3::UnitZ();
  const Vec3 tangent_b = frames[s + 1] * Vec3::UnitZ();
  const double t2 = t * t;
  const double t3 = t2 * t;
  Station out;
  // Cubic Hermite with the node tangents: dr/du is continuous, and the seam of a loop closes.
  out.r = (2 * t3 - 3 * t2 + 1) * state.r[s] + (t3 - 2 * t2 + t) * l * tangent_a + (3 * t2 - 2 * t3) * state.r[s + 1] +
          (t3 - t2) * l * tangent_b;
  out.frame = frames[s].slerp(t, frames[s + 1]);
  out.u = ribbon.node_u[s] + t * l;
  out.eta = mix(state.eta[s], state.eta[s + 1], t);
  out.kappa = mix(strain.kappa[s], strain.kappa[s + 1], t);
  out.tau = mix(strain.tau[s], strain.tau[s + 1], t);
  return out;
}

std::vector<Quat> node_frames(const Ribbon& ribbon, const State& state) {
  std::vector<Quat> frames;
  frames.reserve(static_cast<std::size_t>(ribbon.node_count()));
  for (int i = 0; i < ribbon.node_count(); ++i) frames.push_back(node_frame(ribbon, state, i));
  return frames;
}

/// Appends the points of one ruling, from v = -w/2 to w/2.
void add_ruling(const Ribbon& ribbon, const Station& station, int across, Mesh& mesh) {
  const Mat3 frame = station.frame.toRotationMatrix();
  const Vec3 ruling = frame.col(1) + station.eta * frame.col(2);
  for (int b = 0; b <= across; ++b) {
    const double v = ribbon.width * (static_cast<double>(b) / across - 0.5);
    mesh.points.push_back(station.r + v * ruling);
    mesh.normals.push_back(frame.col(0));
    const std::array<double, 5> values{station.u, v, station.kappa, station.tau, station.eta};
    for (std::size_t f = 0; f < values.size(); ++f) mesh.fields[f].values.push_back(values[f]);
  }
}

}  // namespace

double surface_area(const Ribbon& ribbon, const State& state) {
  double area = 0;
  for (std::size_t s = 0; s < state.q.size(); ++s) area += segment_area(ribbon, state, s);
  return area;
}

double area_error(const Ribbon& ribbon, const State& state) {
  const double rest = ribbon.length * ribbon.width;
  return std::abs(surface_area(ribbon, state) - rest) / rest;
}

Mesh render_mesh(const Ribbon& ribbon, const State& state, int subdivision, int across) {
  assert(subdivision >= 1 && across >= 1);
  const Strains strain = strains(ribbon, state);
  const std::vector<Quat> frames = node_frames(ribbon, state);
  Mesh mesh;
  mesh.fields = {{"u", "m", {}}, {"v", "m", {}}, {"kappa", "1/m", {}}, {"tau", "1/m", {}}, {"eta", "", {}}};
  for (std::size_t s = 0; s < state.q.size(); ++s) {
    for (int k = 0; k < subdivision; ++k) {
      const double t = static_cast<double>(k) / subdivision;
      add_ruling(ribbon, sample(ribbon, state, strain, frames, s, t), across, mesh);
    }
  }
  add_ruling(ribbon, sample(ribbon, state, strain, frames, state.q.size() - 1, 1.0), across, mesh);
  const int row = across + 1;
  for (int a = 0; a < ribbon.segments * subdivision; ++a) {
    for (int b = 0; b < across; ++b) {
      const int p = a * row + b;  // counter-clockwise seen from d1
      mesh.triangles.push_back({p, p + 1, p + row});
      mesh.triangles.push_back({p + 1, p + row + 1, p + row});
    }
  }
  return mesh;
}

std::vector<CenterlineSample> centerline(const Ribbon& ribbon, const State& state) {
  const Strains strain = strains(ribbon, state);
  const auto segments = static_cast<std::size_t>(ribbon.segments);
  const auto& slope = strain.eta_prime;
  std::vector<CenterlineSample> samples(segments + 1);
  for (std::size_t i = 0; i <= segments; ++i) {
    const Mat3 frame = node_frame(ribbon, state, static_cast<int>(i)).toRotationMatrix();
    // The other side of the seam of a loop: eta' changes sign with the surface.
    const double outside = ribbon.seam_sign();
    double before = i > 0 ? slope[i - 1] : slope[0];
    double after = i < segments ? slope[i] : slope[segments - 1];
    if (ribbon.is_loop() && i == 0) before = outside * slope[segments - 1];
    if (ribbon.is_loop() && i == segments) after = outside * slope[0];
    samples[i] = {ribbon.node_u[i], state.r[i],    frame.col(0), frame.col(1),          frame.col(2),
                  strain.kappa[i],  strain.tau[i], state.eta[i], 0.5 * (before + after)};
  }
  return samples;
}

FlatPattern flat_pattern(const Ribbon& ribbon, const State& state) {
  const Strains strain = strains(ribbon, state);
  const double half = 0.5 * ribbon.width;
  FlatPattern pattern;
  pattern.length = ribbon.length;
  pattern.width = ribbon.width;
  pattern.loop = ribbon.is_loop();
  pattern.half_twists = ribbon.half_twists;
  for (std::size_t i = 0; i < state.eta.size(); ++i) {
    const double u = ribbon.node_u[i];
    const double eta = state.eta[i];
    // Seen from d1, x runs along d3 and y along -d2: the point at v lies at (u + v eta, -v).
    pattern.rulings.push_back({Vec2(u - half * eta, half), Vec2(u + half * eta, -half)});
    pattern.fold_angle.push_back(strain.kappa[i] * ribbon.hinge_length[i] * std::sqrt(1 + eta * eta));
  }
  return pattern;
}

}  // namespace wunderlich::geometry
