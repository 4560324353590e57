#include "wunderlich/picture/draw.hpp"

#include <atomic>
#include <cassert>
#include <future>
#include <thread>

#include "wunderlich/picture/band.hpp"
#include "wunderlich/picture/colour.hpp"

namespace wunderlich::picture {

namespace {

constexpr int rows = 16;  // of pixels, drawn at a time

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
  out.camera.half_height /= style.zoom;
  if (style.colour != Colour::plain) out.range = range_of(shown, style.colour);
  return out;
}

Image draw(const Subject& subject, const Style& style, const Plan& plan, std::size_t k) {
  const Sheet sheet = sheet_of(subject, style, plan, k);
  Image image{style.width, style.height, {}};
  image.rgb.resize(3 * static_cast<std::size_t>(style.width) * static_cast<std::size_t>(style.height));
  std::atomic<int> next = 0;
  const auto work = [&] {
    for (int row = rows * next++; row < style.height; row = rows * next++) {
      draw_band(sheet, row, std::min(rows, style.height - row), image);
    }
  };
  std::vector<std::future<void>> helpers;  // which hand on what is thrown, as when memory ends
  for (unsigned i = 1; i < std::thread::hardware_concurrency(); ++i)
    helpers.push_back(std::async(std::launch::async, work));
  work();
  for (std::future<void>& helper : helpers) helper.get();
  return image;
}

Image still(const Subject& subject, const Style& style) {
  const std::size_t frame = style.frame.value_or(subject.frames.size() - 1);
  return draw(subject, style, plan(subject, style, {frame}), 0);
}

}  // namespace wunderlich::picture
