#include "wunderlich/io/svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <vector>

#include "wunderlich/io/millimetres.hpp"
#include "wunderlich/io/xml.hpp"

namespace wunderlich::io {

namespace {

struct Box {
  double left = 0, right = 0, top = 0, bottom = 0;
};

/// Millimetres, y down as SVG has it.
Vec2 on_paper(const Vec2& p) { return {mm * p.x(), -mm * p.y()}; }

/// A group that Inkscape shows as a layer of its own. All style is in attributes: programs of cutting machines read no
/// style sheets.
std::string layer(const std::string& name, const std::string& style, const std::string& content) {
  return fmt::format("<g id=\"{0}\" inkscape:groupmode=\"layer\" inkscape:label=\"{0}\" {1}>\n{2}</g>\n", name, style,
                     content);
}

/// The strip, and at the far end of a loop the tab: half a width long, a tenth of the length at most.
std::vector<Vec2> outline(const FlatPattern& pattern) {
  const auto& first = pattern.rulings.front();
  const auto& last = pattern.rulings.back();
  std::vector<Vec2> corners{on_paper(first[0]), on_paper(last[0])};
  if (pattern.loop) {
    const Vec2 along(std::min(0.5 * pattern.width, 0.1 * pattern.length), 0);
    const Vec2 across = 0.12 * (last[1] - last[0]);
    corners.push_back(on_paper(last[0] + across + along));
    corners.push_back(on_paper(last[1] - across + along));
  }
  corners.push_back(on_paper(last[1]));
  corners.push_back(on_paper(first[1]));
  return corners;
}

Box bounds(const std::vector<Vec2>& corners) {
  Box box{corners[0].x(), corners[0].x(), corners[0].y(), corners[0].y()};
  for (const Vec2& corner : corners) {
    box = {std::min(box.left, corner.x()), std::max(box.right, corner.x()), std::min(box.top, corner.y()),
           std::max(box.bottom, corner.y())};
  }
  return box;
}

/// Fold lines of one sign, those at the ends left out: they lie on the cut or on the joint.
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

std::string cut(const std::vector<Vec2>& corners) {
  std::string points;
  for (const Vec2& corner : corners) points += fmt::format("{:.4f},{:.4f} ", corner.x(), corner.y());
  return fmt::format("<polygon points=\"{}\"/>\n", points);
}

std::string text(double x, double y, const std::string& content) {
  return fmt::format("<text x=\"{:.4f}\" y=\"{:.4f}\">{}</text>\n", x, y, escaped_xml(content));
}

/// Where the other end of a loop comes to lie, and a letter in each corner: equal ones meet.
std::string joint(const FlatPattern& pattern, double letter) {
  const Vec2 a = on_paper(pattern.rulings.back()[0]), b = on_paper(pattern.rulings.back()[1]);
  std::string out = fmt::format("<line x1=\"{:.4f}\" y1=\"{:.4f}\" x2=\"{:.4f}\" y2=\"{:.4f}\" stroke=\"#080\"/>\n",
                                a.x(), a.y(), b.x(), b.y());
  const bool turned = pattern.half_twists % 2 != 0;
  for (const bool end : {false, true}) {
    for (const std::size_t side : {0u, 1u}) {
      const auto& ruling = end ? pattern.rulings.back() : pattern.rulings.front();
      const Vec2 corner = on_paper(ruling[side]);
      const Vec2 inwards = (on_paper(ruling[1 - side]) - corner).normalized();
      const Vec2 at = corner + letter * Vec2(end ? -1.2 : 1.2, 0) + 1.1 * letter * inwards;
      out += text(at.x(), at.y() + 0.35 * letter, (side == 0) != (end && turned) ? "A" : "B");
    }
  }
  return out;
}

/// A length of 1, 2 or 5 times a power of ten, about a quarter of the strip [mm].
double bar_length(double length) {
  const double quarter = 0.25 * length, unit = std::pow(10, std::floor(std::log10(quarter)));
  return unit * (quarter >= 5 * unit ? 5 : quarter >= 2 * unit ? 2 : 1);
}

/// A bar to hold a ruler to, with its length beside it.
std::string scale_bar(double left, double y, double letter, double length) {
  return fmt::format("<path d=\"M{0:.4f} {2:.4f}V{3:.4f}H{1:.4f}V{2:.4f}\" fill=\"none\" stroke=\"#444\"/>\n", left,
                     left + length, y - 0.6 * letter, y) +
         text(left + length + 0.5 * letter, y, fmt::format("{:g} mm", length));
}

std::vector<std::string> legend(const FlatPattern& pattern, const std::string& title) {
  std::vector<std::string> lines{
      fmt::format("{}: {:.6g} × {:.6g} mm, seen from the front", title, mm * pattern.length, mm * pattern.width),
      "red: cut; blue dashes: fold towards you (valley); black dots and dashes: fold away (mountain); darker is "
      "sharper"};
  if (pattern.loop) {
    const int turns = std::abs(pattern.half_twists);
    const std::string turn = turns == 0 ? "without a turn"
                                        : fmt::format("after {} half turn{}, {}-handed", turns, turns == 1 ? "" : "s",
                                                      pattern.half_twists > 0 ? "right" : "left");
    lines.push_back(fmt::format(
        "loop: join the ends {}: the tab under the other end, up to the green line, A on A and B on B", turn));
  }
  return lines;
}

double widest(const std::vector<std::string>& lines, double letter) {
  std::size_t most = 0;
  for (const std::string& line : lines) most = std::max(most, line.size());
  return 0.58 * letter * static_cast<double>(most);  // of a usual sans-serif
}

}  // namespace

std::string pattern_svg(const FlatPattern& pattern, const std::string& title) {
  assert(pattern.rulings.size() >= 2 && pattern.rulings.size() == pattern.fold_angle.size());
  double largest = 0;
  for (const double angle : pattern.fold_angle) largest = std::max(largest, std::abs(angle));
  const std::vector<Vec2> corners = outline(pattern);
  const Box box = bounds(corners);
  const double margin = 5;                                                    // mm
  const double letter = std::clamp(0.01 * (box.right - box.left), 2.5, 60.);  // mm
  const std::vector<std::string> lines = legend(pattern, title);
  const double bar = bar_length(mm * pattern.length);
  const double width = std::max(box.right - box.left, widest(lines, letter)) + 2 * margin;
  const double below = letter * (3.5 + 1.5 * static_cast<double>(lines.size()));
  const double height = box.bottom - box.top + 2 * margin + below;
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" "
      "width=\"{2:.4f}mm\" height=\"{3:.4f}mm\" viewBox=\"{0:.4f} {1:.4f} {2:.4f} {3:.4f}\">\n<title>{4}</title>\n",
      box.left - margin, box.top - margin, width, height, escaped_xml(title));
  out += "<desc>";
  for (const std::string& line : lines) out += escaped_xml(line) + "; ";
  out += "one unit is one millimetre</desc>\n";
  // A tenth of a millimetre, and more on sheets so long that one sees them from afar.
  const std::string line = fmt::format("stroke-width=\"{:.3f}\"", 0.04 * letter);
  const std::string words =
      fmt::format("font-family=\"sans-serif\" font-size=\"{:.3f}\" fill=\"#444\" ", letter) + line;
  std::string written;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    written += text(box.left, box.bottom + letter * (2 + 1.5 * static_cast<double>(i)), lines[i]);
  }
  out += layer("legend", words, written);
  out += layer("scale", words, scale_bar(box.left, box.bottom + below, letter, bar));
  const auto fold = [&](const char* colour, const std::vector<double>& dashes) {
    std::string style = "fill=\"none\" " + line + fmt::format(" stroke=\"{}\" stroke-dasharray=\"", colour);
    for (const double dash : dashes)
      style += fmt::format("{:.3f} ", dash * std::min(0.5 * letter, 0.05 * mm * pattern.width));
    return style + "\"";
  };
  out += layer("valley", fold("#00f", {2, 1}), folds(pattern, 1, largest));
  out += layer("mountain", fold("#000", {2, 0.7, 0.3, 0.7}), folds(pattern, -1, largest));
  if (pattern.loop) out += layer("joint", words + " text-anchor=\"middle\"", joint(pattern, letter));
  // In the red that cutting machines cut by; a hairline to Inkscape and to what Inkscape prints by.
  out += layer("cut", "fill=\"none\" stroke=\"#f00\" style=\"-inkscape-stroke:hairline\" " + line, cut(corners));
  return out + "</svg>\n";
}

}  // namespace wunderlich::io
