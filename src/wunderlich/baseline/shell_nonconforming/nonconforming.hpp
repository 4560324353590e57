/// The nonconforming shell of the paper's comparison: the midpoints of edges, every triangle rigid, triangles joined at
/// midpoints only.
#pragma once

#include "wunderlich/baseline/shell/shell.hpp"

namespace wunderlich::baseline::shell_nonconforming {

/// Three lengths a triangle, between its midpoints, so that it keeps its shape: 6 (m - 1)(n - 1). Bending with the
/// printed weight: triangles turn about their midpoints until the mean curvature is spread evenly over edges, as it
/// must be; but not in the rows along the rims, which are three times too stiff for it. Boundary rows: at each vertex
/// of the rim the triangles of its two rim edges meet, the paper's "conformity of boundary vertices". The drawn surface
/// has at each vertex the mean of where the triangles around it put it.   @eq English2008, Shen2015:6.6, Wardetzky2007
shell::Shell make_shell(const geometry::RibbonSpec& strip, const shell::Resolution& resolution);

/// Points of edges' midpoints from positions of vertices.
shell::Points midpoints(const shell::Shell& shell, const shell::Points& vertices);

}  // namespace wunderlich::baseline::shell_nonconforming
