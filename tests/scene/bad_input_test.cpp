#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "messages.hpp"

namespace wunderlich::scene {
namespace {

const std::string strip = "ribbon: {length: 2, width: 0.5, segments: 4}\n";

TEST(BadInput, UnknownKeysNameThePlaceAndTheNearMiss) {
  expect_all(message_of("title: x\nribon: {length: 1}\n"),
             {"bad.yaml:2:1: ribon: unknown key", "did you mean `ribbon`?"});
  expect_all(message_of("ribbon:\n  lenght: 1\n"),
             {"bad.yaml:2:3: ribbon.lenght", "did you mean `length`?", "half_twists"});
  expect_all(message_of(strip + "width: 1\n"), {"bad.yaml:2:1: width", "did you mean `ribbon.width`?"});
  expect_all(message_of(strip + "clamps:\n  - {at: start, turns: 1}\n"), {"bad.yaml:3:17: clamps.0.turns", "`turn`"});
  expect_all(message_of(strip + "\"*\": 1\n"), {"unknown key"});
  expect_all(message_of(strip + "clamps.*.at: start\n"), {"unknown key"});
}

TEST(BadInput, ChoicesNameWhatThereIs) {
  expect_all(message_of(strip + "solver: {method: newton}"),
             {"`newton` is not allowed", "must be one of implicit, two-stage, equilibrium"});
  expect_all(message_of(strip + "solver: {energy: wunderlick}"), {"did you mean `wunderlich`?", "truncated, sadowsky"});
}

TEST(BadInput, SeveralRibbons) {
  const std::string two = "ribbons:\n  - {length: 2, width: 0.5}\n  - {length: 2, width: 0.5}\n";
  EXPECT_EQ(message_of(two), "accepted");
  expect_all(message_of("ribbons: []"), {"bad.yaml:1:", "ribbons: has no entry"});
  expect_all(message_of(strip + two), {"bad.yaml:1:", "ribbon: contradicts `ribbons`"});
  expect_all(message_of(two + "clamps: [{at: start}]"),
             {"bad.yaml:4:", "clamps: of which strip?", "entry of `ribbons`"});
  expect_all(message_of(two + "solver: {method: equilibrium}"),
             {"bad.yaml:2:", "ribbons: several", "`solver.method: implicit`"});
  expect_all(message_of(two + "solver: {conserve: true}"), {"bad.yaml:4:", "solver.conserve: is for one strip alone"});
  expect_all(message_of("ribbons:\n  - {length: 2, width: 0.5}\n  - {width: 0.5}\n"),
             {"bad.yaml:3:", "ribbons.1.length: is missing"});
  expect_all(message_of("ribbons:\n  - {length: 2, width: x}\n"), {"bad.yaml:2:", "ribbons.0.width: `x`"});
  expect_all(message_of("ribbons:\n  - {length: 2, width: 0.5, colour: red}\n"),
             {"bad.yaml:2:", "ribbons.0.colour: unknown key"});
  expect_all(message_of("ribbons:\n  - {length: 2, width: 0.5, clamps: [{at: {u: 3}}]}\n"),
             {"bad.yaml:2:", "ribbons.0.clamps.0.at.u", "beyond the strip"});
  expect_all(
      message_of("ribbons:\n  - {length: 2, width: 0.5, clamps: [{at: start}], initial: {position: [0, 0, 1]}}\n"),
      {"bad.yaml:2:", "ribbons.0.initial.position", "no effect with `clamps`"});
}

TEST(BadInput, SelfContactOfLoadsWithoutAPotential) {
  const std::string torque = "clamps: [{at: start}]\nforces: [{at: end, torque: [1, 0, 0]}]\ncontact: {self: true}";
  expect_all(message_of(strip + torque), {"bad.yaml:3:", "forces.0", "have no potential", "`contact.self: true`"});
  expect_all(message_of(strip + torque + "\nsolver: {method: equilibrium}"), {"forces.0", "have no potential"});
  // A method that needs none takes them.
  EXPECT_EQ(message_of(strip + torque + "\nsolver: {method: two-stage}"), "accepted");
}

TEST(BadInput, FrictionOfTheStripOnItselfNeedsMotion) {
  expect_all(message_of(strip + "contact: {self: true, friction: 0.2}\nsolver: {method: equilibrium}"),
             {"bad.yaml:2:", "contact.friction", "use `implicit`"});
}

TEST(BadInput, Profiles) {
  const auto profile = [](const std::string& rows) {
    return message_of(strip + "initial:\n  shape: profile\n" + (rows.empty() ? "" : "  profile: [" + rows + "]\n"));
  };
  expect_all(profile(""), {"bad.yaml:3:", "initial.profile", "is missing"});
  expect_all(profile("{at: 0}"), {"bad.yaml:4:", "at least two places"});
  expect_all(profile("{at: 0}, {curvature: 1}"), {"bad.yaml:4:", "initial.profile.1.at"});
  expect_all(profile("{at: 0.5}, {at: 0.5}"), {"initial.profile.1.at", "larger than the one before"});
  expect_all(profile("{at: 0.5}, {at: 0.6, slope: 0.9}"), {"initial.profile.1", "rulings meet"});
  expect_all(profile("{at: 0, slope: 2.1}, {at: 1}"), {"initial.profile.0.slope", "square ends"});
  expect_all(message_of(strip + "initial: {profile: [{at: 0}, {at: 1}]}"), {"bad.yaml:2:", "without `shape: profile`"});
}

TEST(BadInput, WrongTypes) {
  expect_all(message_of("ribbon: {length: long, width: 1}"),
             {"bad.yaml:1:18: ribbon.length: `long` is not allowed", "must be a number from"});
  expect_all(message_of("ribbon: {length: \"1\", width: 1}"), {"without quotes"});
  expect_all(message_of("ribbon: {length: [1], width: 1}"), {"a list of 1 is not allowed"});
  expect_all(message_of("ribbon: {length: {}, width: 1}"), {"a map is not allowed"});
  expect_all(message_of("ribbon: {length: , width: 1}"), {"no value is not allowed"});
  expect_all(message_of("ribbon: {length: true, width: 1}"), {"`true` is not allowed"});
  expect_all(message_of("ribbon: [1, 2]"), {"ribbon: a list of 2 is not allowed; must be a map with length"});
  expect_all(message_of("ribbon: {length: 1, width: 1, segments: 5.5}"),
             {"ribbon.segments: `5.5`", "whole number from 2 to 1000000"});
  expect_all(message_of("ribbon: {length: 1, width: 1, free_rulings: 1}"), {"true or false"});
  expect_all(message_of(strip + "gravity: [0, -1]"), {"gravity: a list of 2", "three numbers"});
  expect_all(message_of(strip + "gravity: [0, x, 0]"), {"gravity.1: `x`"});
  expect_all(message_of(strip + "clamps: {at: start}"), {"clamps: a map is not allowed; must be a list"});
  expect_all(message_of(strip + "clamps: [start]"), {"clamps.0: `start` is not allowed; must be a map with at"});
  expect_all(message_of(strip + "clamps: [{at: start, free: x}]"), {"a list of some of x, y, z"});
  expect_all(message_of(strip + "clamps: [{at: start, free: [w]}]"), {"clamps.0.free.0: `w`"});
  expect_all(message_of(strip + "title: [a]"), {"one line of text"});
}

TEST(BadInput, NumbersOutOfRange) {
  expect_all(message_of("ribbon: {length: 1, width: -1}"),
             {"bad.yaml:1:28: ribbon.width: `-1` is not allowed; must be a number from 1e-06 to 1e+09 m"});
  expect_all(message_of("ribbon: {length: 1, width: 0}"), {"`0` is not allowed"});
  expect_all(message_of("ribbon: {length: 1, width: 1, segments: 0}"), {"`0` is not allowed", "from 2"});
  expect_all(message_of("ribbon: {length: 1, width: 1, segments: 99999999999999999999999}"), {"is not allowed"});
  expect_all(message_of("ribbon: {length: 1, width: 1, segments: 1000000}"), {"output.frames", "too much to keep"});
  for (const char* number : {".nan", "nan", ".inf", "-.inf", "1e308", "1e999", "1/0", "-0"}) {
    expect_all(message_of(std::string("ribbon: {length: ") + number + ", width: 1}"),
               {"ribbon.length", number, "is not allowed"});
  }
  expect_all(message_of("ribbon: {length: 1e-6, width: 1e9}"), {"gives ribbon.aspect = 1e-15"});
  expect_all(message_of("ribbon: {length: 1, width: 1, young_modulus: 1e15, thickness: 1e3, mass_density: 1}"),
             {"ribbon.young_modulus", "gives ribbon.bending_stiffness"});
  expect_all(message_of(strip + "output: {subdivision: 64, across: 256}\n", {"ribbon.segments=20000"}),
             {"too large a surface"});
}

TEST(BadInput, KeysThatContradictEachOther) {
  expect_all(message_of("ribbon: {length: 1, width: 1, aspect: 1}"), {"ribbon.aspect: contradicts `width`"});
  expect_all(message_of(strip, {"ribbon.width=1", "ribbon.aspect=1"}),
             {"--set ribbon.aspect=1: ribbon.aspect: contradicts"});
  expect_all(message_of("ribbon: {length: 1, width: 1, bending_stiffness: 1, young_modulus: 1, thickness: 1}"),
             {"contradicts `bending_stiffness`"});
  expect_all(message_of("ribbon: {length: 1, width: 1, young_modulus: 1}"), {"needs `thickness`"});
  expect_all(message_of("ribbon: {length: 1, width: 1, thickness: 1}"), {"no effect"});
  expect_all(message_of("ribbon: {length: 1, width: 1, half_twists: 1}"), {"only a loop"});
  expect_all(message_of("ribbon: {length: 1, width: 1, closure: loop, free_rulings: true}"), {"a loop has no ends"});
  expect_all(message_of("ribbon: {length: 1, width: 1, closure: loop, segments: 2}"), {"at least 3"});
  expect_all(message_of("ribbon: {length: 1, width: 1, segments: 3, spacing: [1, 2]}"),
             {"has 2 numbers", "one a segment, 3"});
  expect_all(message_of("ribbon: {length: 1, width: 1, segments: 2, spacing: [1e-3, 1e3]}"), {"times the shortest"});
  expect_all(message_of("ribbon: {length: 1, width: 1, segments: 2, spacing: [1, -1]}"), {"ribbon.spacing.1: `-1`"});
  expect_all(message_of(strip + "solver: {taylor_order: 3}"), {"no effect without `energy: truncated`"});
  expect_all(message_of("ribbon: {width: 1}"), {"ribbon.length: is missing"});
  expect_all(message_of("ribbon: {length: 1}"), {"ribbon.width: is missing"});
  expect_all(message_of("title: x"), {"ribbon.length: is missing"});
}

TEST(BadInput, SupportsThatContradictEachOther) {
  expect_all(message_of(strip + "clamps:\n  - at: start\n  - at: start\n"),
             {"bad.yaml:4:5: clamps.1: contradicts clamps.0 (bad.yaml:3:5)", "node 0"});
  expect_all(message_of(strip + "clamps: [{at: start}, {at: {node: 0}}]"), {"contradicts"});
  expect_all(message_of(strip + "clamps: [{at: start}, {at: {segment: 0}}]"), {"contradicts"});
  expect_all(message_of(strip + "clamps: [{at: {segment: 1}}, {at: {segment: 2}}]"), {"both hold node 2"});
  expect_all(message_of(strip + "clamps: [{at: end}]\npins: [{at: {node: 4}}]"), {"pins.0: contradicts clamps.0"});
  expect_all(message_of(strip + "pins: [{at: {u: 0.4}}, {at: {node: 1}}]"), {"pins.1: contradicts pins.0"});
  expect_all(message_of(strip + "pins: [{at: start, free: [x, y, z]}]"), {"holds nothing"});
  expect_all(message_of(strip + "clamps: [{at: start, free: [x, x]}]"), {"`x` is given twice"});
  expect_all(message_of(strip + "gravity: [0, 0, -1]\nsolver: {method: equilibrium}"), {"nothing holds the strip"});
  expect_all(message_of(strip + "forces: [{at: end}]"), {"neither a force nor a torque"});
}

TEST(BadInput, SupportsTooFarApartAtAnyTime) {
  const std::string ends = strip + "clamps:\n  - at: start\n  - at: end\n    ";
  expect_all(message_of(ends + "position: [2.1, 0, 0]"),
             {"bad.yaml:4:5: clamps.1: is 2.1 m away from clamps.0", "2 m long"});
  expect_all(message_of(ends + "keyframes: [{time: 0, position: [1, 0, 0]}, {time: 1, position: [0, 3, 0]}, {time: 2, "
                               "position: [0, 0, 0]}]"),
             {"at time 1", "3 m away"});
  EXPECT_EQ(message_of(ends + "position: [0, 2, 0]"), "accepted");
  EXPECT_EQ(message_of(ends + "position: [2.1, 0, 0]\n    free: [x]"), "accepted");
  expect_all(message_of(strip + "pins: [{at: start}, {at: {node: 2}, free: [x]}, {at: end, position: [3, 0, 0]}]"),
             {"pins.2: is 3 m away from pins.0"});
  expect_all(message_of("ribbon: {length: 4, width: 1, segments: 4, closure: loop}\npins: [{at: {node: 0}}, {at: "
                        "{node: 3}, position: [2, 0, 0]}]"),
             {"pins.1: is 2 m away", "1 m long"});
}

TEST(BadInput, PlacesThatAreNotOnTheStrip) {
  const std::string loop = "ribbon: {length: 2, width: 0.5, segments: 4, closure: loop}\n";
  expect_all(message_of(loop + "clamps: [{at: start}]"), {"clamps.0.at: a loop has no ends"});
  expect_all(message_of(loop + "pins: [{at: end}]"), {"a loop has no ends"});
  expect_all(message_of(loop + "pins: [{at: {node: 4}}]"), {"from 0 to 3"});
  expect_all(message_of(strip + "pins: [{at: {node: 5}}]"), {"pins.0.at.node: 5 is not on the strip", "0 to 4"});
  expect_all(message_of(strip + "pins: [{at: {segment: 1}}]"), {"pins.0.at.segment: unknown key", "node, u"});
  expect_all(message_of(strip + "clamps: [{at: {segment: 4}}]"), {"0 to 3"});
  expect_all(message_of(strip + "clamps: [{at: {node: 2}}]"), {"a clamp inside it holds a segment"});
  expect_all(message_of(strip + "clamps: [{at: {u: 2.5}}]"), {"2.5 is beyond the strip", "0 to 2 m"});
  expect_all(message_of(strip + "clamps: [{at: {}}]"), {"exactly one of node, segment, u"});
  expect_all(message_of(strip + "clamps: [{at: {node: 0, u: 0}}]"), {"exactly one"});
  expect_all(message_of(strip + "clamps: [{at: strat}]"), {"did you mean `start`?"});
  expect_all(message_of(strip + "clamps: [{turn: 1}]"), {"clamps.0.at: is missing"});
}

TEST(BadInput, FramesAndKeyframes) {
  const std::string clamp = strip + "clamps:\n  - at: start\n    ";
  expect_all(message_of(clamp + "tangent: [0, 0, 0]"), {"bad.yaml:4:14: clamps.0.tangent: is (nearly) zero"});
  expect_all(message_of(clamp + "tangent: [0, 0, 1]"), {"must be perpendicular", "0.0000 degrees"});
  expect_all(message_of(clamp + "normal: [1, 0, 1]"), {"45.0000 degrees"});
  expect_all(message_of(clamp + "keyframes: [{time: 1}, {time: 1}]"),
             {"clamps.0.keyframes.1.time: 1 does not come after", "increase"});
  expect_all(message_of(clamp + "keyframes: [{time: -1}]"), {"`-1` is not allowed"});
  expect_all(message_of(clamp + "keyframes: [{turn: 1}]"), {"clamps.0.keyframes.0.time: is missing"});
  expect_all(message_of(clamp + "keyframes: [{time: 0}, {time: 1, normal: [0, 0, -1]}]"),
             {"half a turn", "use `turn`"});
  expect_all(message_of(strip + "forces: [{at: end, force: [1, 0, 0], keyframes: [{time: 2}, {time: 1}]}]"),
             {"forces.0.keyframes.1.time"});
}

TEST(BadInput, OverridesAreNamedInTheMessage) {
  EXPECT_EQ(message_of(strip, {"ribbon.width=-1"}),
            "--set ribbon.width=-1: ribbon.width: `-1` is not allowed; must be a number from 1e-06 to 1e+09 m");
  expect_all(message_of(strip, {"ribbon.widht=1"}),
             {"--set ribbon.widht=1: ribbon.widht: unknown key; did you mean `width`?"});
  expect_all(message_of(strip, {"clamps.0.at=strat"}), {"--set clamps.0.at=strat: clamps.0.at"});
  expect_all(message_of(strip, {"gravity=[0, 0, .nan]"}), {"--set gravity=[0, 0, .nan]: gravity.2"});
}

TEST(BadInput, FilesThatAreNoScenes) {
  expect_all(message_of(""), {"bad.yaml", "a scene must be a map", "this is empty"});
  expect_all(message_of("# nothing\n"), {"this is empty"});
  expect_all(message_of("", {"ribbon.length=1"}), {"this is empty"});
  expect_all(message_of("just text"), {"bad.yaml:1:1: a scene must be a map"});
  expect_all(message_of("[1, 2]"), {"a scene must be a map"});
  expect_all(message_of("ribbon: {length: 1"), {"bad.yaml:1:", "not valid YAML"});
  expect_all(message_of(std::string("\xff\xfe"
                                    "r\0i\0",
                                    6)),
             {"bad.yaml:1:1: byte 0xff is not UTF-8"});
  expect_all(message_of(std::string(2000000, '[')), {"bad.yaml:1:1: ", "not closed"});
  expect_all(message_of("ribbon: {length: 1, width: 1, " + std::string(1000000, 'x') + ": 1}"),
             {"bad.yaml:1:31: ", "one word"});
}

std::string path_message(const std::string& path) {
  try {
    read_scene(path);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(BadInput, PathsThatAreNoScenes) {
  const auto folder = std::filesystem::path(testing::TempDir()) / "wunderlich-bad-paths";
  std::filesystem::create_directories(folder);
  expect_all(path_message(folder.string()), {folder.string(), "is a folder"});
  expect_all(path_message((folder / "missing.yaml").string()), {"no such file", "shipped are"});
  expect_all(path_message("mobius"), {"did you mean `moebius`?"});
  expect_all(path_message("/dev/zero"), {"not a regular file"});
  expect_all(path_message(""), {"no such file"});
  expect_all(path_message(std::string(10000, 'a')), {"no such file"});
  std::ofstream(folder / "huge.yaml") << std::string((4 << 20) + 1, '#');
  expect_all(path_message((folder / "huge.yaml").string()), {"larger than 4 MiB"});
  std::ofstream(folder / "wide.yaml") << "ribbon: {length: 1, width: -2}\n";
  expect_all(path_message((folder / "wide.yaml").string()),
             {(folder / "wide.yaml").string() + ":1:28: ribbon.width: `-2`"});
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace wunderlich::scene
