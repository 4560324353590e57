/// What is measured on a shell.
#pragma once

#include "wunderlich/base/frame.hpp"
#include "wunderlich/baseline/shell/shell.hpp"
#include "wunderlich/baseline/shell/step.hpp"

namespace wunderlich::baseline::shell {

/// Positions of the mesh's vertices, those of ghosts included.
Points drawn_vertices(const Shell& shell, const Points& x);

/// The triangles of the strip without ghosts, with normals averaged at vertices.
Mesh surface_mesh(const Shell& shell, const Points& x);

/// Largest relative error of a length that is a constraint.
double length_error(const Shell& shell, const Points& x);

double kinetic_energy(const Shell& shell, const Points& v);

/// Of the strip without ghosts, 0 at the origin [J].
double gravity_energy(const Shell& shell, const Vec3& gravity, const Points& x);

/// 3 a point, without those of ghosts.
int degrees_of_freedom(const Shell& shell);
/// Scalar rows: lengths, and 3 a boundary vertex in a nonconforming shell.
int constraint_count(const Shell& shell);

}  // namespace wunderlich::baseline::shell
