#include "wunderlich/scene/mesh_text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "wunderlich/base/error.hpp"
#include "wunderlich/scene/file_text.hpp"
#include "wunderlich/scene/text.hpp"

namespace wunderlich::scene {

namespace {

constexpr std::size_t kMostTriangles = 20000;
constexpr std::size_t kMostVertices = 100000;
constexpr double kFar = 1e9;  // m
constexpr std::size_t kLargestFile = std::size_t{3} << 20;

/// Words of a line, comments left out.
std::vector<std::string_view> words_of(std::string_view line) {
  line = line.substr(0, line.find('#'));
  std::vector<std::string_view> words;
  for (std::size_t at = 0; (at = line.find_first_not_of(" \t\r", at)) != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(" \t\r", at), line.size());
    words.push_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}

struct Reader {
  const std::string& source;
  double scale;
  long line = 0;
  std::vector<Vec3> vertices;
  std::vector<std::array<int, 3>> triangles;
  std::vector<long> lines;  ///< of the triangles

  [[noreturn]] void fail(const std::string& problem, long where) const {
    throw InputError(fmt::format("{}:{}: {}", source, where, problem));
  }

  void vertex(const std::vector<std::string_view>& words) {
    // After x y z files may give a weight or a colour.
    if (words.size() < 4) fail("a vertex has three coordinates", line);
    if (vertices.size() == kMostVertices) fail(fmt::format("more than {} vertices", kMostVertices), line);
    Vec3 point;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto parsed = parse_number(words[k + 1]);
      const double value = parsed ? scale * *parsed : HUGE_VAL;
      if (!(std::abs(value) <= kFar)) {
        fail(fmt::format("`{}` is not a coordinate; must be a number of size up to {:g} m", shown(words[k + 1]), kFar),
             line);
      }
      point[static_cast<int>(k)] = value;
    }
    vertices.push_back(point);
  }

  /// `7`, `7/1`, `7//3`, `7/1/3`; negative ones count from the last vertex back.
  int index(std::string_view word) const {
    const auto parsed = parse_whole(word.substr(0, word.find('/')));
    const long count = static_cast<long>(vertices.size());
    const long place = !parsed ? -1 : *parsed < 0 ? count + *parsed : *parsed - 1;
    if (place < 0 || place >= count) {
      fail(fmt::format("`{}` is not a vertex; there are {} above this line, from 1", shown(word), count), line);
    }
    return static_cast<int>(place);
  }

  void face(const std::vector<std::string_view>& words) {
    if (words.size() < 4) fail("a face has three corners or more", line);
    const int first = index(words[1]);
    for (std::size_t k = 2; k + 1 < words.size(); ++k) {
      if (triangles.size() == kMostTriangles) fail(fmt::format("more than {} triangles", kMostTriangles), line);
      triangles.push_back({first, index(words[k]), index(words[k + 1])});
      lines.push_back(line);
    }
  }

  void statement(std::string_view text) {
    const std::vector<std::string_view> words = words_of(text);
    if (words.empty()) return;
    if (words[0] == "v") return vertex(words);
    if (words[0] == "f") return face(words);
    for (const char* const other : {"vn", "vt", "vp", "o", "g", "s", "usemtl", "mtllib"}) {
      if (words[0] == other) return;
    }
    fail(fmt::format("`{}` is not understood; a mesh is vertices (`v x y z`) and faces (`f a b c`)", shown(words[0])),
         line);
  }

  void check() const {
    if (triangles.empty()) fail("there are no faces (`f a b c`)", line);
    const contact::FaultAt found = contact::find_fault(vertices, triangles);
    const long where = lines[found.triangle];
    switch (found.fault) {
      case contact::MeshFault::none:
        return;
      case contact::MeshFault::no_area:
        return fail("a face without area", where);
      case contact::MeshFault::open:
        return fail("the surface is open: an edge of this face has no neighbour", where);
      case contact::MeshFault::crowded:
        return fail("more than two faces meet at an edge of this one", where);
      case contact::MeshFault::turned:
        return fail(
            "this face and its neighbour are turned differently; corners go counter-clockwise seen from outside",
            where);
      case contact::MeshFault::inside_out:
        return fail("the surface is inside out; corners go counter-clockwise seen from outside", where);
    }
  }
};

void embed_mesh(const std::string& folder, const std::string& key, Value& obstacle) {
  const Value* shape = obstacle.find("shape");
  if (shape == nullptr || shape->text != "mesh") return;
  for (std::size_t i = 0; i < obstacle.names.size(); ++i) {
    Value& file = obstacle.items[i];
    if (obstacle.names[i] != "file" || file.kind != Value::Kind::scalar || file.text.empty()) continue;
    if (obstacle.find("obj") != nullptr)
      fail(obstacle.name_places[i], key + ".file", "not with `obj`, which is its text");
    const std::filesystem::path path = std::filesystem::path(folder) / file.text;
    try {
      file.text = file_text(path.string(), kLargestFile, "an OBJ file");
      mesh_from_obj(file.text, shown(path.string(), 4096), 1);
    } catch (const InputError& error) {
      fail(file.place, key + ".file", error.what());
    }
    file.quoted = true;
    obstacle.names[i] = "obj";
  }
}

}  // namespace

contact::TriangleMesh mesh_from_obj(const std::string& text, const std::string& source, double scale) {
  Reader reader{source, scale, 0, {}, {}, {}};
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    ++reader.line;
    reader.statement(std::string_view(text).substr(at, end - at));
    at = end + 1;
  }
  reader.check();
  return contact::make_mesh(std::move(reader.vertices), std::move(reader.triangles));
}

void embed_meshes(const std::string& folder, Value& document) {
  Value* const obstacles = document.find("obstacles");
  if (obstacles == nullptr || obstacles->kind != Value::Kind::list) return;
  for (std::size_t i = 0; i < obstacles->items.size(); ++i) {
    Value& obstacle = obstacles->items[i];
    if (obstacle.kind == Value::Kind::map) embed_mesh(folder, fmt::format("obstacles.{}", i), obstacle);
  }
}

}  // namespace wunderlich::scene
