#include "wunderlich/picture/draw.hpp"

#include <atomic>
#include <cassert>
#include <limits>
#include <numeric>
#include <thread>

#include "wunderlich/picture/colour.hpp"
#include "wunderlich/picture/lines.hpp"
#include "wunderlich/picture/raster.hpp"
#include "wunderlich/picture/shadow.hpp"

namespace wunderlich::picture {

namespace {

constexpr int fine = 4;              // samples a pixel, each way
constexpr int band = 16;             // rows of pixels drawn at a time
constexpr double floor_gap = 0.12;   // of the radius, below the ribbon
constexpr float line_bias = 0.003f;  // of the depth: lines lie on the surface, and show

const Point front_paint = linear_of(0xc65a34u);
const Point back_paint = linear_of(0xe9c9a1u);
const Point body_paint = linear_of(0x9aa1a9u);
const Point ink = linear_of(0x2a1a12u);
const Point middle = linear_of(0xfbf9f5u), rim = linear_of(0xefe9dfu);  // of the background

/// A line in the picture, x, y in samples and 1/depth.
struct Stroke {
  Point from, to;
  float half_width = 1;
  float opacity = 1;
};

/// One picture's worth of things, in samples.
struct Sheet {
  Projection projection;
  std::vector<Patch> patches;
  std::vector<Stroke> strokes;
  Shadow shadow;
  double floor = 0;  // on the stage
  int width = 0, height = 0;
};

struct Sample {
  float nearness = 0;  // 1/depth; 0 is the background
  int patch = -1;
  Point colour = Point::Zero();
};

// --- What is in the picture

using Triangle = std::array<Corner, 3>;

/// The ribbon as triangles on the stage, with the colours of both its sides.
void add_ribbon(const Subject& subject, const Style& style, const Plan& plan, std::size_t k,
                std::vector<std::array<Triangle, 2>>& out) {
  const Frame& frame = subject.frames[plan.frames[k]];
  const Mesh& mesh = frame.surface;
  const Fit& fit = plan.fits[k];
  std::vector<double> field;
  if (style.colour != Colour::plain) field = field_of(frame, style.colour);
  std::vector<double> ribbon(mesh.points.size(), 0.0);
  for (const PointField& values : mesh.fields) {
    if (values.name == "ribbon") ribbon = values.values;
  }
  for (const auto& points : mesh.triangles) {
    std::array<Triangle, 2> sides;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto p = static_cast<std::size_t>(points[c]);
      const FlatPattern& strip = subject.strips[static_cast<std::size_t>(ribbon[p])];
      const bool one_sided = strip.loop && strip.half_twists % 2 != 0;
      const Corner corner{fit.on_stage(mesh.points[p]).cast<float>(), mesh.normals[p].cast<float>(), front_paint};
      sides[0][c] = sides[1][c] = corner;
      if (!one_sided) sides[1][c].colour = back_paint;
      if (!field.empty()) sides[0][c].colour = sides[1][c].colour = colour_of(field[p], plan.range);
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
    add_stroke(sheet.projection, line, 1.2f * half, 0.75f, sheet.strokes);
  }
  for (const Line& ruling : rulings_of(frame, subject.strips)) {
    add_stroke(sheet.projection, {fit.on_stage(ruling[0]), fit.on_stage(ruling[1])}, half, 0.6f, sheet.strokes);
  }
}

Sheet sheet_of(const Subject& subject, const Style& style, const Plan& plan, std::size_t k) {
  std::vector<std::array<Triangle, 2>> ribbon;
  add_ribbon(subject, style, plan, k, ribbon);
  const std::vector<Triangle> bodies = bodies_on_stage(subject, plan, k);
  std::vector<std::array<Vec3, 3>> opaque;
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

// --- Light

/// What reaches the eye from paint of this colour.
Point lit(const Point& paint, const Point& normal, const Vec3& place, const Sheet& sheet) {
  const Point n = normal.normalized(), l = light.cast<float>();
  const Point eye = (sheet.projection.camera.eye - place).normalized().cast<float>();
  const float facing = n.dot(l);
  // Looked up a little off the surface, on the side of the light: a strip does not shade itself there.
  const Vec3 off = place + 0.012 * (facing > 0 ? 1.0 : -1.0) * n.cast<double>();
  const float sun = facing > 0 ? facing * (1 - sheet.shadow.at(off, 2, 2)) : 0;
  const float through = facing < 0 ? -0.18f * facing * (1 - sheet.shadow.at(off, 2, 2)) : 0;  // paper lets some pass
  const Point sky = Point(0.80f, 0.80f, 0.82f), ground = Point(0.50f, 0.46f, 0.43f);
  const Point around = ground + (0.5f + 0.5f * n.z()) * (sky - ground);
  const Point key = (0.80f * sun + through) * Point(1.0f, 0.955f, 0.89f);
  const float shine = facing > 0 ? 0.05f * std::pow(std::max(0.0f, n.dot((l + eye).normalized())), 24.0f) : 0;
  const float head = 0.22f * std::abs(n.dot(eye));
  const Point white = shine * (1 - sheet.shadow.at(off, 2, 2)) * Point::Ones();
  return paint.cwiseProduct(around + key + head * Point::Ones()) + white;
}

/// The background of a pixel: paper, and the shadow on a floor below.
Point ground(const Sheet& sheet, int x, int y) {
  const double u = (x + 0.5) * fine / sheet.width - 0.5, v = (y + 0.5) * fine / sheet.height - 0.45;
  const auto out = static_cast<float>(std::clamp(1.6 * (u * u + v * v), 0.0, 1.0));
  const Point paper = middle + out * (rim - middle);
  const Projection& projection = sheet.projection;
  const View& view = projection.camera.view;
  const Vec3 ray = view.right * ((x + 0.5) * fine - projection.centre.x()) / projection.scale -
                   view.up * ((y + 0.5) * fine - projection.centre.y()) / projection.scale - view.towards;
  const double along = (sheet.floor - projection.camera.eye.z()) / ray.z();
  if (!(along > 0) || !std::isfinite(along)) return paper;
  return paper * (1 - 0.34f * sheet.shadow.at(projection.camera.eye + along * ray, 4, 4));
}

// --- A band of rows

class Band {
 public:
  Band(const Sheet& sheet, int first_row, int rows)
      : sheet_(sheet),
        window_{0, fine * first_row, sheet.width, fine * (first_row + rows)},
        samples_(static_cast<std::size_t>(sheet.width) * static_cast<std::size_t>(fine * rows)) {}

  void draw(Image& image) {
    for (std::size_t p = 0; p < sheet_.patches.size(); ++p) mark(sheet_.patches[p], static_cast<int>(p));
    for (int y = window_.top / fine; y < window_.bottom / fine; ++y) {
      for (int x = 0; x < image.width; ++x) shade(x, y);
    }
    for (const Stroke& stroke : sheet_.strokes) blend(stroke);
    for (int y = window_.top / fine; y < window_.bottom / fine; ++y) {
      for (int x = 0; x < image.width; ++x) resolve(x, y, image);
    }
  }

 private:
  Sample& at(int x, int y) {
    return samples_[static_cast<std::size_t>(y - window_.top) * static_cast<std::size_t>(sheet_.width) +
                    static_cast<std::size_t>(x)];
  }

  template <class Visit>
  void each_of_pixel(int x, int y, Visit visit) {
    for (int j = 0; j < fine; ++j) {
      for (int i = 0; i < fine; ++i) visit(at(fine * x + i, fine * y + j));
    }
  }

  void mark(const Patch& patch, int index) {
    cover(patch.at, window_, [&](int x, int y, const Weights& w) {
      const float nearness = w.a * patch.at[0].z() + w.b * patch.at[1].z() + w.c * patch.at[2].z();
      Sample& sample = at(x, y);
      if (nearness <= sample.nearness) return;
      sample.nearness = nearness;
      sample.patch = index;
    });
  }

  /// The colour of a patch at the middle of a pixel, or where it is nearest to it.
  Point colour_of_patch(const Patch& patch, int x, int y) const {
    const Plane plane(patch.at);
    const Weights w = plane((static_cast<float>(x) + 0.5f) * fine, (static_cast<float>(y) + 0.5f) * fine);
    std::array<float, 3> share{std::max(0.0f, w.a) * patch.at[0].z(), std::max(0.0f, w.b) * patch.at[1].z(),
                               std::max(0.0f, w.c) * patch.at[2].z()};
    const float sum = share[0] + share[1] + share[2];
    Corner mean;
    for (std::size_t c = 0; c < 3; ++c) {
      mean.position += share[c] / sum * patch.corners[c].position;
      mean.normal += share[c] / sum * patch.corners[c].normal;
      mean.colour += share[c] / sum * patch.corners[c].colour;
    }
    return lit(mean.colour, mean.normal, mean.position.cast<double>(), sheet_);
  }

  /// Each patch of a pixel is lit once, for all its samples.
  void shade(int x, int y) {
    constexpr int unlit = std::numeric_limits<int>::min();
    int last = unlit;
    Point colour = Point::Zero(), background = Point::Zero();
    bool have_background = false;
    each_of_pixel(x, y, [&](Sample& sample) {
      if (sample.patch < 0) {
        if (!have_background) background = ground(sheet_, x, y);
        have_background = true;
        sample.colour = background;
        return;
      }
      if (sample.patch != last) colour = colour_of_patch(sheet_.patches[static_cast<std::size_t>(sample.patch)], x, y);
      last = sample.patch;
      sample.colour = colour;
    });
  }

  void blend(const Stroke& stroke) {
    const Eigen::Vector2f from = stroke.from.head<2>(), way = (stroke.to - stroke.from).head<2>();
    const float length = way.norm(), h = stroke.half_width;
    if (!(length > 1e-6f)) return;
    const Eigen::Vector2f along = way / length, across(-along.y(), along.x());
    const float lowest = std::min(stroke.from.y(), stroke.to.y()) - h,
                highest = std::max(stroke.from.y(), stroke.to.y()) + h;
    const int top =
        static_cast<int>(std::clamp(lowest, static_cast<float>(window_.top), static_cast<float>(window_.bottom)));
    const int bottom =
        static_cast<int>(std::clamp(highest + 1, static_cast<float>(window_.top), static_cast<float>(window_.bottom)));
    for (int y = top; y < bottom; ++y) {
      // The part of the row within the line's width.
      const float dy = static_cast<float>(y) + 0.5f - from.y();
      float left = std::min(0.0f, way.x()) - h, right = std::max(0.0f, way.x()) + h;
      if (std::abs(across.x()) > 1e-3f) {
        const float centre = -dy * across.y() / across.x(), reach = h / std::abs(across.x());
        left = std::max(left, centre - reach - 1);
        right = std::min(right, centre + reach + 1);
      }
      const auto column = [&](float x) {
        return static_cast<int>(std::clamp(x + from.x(), 0.0f, static_cast<float>(sheet_.width)));
      };
      for (int x = column(left); x < column(right + 1); ++x) {
        const Eigen::Vector2f d(static_cast<float>(x) + 0.5f - from.x(), dy);
        const float t = d.dot(along) / length;
        if (std::abs(d.dot(across)) > h || t < 0 || t >= 1) continue;
        const float nearness = (1 + line_bias) * (stroke.from.z() + t * (stroke.to.z() - stroke.from.z()));
        Sample& sample = at(x, y);
        if (nearness >= sample.nearness) sample.colour += stroke.opacity * (ink - sample.colour);
      }
    }
  }

  void resolve(int x, int y, Image& image) {
    Point sum = Point::Zero();
    each_of_pixel(x, y, [&](const Sample& sample) { sum += sample.colour; });
    std::uint8_t* pixel = &image.rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                                          static_cast<std::size_t>(x))];
    for (int c = 0; c < 3; ++c) {
      const float value = srgb_of(std::clamp(sum[c] / (fine * fine), 0.0f, 1.0f));
      pixel[c] = static_cast<std::uint8_t>(std::lround(255 * value));
    }
  }

