/// The conforming shell of the paper's comparison: the vertices of a triangulated strip, every edge of constant length.
#pragma once

#include "wunderlich/baseline/shell/shell.hpp"

namespace wunderlich::baseline::shell_conforming {

/// Lengths stand in two sets, warp and weft, and diagonals: enforced together they depend on one another in a plane.
/// (The springs that Goldenthal et al. leave on the diagonals are constraints as well, as the paper has it.) Edges of
/// ghosts are none: their points are held.
///
/// The bending takes a third of the printed weight. The printed one averages the square of a mean curvature that stands
/// on one edge of three alone when a strip is bent along its length, and so gives three times the energy; no motion of
/// vertices can spread it. @eq Shen2015:6.6, Goldenthal2007, Wardetzky2007
shell::Shell make_shell(const geometry::RibbonSpec& strip, const shell::Resolution& resolution);

}  // namespace wunderlich::baseline::shell_conforming
