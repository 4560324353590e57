#include "wunderlich/io/svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "wunderlich/io/xml.hpp"

namespace wunderlich::io {

namespace {

constexpr double mm = 1000;  // per metre

struct Box {
  double left = 0, right = 0, top = 0, bottom = 0;
};

/// Millimetres, y down as SVG has it.
Vec2 on_paper(const Vec2& p) { return {mm * p.x(), -mm * p.y()}; }

Box bounds(const FlatPattern& pattern) {
  Box box{0, mm * pattern.length, -0.5 * mm * pattern.width, 0.5 * mm * pattern.width};
  for (const auto& ruling : {pattern.rulings.front(), pattern.rulings.back()}) {
    for (const Vec2& end : ruling) {
      box.left = std::min(box.left, on_paper(end).x());
      box.right = std::max(box.right, on_paper(end).x());
    }
  }
  return box;
}

/// Fold lines of one sign, those at the ends left out: they lie on the cut.
std::string folds(const FlatPattern& pattern, double sign, double largest) {
  std::string out;
  for (std::size_t i = 1; i + 1 < pattern.rulings.size(); ++i) {
    const double angle = sign * pattern.fold_angle[i];
    if (angle <= 1e-9) continue;
    const Vec2 a = on_paper(pattern.rulings[i][0]);
    const Vec2 b = on_paper(pattern.rulings[i][1]);
    out += fmt::format(
        R"(<line x1="{:.4f}" y1="{:.4f}" x2="{:.4f}" y2="{:.4f}" opacity="{:.3f}"><title>node {}: {:.3f} degrees</title></line>)",
        a.x(), a.y(), b.x(), b.y(), 0.2 + 0.8 * angle / largest, i, angle * 180 / std::numbers::pi);
    out += '\n';
  }
  return out;
}

std::string outline(const FlatPattern& pattern) {
  const auto& first = pattern.rulings.front();
  const auto& last = pattern.rulings.back();
  std::string points;
  for (const Vec2& p : {first[0], last[0], last[1], first[1]}) {
    points += fmt::format("{:.4f},{:.4f} ", on_paper(p).x(), on_paper(p).y());
  }
  return points;
}

/// A length of 1, 2 or 5 times a power of ten, about a quarter of the strip [mm].
double bar_length(double length) {
  const double quarter = 0.25 * length, unit = std::pow(10, std::floor(std::log10(quarter)));
  return unit * (quarter >= 5 * unit ? 5 : quarter >= 2 * unit ? 2 : 1);
}

/// A bar to hold a ruler to, with its length beside it.
std::string scale_bar(double left, double y, double letter, double length) {
  return fmt::format(
      "<g id=\"scale\"><path d=\"M{0:.4f} {2:.4f}V{3:.4f}H{1:.4f}V{2:.4f}\"/>"
      "<text x=\"{4:.4f}\" y=\"{3:.4f}\">{5:g} mm</text></g>\n",
      left, left + length, y - 0.6 * letter, y, left + length + 0.5 * letter, length);
}

/// How the ends meet.
std::string joint(const FlatPattern& pattern) {
  if (!pattern.loop) return "";
  if (pattern.half_twists == 0) return "; join the ends without a turn";
  return fmt::format("; join the ends after {} half turn{}, {}-handed", std::abs(pattern.half_twists),
                     std::abs(pattern.half_twists) == 1 ? "" : "s", pattern.half_twists > 0 ? "right" : "left");
}

}  // namespace

std::string pattern_svg(const FlatPattern& pattern, const std::string& title) {
  assert(pattern.rulings.size() >= 2 && pattern.rulings.size() == pattern.fold_angle.size());
  double largest = 0;
  for (const double angle : pattern.fold_angle) largest = std::max(largest, std::abs(angle));
  const Box box = bounds(pattern);
  const double margin = 5;                                                    // mm
  const double letter = std::clamp(0.01 * (box.right - box.left), 2.5, 60.);  // mm
  const double left = box.left - margin, top = box.top - margin;
  const double width = box.right - box.left + 2 * margin;
  const double height = box.bottom - box.top + 2 * margin + 4 * letter;
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{2:.4f}mm\" height=\"{3:.4f}mm\" "
      "viewBox=\"{0:.4f} {1:.4f} {2:.4f} {3:.4f}\">\n<title>{4}</title>\n",
      left, top, width, height, escaped_xml(title));
  // Lines one pixel wide at any zoom (a quarter of a millimetre on paper): a strip may be 6 mm long or 6 m. Cuts are
  // red hairlines, as cutting machines know them.
  out += fmt::format(
      "<style>#cut,#valley,#mountain,#scale path{{fill:none;stroke:#000;stroke-width:1px}} "
      "#cut *,#valley *,#mountain *,#scale path{{vector-effect:non-scaling-stroke}} "
      "#cut{{stroke:#f00;stroke-width:.3px}} #valley{{stroke:#1257c2;stroke-dasharray:6 3}} "
      "#mountain{{stroke-dasharray:6 2 1 2}} text{{font:{:.3f}px sans-serif;fill:#444}}</style>\n",
      letter);
  out += "<g id=\"valley\">\n" + folds(pattern, 1, largest) + "</g>\n";
  out += "<g id=\"mountain\">\n" + folds(pattern, -1, largest) + "</g>\n";
  out += fmt::format("<g id=\"cut\"><polygon points=\"{}\"/></g>\n", outline(pattern));
  out += fmt::format(
      "<g id=\"legend\"><text x=\"{:.4f}\" y=\"{:.4f}\">{}: {:.6g} × {:.6g} mm, front; red: cut, blue dashes: valley, "
      "black dots and dashes: mountain{}</text></g>\n",
      box.left, box.bottom + 1.6 * letter, escaped_xml(title), mm * pattern.length, mm * pattern.width, joint(pattern));
  out += scale_bar(box.left, box.bottom + 3.4 * letter, letter, bar_length(mm * pattern.length));
  return out + "</svg>\n";
}

}  // namespace wunderlich::io
