#include "wunderlich/picture/sheet.hpp"

#include "wunderlich/picture/colour.hpp"
#include "wunderlich/picture/fields.hpp"
#include "wunderlich/picture/lines.hpp"

namespace wunderlich::picture {

namespace {

constexpr double floor_gap = 0.12;  // of the radius, below the ribbon

const Point front_paint = linear_of(0xc65a34u);
const Point back_paint = linear_of(0xe9c9a1u);
const Point body_paint = linear_of(0x9aa1a9u);

using Triangle = std::array<Corner, 3>;

/// The ribbon as triangles on the stage, with the colours of both its sides.
void add_ribbon(const Subject& subject, const Style& style, const Plan& plan, std::size_t k,
                std::vector<std::array<Triangle, 2>>& out) {
  const Frame& frame = subject.frames[plan.frames[k]];
  const Mesh& mesh = frame.surface;
  const Fit& fit = plan.fits[k];
  std::vector<double> field;
  if (style.colour != Colour::plain) field = field_of(frame, style.colour);
  const std::vector<double> ribbon = values_of(mesh, "ribbon");
  for (const auto& points : mesh.triangles) {
    std::array<Triangle, 2> sides;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto p = static_cast<std::size_t>(points[c]);
      const FlatPattern& strip = subject.strips[static_cast<std::size_t>(ribbon[p])];
      const bool one_sided = strip.loop && strip.half_twists % 2 != 0;
      const Corner corner{fit.on_stage(mesh.points[p]).cast<float>(), mesh.normals[p].cast<float>(), front_paint};
      sides[0][c] = sides[1][c] = corner;
      if (!one_sided) sides[1][c].colour = back_paint;
      if (!field.empty())
        sides[0][c].colour = sides[1][c].colour = colour_of(share_of(field[p], plan.range, style.colour));
    }
    out.push_back(sides);
  }
}

std::vector<Triangle> bodies_on_stage(const Subject& subject, const Plan& plan, std::size_t k) {
  std::vector<Triangle> out;
  for (const Body& body : subject.bodies) {
    const Pose& pose = body.poses[plan.frames[k]];
    const Mat3 turn = pose.frame.toRotationMatrix();
    for (const auto& points : body.mesh.triangles) {
      Triangle triangle;
      for (std::size_t c = 0; c < 3; ++c) {
        const auto p = static_cast<std::size_t>(points[c]);
        triangle[c].position = plan.fits[k].on_stage(pose.position + turn * body.mesh.points[p]).cast<float>();
        triangle[c].normal = (turn * body.mesh.normals[p]).cast<float>();
        triangle[c].colour = body_paint;
      }
      out.push_back(triangle);
    }
  }
  return out;
}

std::array<Vec3, 3> places(const Triangle& triangle) {
  return {triangle[0].position.cast<double>(), triangle[1].position.cast<double>(),
          triangle[2].position.cast<double>()};
}

void add_stroke(const Projection& projection, Line line, float half_width, float opacity, std::vector<Stroke>& out) {
  std::array<Vec3, 2> seen{projection.eye_space(line[0]), projection.eye_space(line[1])};
  for (std::size_t end : {0u, 1u}) {
    const Vec3 other = seen[1 - end];
    if (seen[end].z() >= near_plane) continue;
    if (other.z() <= near_plane) return;
    seen[end] += (other - seen[end]) * (near_plane - seen[end].z()) / (other.z() - seen[end].z());
  }
  out.push_back({projection.sample(seen[0]), projection.sample(seen[1]), half_width, opacity});
}

void add_lines(const Subject& subject, const Plan& plan, std::size_t k, Sheet& sheet) {
  const Frame& frame = subject.frames[plan.frames[k]];
  const Fit& fit = plan.fits[k];
  // Half a pixel each way at 750 rows, and in proportion.
  const auto half = static_cast<float>(0.5 * fine * std::max(0.8, sheet.height / fine / 750.0));
  for (const auto& edge : rim_edges(frame.surface, subject.strips)) {
    const auto& points = frame.surface.points;
    const Line line{fit.on_stage(points[static_cast<std::size_t>(edge[0])]),
                    fit.on_stage(points[static_cast<std::size_t>(edge[1])])};
    add_stroke(sheet.projection, line, 1.2f * half, 0.8f, sheet.strokes);
  }
  for (const Line& ruling : rulings_of(frame, subject.strips)) {
    add_stroke(sheet.projection, {fit.on_stage(ruling[0]), fit.on_stage(ruling[1])}, half, 0.72f, sheet.strokes);
  }
}

}  // namespace

Sheet sheet_of(const Subject& subject, const Style& style, const Plan& plan, std::size_t k) {
  std::vector<std::array<Triangle, 2>> ribbon;
  add_ribbon(subject, style, plan, k, ribbon);
  const std::vector<Triangle> bodies = bodies_on_stage(subject, plan, k);
  std::vector<std::array<Vec3, 3>> opaque;
  opaque.reserve(ribbon.size() + bodies.size());
  for (const auto& sides : ribbon) opaque.push_back(places(sides[0]));
  for (const Triangle& body : bodies) opaque.push_back(places(body));
  const int width = fine * style.width, height = fine * style.height;
  Sheet sheet{Projection(plan.camera, width, height), {}, {}, Shadow(opaque), 0, width, height};
  const Fit& fit = plan.fits[k];
  sheet.floor = (fit.floor - fit.centre.z()) / fit.radius - floor_gap;
  for (const auto& sides : ribbon) {
    const std::size_t before = sheet.patches.size();
    project(sheet.projection, sides[0], sheet.patches);
    if (sheet.patches.size() == before || sheet.patches.back().front) continue;
    sheet.patches.resize(before);
    project(sheet.projection, sides[1], sheet.patches);
    for (std::size_t p = before; p < sheet.patches.size(); ++p) {
      for (Corner& corner : sheet.patches[p].corners) corner.normal = -corner.normal;
    }
  }
  for (const Triangle& body : bodies) {  // seen from outside only: a ground does not hide the ribbon from below
    const std::size_t before = sheet.patches.size();
    project(sheet.projection, body, sheet.patches);
    if (sheet.patches.size() > before && !sheet.patches.back().front) sheet.patches.resize(before);
  }
  add_lines(subject, plan, k, sheet);
  return sheet;
}

}  // namespace wunderlich::picture
