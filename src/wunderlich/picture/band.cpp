#include "wunderlich/picture/band.hpp"

#include <limits>

#include "wunderlich/picture/colour.hpp"

namespace wunderlich::picture {

namespace {

constexpr double line_bias = 0.003;  // of the depth: lines lie on the surface, and show

const Point ink = linear_of(0x2a1a12u);
const Point paper = linear_of(0xf8f6f1u);

struct Sample {
  float nearness = 0;  // 1/depth; 0 is the background
  int patch = -1;
  Point colour = Point::Zero();
};

/// "PBR neutral" of Khronos: what is too bright for a screen grows pale and keeps its hue.
Point shown(Point colour) {
  constexpr float start = 0.76f, desaturation = 0.15f;
  const float least = colour.minCoeff();
  colour.array() -= least < 0.08f ? least - 6.25f * least * least : 0.04f;
  const float peak = colour.maxCoeff();
  if (peak < start) return colour;
  const float room = 1 - start, compressed = 1 - room * room / (peak + room - start);
  const float pale = 1 - 1 / (desaturation * (peak - compressed) + 1);
  return (1 - pale) * compressed / peak * colour + pale * compressed * Point::Ones();
}

/// What reaches the eye from paint of this colour.
Point lit(const Point& paint, const Point& normal, const Vec3& place, const Sheet& sheet) {
  const Point n = normal.normalized(), l = light.cast<float>();
  const Point eye = (sheet.projection.camera.eye - place).normalized().cast<float>();
  const float facing = n.dot(l);
  // Looked up a little off the surface, on the side of the light: a strip does not shade itself there.
  const Vec3 off = place + std::max(0.012, 8 * sheet.shadow.texel()) * (facing > 0 ? 1.0 : -1.0) * n.cast<double>();
  const float reached = 1 - sheet.shadow.at(off, 2, 2);
  const float sun = facing > 0 ? facing * reached : -0.18f * facing * reached;  // paper lets some pass
  const Point sky = Point(0.80f, 0.80f, 0.82f), ground = Point(0.50f, 0.46f, 0.43f);
  const Point around = ground + (0.5f + 0.5f * n.z()) * (sky - ground);
  const Point key = 0.80f * sun * Point(1.0f, 0.955f, 0.89f);
  const float shine = facing > 0 ? 0.05f * std::pow(std::max(0.0f, n.dot((l + eye).normalized())), 24.0f) : 0;
  const float head = 0.22f * std::abs(n.dot(eye));
  const Point white = shine * reached * Point::Ones();
  return shown(paint.cwiseProduct(around + key + head * Point::Ones()) + white);
}

/// The background of a pixel: paper, and the shadow on a floor below.
Point ground(const Sheet& sheet, int x, int y) {
  const Projection& projection = sheet.projection;
  const View& view = projection.camera.view;
  const Vec3 ray = view.right * ((x + 0.5) * fine - projection.centre.x()) / projection.scale -
                   view.up * ((y + 0.5) * fine - projection.centre.y()) / projection.scale - view.towards;
  const double along = (sheet.floor - projection.camera.eye.z()) / ray.z();
  if (!(along > 0) || !std::isfinite(along)) return paper;
  return paper * (1 - 0.34f * sheet.shadow.at(projection.camera.eye + along * ray, 4, 4));
}

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
      const auto nearness = static_cast<float>(w.a * patch.at[0].z() + w.b * patch.at[1].z() + w.c * patch.at[2].z());
      Sample& sample = at(x, y);
      if (nearness <= sample.nearness) return;
      sample.nearness = nearness;
      sample.patch = index;
    });
  }

  /// The colour of a patch at the middle of a pixel, or where it is nearest to it.
  Point colour_of_patch(const Patch& patch, int x, int y) const {
    const Plane plane(patch.at);
    const Weights w = plane((x + 0.5) * fine, (y + 0.5) * fine);
    const std::array<double, 3> share{std::max(0.0f, w.a) * patch.at[0].z(), std::max(0.0f, w.b) * patch.at[1].z(),
                                      std::max(0.0f, w.c) * patch.at[2].z()};
    Corner mean;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto part = static_cast<float>(share[c] / (share[0] + share[1] + share[2]));
      mean.position += part * patch.corners[c].position;
      mean.normal += part * patch.corners[c].normal;
      mean.colour += part * patch.corners[c].colour;
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
    const Vec2 from = stroke.from.head<2>(), way = (stroke.to - stroke.from).head<2>();
    const double length = way.norm(), h = stroke.half_width;
    if (!(length > 1e-6)) return;
    const Vec2 along = way / length, across(-along.y(), along.x());
    const auto within = [](double value, int low, int high) {
      return static_cast<int>(std::clamp(value, static_cast<double>(low), static_cast<double>(high)));
    };
    const int top = within(std::min(stroke.from.y(), stroke.to.y()) - h, window_.top, window_.bottom);
    const int bottom = within(std::max(stroke.from.y(), stroke.to.y()) + h + 1, window_.top, window_.bottom);
    for (int y = top; y < bottom; ++y) {
      // The part of the row within the line's width.
      const double dy = y + 0.5 - from.y();
      double left = std::min(0.0, way.x()) - h, right = std::max(0.0, way.x()) + h;
      if (std::abs(across.x()) > 1e-3) {
        const double centre = -dy * across.y() / across.x(), reach = h / std::abs(across.x());
        left = std::max(left, centre - reach - 1);
        right = std::min(right, centre + reach + 1);
      }
      const int end = within(from.x() + right + 1, 0, sheet_.width);
      for (int x = within(from.x() + left, 0, sheet_.width); x < end; ++x) {
        const Vec2 d(x + 0.5 - from.x(), dy);
        const double t = d.dot(along) / length;
        if (std::abs(d.dot(across)) > h || t < 0 || t >= 1) continue;
        const double nearness = (1 + line_bias) * (stroke.from.z() + t * (stroke.to.z() - stroke.from.z()));
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

void draw_band(const Sheet& sheet, int first_row, int rows, Image& image) { Band(sheet, first_row, rows).draw(image); }

}  // namespace wunderlich::picture
