#include <algorithm>

#include "wunderlich/scene/key_bounds.hpp"
#include "wunderlich/scene/schema.hpp"

namespace wunderlich::scene {

namespace {

using namespace bound;

const std::vector<Key> before_solver = {
    {"title", Type::text, "", 0, 0, "", {}, "One line that says what the scene shows; `wunderlich scenes` prints it."},

    {"ribbon", Type::map, "", 0, 0, "", {}, "The strip."},
    {"ribbon.length", Type::number, "m", tiny, far, "", {}, "Length of the centerline l. Required."},
    {"ribbon.width", Type::number, "m", tiny, far, "", {}, "Full width w. Required, unless `aspect` is given."},
    {"ribbon.aspect", Type::number, "", 1e-3, 1e6, "", {}, "l/w, instead of `width`."},
    {"ribbon.segments", Type::integer, "", 2, 1e6, "50", {}, "Number of segments n the strip is divided into."},
    {"ribbon.bending_stiffness",
     Type::number,
     "N m",
     1e-15,
     1e15,
     "1",
     {},
     "D, bending moment per width and curvature."},
    {"ribbon.area_density", Type::number, "kg/m^2", 1e-9, 1e9, "1", {}, "Mass per area."},
    {"ribbon.young_modulus",
     Type::number,
     "Pa",
     1e-3,
     1e15,
     "",
     {},
     "E. With `thickness` and `poisson_ratio` instead of `bending_stiffness`: D = E h^3 / (12 (1 - nu^2))."},
    {"ribbon.thickness", Type::number, "m", 1e-9, 1e3, "", {}, "h, for `young_modulus` and `mass_density`."},
    {"ribbon.poisson_ratio", Type::number, "", -0.99, 0.5, "0.3", {}, "nu, for `young_modulus`."},
    {"ribbon.mass_density",
     Type::number,
     "kg/m^3",
     1e-3,
     1e9,
     "",
     {},
     "With `thickness` instead of `area_density`: area density = `mass_density` h."},
    {"ribbon.closure", Type::choice, "", 0, 0, "open", {"open", "loop"}, "Whether the two ends are joined."},
    {"ribbon.half_twists",
     Type::integer,
     "",
     -8,
     8,
     "0",
     {},
     "Loops: half turns of the frame about the tangent, right-handed as u grows. Odd: one-sided, a Moebius band."},
    {"ribbon.free_rulings",
     Type::boolean,
     "",
     0,
     0,
     "false",
     {},
     "Open strips: leave the ruling slope free at the ends. Otherwise the rulings stand square to the strip there."},
    {"ribbon.spacing",
     Type::numbers,
     "",
     1e-6,
     1e6,
     "",
     {},
     "Relative lengths of the segments, one number a segment. Without it all segments are equal."},

    {"clamps",
     Type::list,
     "",
     0,
     1000,
     "",
     {},
     "Places whose frame is held. At an end of the strip the frame of the end itself is held; inside, that of a "
     "segment."},
    {"clamps.*.at",
     Type::place,
     "",
     0,
     0,
     "",
     {"start", "end"},
     "Where: `start`, `end`, or a map with one of the keys below. Required."},
    {"clamps.*.at.node", Type::integer, "", 0, 1e6, "", {}, "Index of the first or the last node."},
    {"clamps.*.at.segment", Type::integer, "", 0, 1e6, "", {}, "Index of a segment, from 0."},
    {"clamps.*.at.u", Type::number, "m", 0, far, "", {}, "Arc length; the segment that holds it."},
    {"clamps.*.position",
     Type::vector,
     "m",
     -far,
     far,
     "",
     {},
     "Of the end node, or of the segment's first node. Default: where the undeformed strip has it."},
    {"clamps.*.tangent", Type::vector, "", -far, far, "[1, 0, 0]", {}, "Direction d3 of the centerline; any length."},
    {"clamps.*.normal",
     Type::vector,
     "",
     -far,
     far,
     "[0, 0, 1]",
     {},
     "Direction d1 of the surface normal, perpendicular to the tangent; any length."},
    {"clamps.*.turn",
     Type::number,
     "rad",
     -many_turns,
     many_turns,
     "0",
     {},
     "A further rotation about the tangent, right-handed. It may exceed a full turn."},
    {"clamps.*.free", Type::choices, "", 0, 3, "[]", {"x", "y", "z"}, "World directions in which the place may slide."},
    {"clamps.*.orientation",
     Type::choice,
     "",
     0,
     0,
     "full",
     {"full", "about-tangent"},
     "`full` holds the whole frame; `about-tangent` only the rotation about the centerline."},
    {"clamps.*.release", Type::number, "s", 0, long_time, "", {}, "Dynamics: when it lets go. Default: never."},
    {"clamps.*.keyframes",
     Type::list,
     "",
     0,
     10000,
     "",
     {},
     "Motion: constant before the first and after the last keyframe. In between positions and turns are linear in "
     "time, frames take the shorter rotation. What a keyframe omits stays as it was in the one before, or in the "
     "clamp itself."},
    {"clamps.*.keyframes.*.time", Type::number, "s", 0, long_time, "", {}, "Increasing. Required."},
    {"clamps.*.keyframes.*.position", Type::vector, "m", -far, far, "", {}, "As above."},
    {"clamps.*.keyframes.*.tangent", Type::vector, "", -far, far, "", {}, "As above."},
    {"clamps.*.keyframes.*.normal", Type::vector, "", -far, far, "", {}, "As above."},
    {"clamps.*.keyframes.*.turn", Type::number, "rad", -many_turns, many_turns, "", {}, "As above."},

    {"pins", Type::list, "", 0, 1000, "", {}, "Nodes whose position alone is held."},
    {"pins.*.at",
     Type::place,
     "",
     0,
     0,
     "",
     {"start", "end"},
     "Where: `start`, `end`, or a map with one of the keys below. Required."},
    {"pins.*.at.node", Type::integer, "", 0, 1e6, "", {}, "Index of a node, from 0."},
    {"pins.*.at.u", Type::number, "m", 0, far, "", {}, "Arc length; the node nearest to it."},
    {"pins.*.position", Type::vector, "m", -far, far, "", {}, "Default: where the undeformed strip has it."},
    {"pins.*.free", Type::choices, "", 0, 3, "[]", {"x", "y", "z"}, "World directions in which the node may slide."},
    {"pins.*.release", Type::number, "s", 0, long_time, "", {}, "Dynamics: when it lets go. Default: never."},
    {"pins.*.keyframes", Type::list, "", 0, 10000, "", {}, "Motion, as for clamps."},
    {"pins.*.keyframes.*.time", Type::number, "s", 0, long_time, "", {}, "Increasing. Required."},
    {"pins.*.keyframes.*.position", Type::vector, "m", -far, far, "", {}, "As above."},

    {"forces", Type::list, "", 0, 1000, "", {}, "Forces and torques on nodes. Several on one node add up."},
    {"forces.*.at",
     Type::place,
     "",
     0,
     0,
     "",
     {"start", "end"},
     "Where: `start`, `end`, or a map with one of the keys below. Required."},
    {"forces.*.at.node", Type::integer, "", 0, 1e6, "", {}, "Index of a node, from 0."},
    {"forces.*.at.u", Type::number, "m", 0, far, "", {}, "Arc length; the node nearest to it."},
    {"forces.*.force", Type::vector, "N", -strong, strong, "[0, 0, 0]", {}, "Force."},
    {"forces.*.torque", Type::vector, "N m", -strong, strong, "[0, 0, 0]", {}, "Torque."},
    {"forces.*.frame",
     Type::choice,
     "",
     0,
     0,
     "space",
     {"space", "material"},
     "Axes of the components: the world's x, y, z, or the moving d1, d2, d3 of the place."},
    {"forces.*.keyframes",
     Type::list,
     "",
     0,
     10000,
     "",
     {},
     "Change in time: linear between keyframes, constant before the first and after the last."},
    {"forces.*.keyframes.*.time", Type::number, "s", 0, long_time, "", {}, "Increasing. Required."},
    {"forces.*.keyframes.*.force", Type::vector, "N", -strong, strong, "", {}, "As above."},
    {"forces.*.keyframes.*.torque", Type::vector, "N m", -strong, strong, "", {}, "As above."},

    {"gravity", Type::vector, "m/s^2", -1e6, 1e6, "[0, 0, 0]", {}, "Acceleration of free fall."},

    {"initial", Type::map, "", 0, 0, "", {}, "Dynamics: where the motion starts."},
    {"initial.shape",
     Type::choice,
     "",
     0,
     0,
     "",
     {"straight", "coil", "profile", "closed", "equilibrium"},
     "`straight`: undeformed. `coil`: constant curvature and ruling slope. `profile`: both as given by "
     "`initial.profile`. `closed`: a loop just closed, not yet at "
     "rest. `equilibrium`: at rest under the supports and loads of time 0 (of a free strip: under none). Default: "
     "`straight`, for loops "
     "`equilibrium`."},
    {"initial.radius",
     Type::number,
     "m",
     tiny,
     far,
     "",
     {},
     "Of a coil: 1/radius is its principal curvature. Required there."},
    {"initial.slope", Type::number, "", -10, 10, "0", {}, "Of a coil: eta; the coil climbs when it is not 0."},
    {"initial.position",
     Type::vector,
     "m",
     -far,
     far,
     "[0, 0, 0]",
     {},
     "Where a strip that nothing holds has its first node; clamps and pins place the others."},
    {"initial.tangent",
     Type::vector,
     "",
     -far,
     far,
     "[1, 0, 0]",
     {},
     "And the direction d3 of its first segment; any length."},
    {"initial.normal",
     Type::vector,
     "",
     -far,
     far,
     "[0, 0, 1]",
     {},
     "And the direction d1 there, perpendicular to the tangent; any length."},
    {"initial.profile",
     Type::list,
     "",
     2,
     10000,
     "",
     {},
     "How the strip is bent: curvature of its centerline and slope of its rulings, linear between these places, "
     "constant "
     "beyond them. Any strip whose curvature is nowhere 0 but at its ends can be given so."},
    {"initial.profile.*.at", Type::number, "", 0, 1, "", {}, "Arc length over length, increasing. Required."},
    {"initial.profile.*.curvature", Type::number, "1/m", -1e6, 1e6, "0", {}, "Of the centerline."},
    {"initial.profile.*.slope", Type::number, "", -10, 10, "0", {}, "Eta: torsion over curvature."},
    {"initial.velocity", Type::vector, "m/s", -1e6, 1e6, "[0, 0, 0]", {}, "Velocity of the whole strip."},
    {"initial.spin", Type::vector, "rad/s", -1e6, 1e6, "[0, 0, 0]", {}, "Angular velocity about the center of mass."},
};

/// A strip of several has its own of these.
bool belongs_to_a_strip(const std::string& path) {
  const std::string section = path.substr(0, path.find('.'));
  return section == "ribbon" || section == "clamps" || section == "pins" || section == "forces" || section == "initial";
}

/// The strips of a scene with several: each has the keys of `ribbon`, and the sections that belong to a strip.
std::vector<Key> strip_keys() {
  std::vector<Key> list{
      {"ribbons",
       Type::list,
       "",
       0,
       1000,
       "",
       {},
       "Several strips in one scene, instead of `ribbon`. Each entry has the keys of `ribbon` itself, a `name`, and "
       "its "
       "own `clamps`, `pins`, `forces` and `initial`; everything else is common to all. With "
       "`contact.self: true` they touch one another. Several strips move with `solver.method: implicit`."},
      {"ribbons.*.name", Type::text, "", 0, 0, "", {}, "What the strip is called in the report."}};
  for (Key key : before_solver) {
    if (!belongs_to_a_strip(key.path) || key.path == "ribbon") continue;
    key.path = "ribbons.*." + (key.path.compare(0, 7, "ribbon.") == 0 ? key.path.substr(7) : key.path);
    list.push_back(key);
  }
  return list;
}

const std::vector<Key> after_solver = {
    {"output", Type::map, "", 0, 0, "", {}, "What the run folder holds."},
    {"output.frames", Type::integer, "", 1, 100000, "60", {}, "At most so many recorded frames."},
    {"output.subdivision", Type::integer, "", 1, 64, "3", {}, "Rendered strips a segment, along the length."},
    {"output.across", Type::integer, "", 1, 256, "8", {}, "Rendered quads across the width."},
    {"output.formats",
     Type::choices,
     "",
     0,
     10,
     "[vtp, glb, svg, html, png]",
     {"vtp", "glb", "pc2", "obj", "stl", "3mf", "svg", "html", "png", "mp4"},
     "Files to write beside the tables; `--formats` on the command line goes before it."},
};

}  // namespace

const std::vector<Key>& keys() {
  static const std::vector<Key> table = [] {
    std::vector<Key> all = before_solver;
    const std::vector<Key> strips = strip_keys();
    all.insert(all.end(), strips.begin(), strips.end());
    all.insert(all.end(), obstacle_keys().begin(), obstacle_keys().end());
    all.insert(all.end(), solver_keys().begin(), solver_keys().end());
    all.insert(all.end(), compare_keys().begin(), compare_keys().end());
    all.insert(all.end(), after_solver.begin(), after_solver.end());
    return all;
  }();
  return table;
}

const Key* find_key(const std::string& pattern) {
  const std::vector<Key>& table = keys();
  const auto found = std::find_if(table.begin(), table.end(), [&](const Key& key) { return key.path == pattern; });
  return found == table.end() ? nullptr : &*found;
}

}  // namespace wunderlich::scene