  const Sheet& sheet_;
  Window window_;
  std::vector<Sample> samples_;
};

}  // namespace

Plan plan(const Subject& subject, const Style& style, std::vector<std::size_t> frames) {
  assert(!frames.empty());
  Plan out;
  out.frames = std::move(frames);
  std::vector<const Frame*> shown;
  for (const std::size_t f : out.frames) shown.push_back(&subject.frames[f]);
  const auto points = shown_points(shown, subject.bodies, out.frames);
  out.fits = fits_of(points);
  const View view = style.view ? view_from(*style.view) : best_view(shown.back()->surface);
  out.camera = frame_all(view, static_cast<double>(style.width) / style.height, points, out.fits);
  if (style.colour != Colour::plain) out.range = range_of(shown, style.colour);
  return out;
}

Image draw(const Subject& subject, const Style& style, const Plan& plan, std::size_t k) {
  const Sheet sheet = sheet_of(subject, style, plan, k);
  Image image{style.width, style.height, {}};
  image.rgb.resize(3 * static_cast<std::size_t>(style.width) * static_cast<std::size_t>(style.height));
  std::atomic<int> next = 0;
  const auto work = [&] {
    for (int row = band * next++; row < style.height; row = band * next++) {
      Band(sheet, row, std::min(band, style.height - row)).draw(image);
    }
  };
  std::vector<std::thread> helpers;
  for (unsigned i = 1; i < std::thread::hardware_concurrency(); ++i) helpers.emplace_back(work);
  work();
  for (std::thread& helper : helpers) helper.join();
  return image;
}

Image still(const Subject& subject, const Style& style) {
  const std::size_t frame = style.frame.value_or(subject.frames.size() - 1);
  return draw(subject, style, plan(subject, style, {frame}), 0);
}

}  // namespace wunderlich::picture
