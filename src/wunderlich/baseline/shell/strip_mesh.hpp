/// The regular triangulation of a flat strip that both shells start from.
#pragma once

#include <array>
#include <vector>

#include "wunderlich/base/types.hpp"

namespace wunderlich::baseline::shell {

struct Edge {
  std::array<int, 2> ends{};             ///< vertices
  std::array<int, 2> triangles{-1, -1};  ///< the second is -1 on the rim
  bool diagonal = false;
};

/// Cells are cut into two triangles to and fro like a chessboard: no handedness, and straight lines of edges lean both
/// ways. Vertex j of column i is number i * across + j. At a clamped end one more column stands outside the strip: its
/// cells are ghosts without energy that only give the strip's end its slope.
struct StripMesh {
  int columns = 0;                                 ///< with ghosts
  int across = 0;                                  ///< the paper's m
  std::array<int, 2> ghosts{};                     ///< columns outside the strip at its start and its end, 0 or 1
  double cell_length = 0;                          ///< [m]
  double cell_width = 0;                           ///< [m]
  std::vector<Vec2> vertices;                      ///< (u, v) in the flat strip, u = 0 at its start [m]
  std::vector<std::array<int, 3>> triangles;       ///< vertices
  std::vector<std::array<int, 3>> triangle_edges;  ///< [k] lies opposite vertex [k]
  std::vector<bool> ghost;                         ///< per triangle
  std::vector<Edge> edges;

  int vertex(int column, int row) const { return column * across + row; }
  double triangle_area() const { return cell_length * cell_width / 2; }  ///< of every triangle [m^2]
};

/// `along` >= 2 vertices over `length`, `across` >= 2 over `width` [m]; asserts otherwise.
StripMesh make_strip_mesh(double length, double width, int along, int across, std::array<bool, 2> ghosts);

/// Gradient in the flat strip of the linear function that is 1 at vertex `k` of a triangle and 0 at the others [1/m].
Vec2 hat_gradient(const StripMesh& mesh, int triangle, int k);

}  // namespace wunderlich::baseline::shell
