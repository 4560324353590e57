#include "baseline/shells.hpp"

#include <random>

#include "wunderlich/baseline/shell_conforming/conforming.hpp"
#include "wunderlich/baseline/shell_nonconforming/nonconforming.hpp"

namespace wunderlich::baseline::shell {

Shell make(Kind kind, const geometry::RibbonSpec& strip, int along, int across) {
  const Resolution resolution{along, across};
  return kind == Kind::conforming ? shell_conforming::make_shell(strip, resolution)
                                  : shell_nonconforming::make_shell(strip, resolution);
}

Points placed(const Shell& shell, Kind kind, Vec3 (*place)(const Vec2&)) {
  Points vertices(static_cast<Eigen::Index>(shell.mesh.vertices.size()), 3);
  for (Eigen::Index v = 0; v < vertices.rows(); ++v) {
    vertices.row(v) = place(shell.mesh.vertices[static_cast<std::size_t>(v)]).transpose();
  }
  return kind == Kind::conforming ? vertices : shell_nonconforming::midpoints(shell, vertices);
}

Points shaken(const Shell& shell, unsigned seed, double size) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> shift(-size, size);
  Points x = straight_points(shell);
  for (double& value : x.reshaped()) value += shift(random);
  return x;
}

constraint::Support clamp_at(const geometry::RibbonSpec& strip, bool end) {
  constraint::Support support;
  support.node = end ? strip.segments : 0;
  const Quat frame(Mat3{{0, 0, 1}, {0, -1, 0}, {1, 0, 0}});
  support.motion.keys = {{0, {Vec3(end ? strip.length : 0, 0, 0), frame}, 0}};
  return support;
}

}  // namespace wunderlich::baseline::shell
