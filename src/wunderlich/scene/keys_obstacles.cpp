#include "wunderlich/scene/schema.hpp"

namespace wunderlich::scene {

namespace {

constexpr double far = 1e9;         // m
constexpr double short_ = 1e-6;     // m
constexpr double long_time = 1e9;   // s
constexpr double many_turns = 1e4;  // rad

const std::vector<Key> table = {
    {"obstacles", Type::list, "", 0, 1000, "", {}, "Solids that the strip cannot enter, at rest or moving."},
    {"obstacles.*.shape",
     Type::choice,
     "",
     0,
     0,
     "",
     {"plane", "sphere", "cylinder", "capsule", "box", "mesh"},
     "`plane`: all that is below it. `cylinder`: with flat ends. `capsule`: with round ends. `mesh`: inside a closed "
     "surface of triangles. Required."},
    {"obstacles.*.radius", Type::number, "m", short_, far, "", {}, "Of a sphere, cylinder or capsule. Required there."},
    {"obstacles.*.length",
     Type::number,
     "m",
     short_,
     far,
     "",
     {},
     "Of a cylinder, endless without it; of a capsule without its round ends, required there."},
    {"obstacles.*.size",
     Type::vector,
     "m",
     short_,
     far,
     "",
     {},
     "Edges of a box along `side`, square to it, and along "
     "`axis`. Required there."},
    {"obstacles.*.file",
     Type::text,
     "",
     0,
     0,
     "",
     {},
     "Of a mesh: an OBJ file, found from the folder of the scene file on. It is read once: runs keep its text as "
     "`obj`."},
    {"obstacles.*.obj", Type::lines, "", 0, 0, "", {}, "Of a mesh, instead of `file`: the text of an OBJ file."},
    {"obstacles.*.scale", Type::number, "", short_, far, "1", {}, "Of a mesh: metres that its unit of length is."},
    {"obstacles.*.position",
     Type::vector,
     "m",
     -far,
     far,
     "[0, 0, 0]",
     {},
     "Of the center; of a point of a plane; of a mesh's origin."},
    {"obstacles.*.axis",
     Type::vector,
     "",
     -far,
     far,
     "[0, 0, 1]",
     {},
     "Direction of the axis of a cylinder or capsule, of the third edge of a box, of a mesh's z, of the axis of "
     "`turn`; "
     "any length."},
    {"obstacles.*.normal",
     Type::vector,
     "",
     -far,
     far,
     "[0, 0, 1]",
     {},
     "Of a plane, instead of `axis`: towards the free side; any length."},
    {"obstacles.*.side",
     Type::vector,
     "",
     -far,
     far,
     "[1, 0, 0]",
     {},
     "Of a box or mesh: direction of its first edge or its x, perpendicular to the axis; any length."},
    {"obstacles.*.turn",
     Type::number,
     "rad",
     -many_turns,
     many_turns,
     "0",
     {},
     "A further rotation about the axis, right-handed. It may exceed a full turn."},
    {"obstacles.*.friction", Type::number, "", 0, 100, "", {}, "Coulomb's coefficient. Default: `contact.friction`."},
    {"obstacles.*.keyframes",
     Type::list,
     "",
     0,
     10000,
     "",
     {},
     "Motion, as for clamps: a solid without a keyframe at 0 starts where its first one has it. What is no box or mesh "
     "does not turn about its axis while the axis changes."},
    {"obstacles.*.keyframes.*.time", Type::number, "s", 0, long_time, "", {}, "Increasing. Required."},
    {"obstacles.*.keyframes.*.position", Type::vector, "m", -far, far, "", {}, "As above."},
    {"obstacles.*.keyframes.*.axis", Type::vector, "", -far, far, "", {}, "As above."},
    {"obstacles.*.keyframes.*.normal", Type::vector, "", -far, far, "", {}, "As above."},
    {"obstacles.*.keyframes.*.side", Type::vector, "", -far, far, "", {}, "As above."},
    {"obstacles.*.keyframes.*.turn", Type::number, "rad", -many_turns, many_turns, "", {}, "As above."},

    {"contact", Type::map, "", 0, 0, "", {}, "How the strip touches obstacles and itself."},
    {"contact.self", Type::boolean, "", 0, 0, "false", {}, "Does the strip touch itself? Otherwise it passes through."},
    {"contact.friction",
     Type::number,
     "",
     0,
     100,
     "0",
     {},
     "Coulomb's coefficient of obstacles that have none of their own, and of the strip on itself (`contact.self`)."},
    {"contact.distance",
     Type::number,
     "m",
     1e-9,
     far,
     "",
     {},
     "Gap below which contact forces act; at rest a part of it stays. Two-stage: how fine the points are that feel a "
     "solid; a quarter of it stays. Default: width/30."},
    {"contact.thickness",
     Type::number,
     "m",
     0,
     far,
     "0",
     {},
     "Kept between the strip's middle surface and a solid, and between two parts of it, beside the gap: half the "
     "strip's "
     "thickness for solids, all of it for the strip itself."},
};

}  // namespace

const std::vector<Key>& obstacle_keys() { return table; }

}  // namespace wunderlich::scene
