#include "wunderlich/scene/document.hpp"

#include <gtest/gtest.h>

#include "wunderlich/base/error.hpp"

namespace wunderlich::scene {
namespace {

std::string refusal(const std::string& text) {
  try {
    parse_document(text, "f");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(ParseDocument, KeepsPlacesAndQuotes) {
  const Value root = parse_document("a: 1\nb:\n  - \"2\"\n  - {c: x}\n", "f");
  ASSERT_EQ(root.names.size(), 2u);
  EXPECT_EQ(described(root.find("a")->place), "f:1:4");
  const Value& list = *root.find("b");
  EXPECT_EQ(list.items[0].text, "2");
  EXPECT_TRUE(list.items[0].quoted);
  EXPECT_FALSE(list.items[1].find("c")->quoted);
  EXPECT_EQ(described(list.items[1].find("c")->place), "f:4:9");
  EXPECT_EQ(root.find("d"), nullptr);
}

TEST(ParseDocument, RefusesWhatScenesDoNotUse) {
  EXPECT_EQ(refusal("a: 1\nb: 2\na: 3\n").rfind("f:3:1: a: this key is given twice", 0), 0u);
  EXPECT_NE(refusal("a: &x [1]\nb: *x\n").find("f:1:4: anchors"), std::string::npos) << refusal("a: &x [1]\nb: *x\n");
  EXPECT_NE(refusal("a: !int 3\n").find("tag"), std::string::npos);
  EXPECT_NE(refusal("a: 1\n---\nb: 2\n").find("not several"), std::string::npos);
  EXPECT_NE(refusal("{a: [1, 2}").find("f:1:10: not valid YAML"), std::string::npos) << refusal("{a: [1, 2}");
  EXPECT_NE(refusal("? [a, b]\n: 1\n").find("a key must be one word"), std::string::npos);
  EXPECT_NE(refusal("a: \xff\n").find("f:1:4: byte 0xff is not UTF-8"), std::string::npos);
}

TEST(ParseDocument, SurvivesDeepNestingAndAliasBombs) {
  EXPECT_NE(refusal(std::string(100000, '[')).find("not closed"), std::string::npos);
  std::string lines;
  for (int i = 0; i < 100000; ++i) lines += "[\n";
  EXPECT_NE(refusal(lines).find("f:"), std::string::npos);
  EXPECT_NE(refusal(std::string(30, '[') + std::string(30, ']')).find("nested deeper"), std::string::npos);
  std::string block;
  for (int i = 0; i < 3000; ++i) block += std::string(static_cast<std::size_t>(i), ' ') + "a:\n";
  EXPECT_NE(refusal(block).find("nested deeper"), std::string::npos);
  std::string bomb = "a0: &a0 [x, x]\n";
  for (int i = 1; i < 40; ++i) {
    const std::string before = std::to_string(i - 1);
    bomb.append("a").append(std::to_string(i)).append(": &a").append(std::to_string(i));
    bomb.append(" [*a").append(before).append(", *a").append(before).append("]\n");
  }
  EXPECT_NE(refusal(bomb).find("anchors"), std::string::npos);
}

TEST(ApplyOverride, ReplacesCreatesAndAppends) {
  Value root = parse_document("ribbon: {width: 1}\nclamps:\n  - at: start\n", "f");
  apply_override(root, "ribbon.width=2");
  apply_override(root, "ribbon.title=a: b" + std::string());
  apply_override(root, "solver.method=equilibrium");
  apply_override(root, "gravity=[0, 0, -9.81]");
  apply_override(root, "clamps.0.turn=pi");
  apply_override(root, "clamps.1.at=end");
  EXPECT_EQ(root.find("ribbon")->find("width")->text, "2");
  EXPECT_EQ(root.find("ribbon")->find("title")->find("a")->text, "b");
  EXPECT_EQ(root.find("solver")->find("method")->text, "equilibrium");
  EXPECT_EQ(root.find("gravity")->items[2].text, "-9.81");
  EXPECT_EQ(root.find("clamps")->items[0].find("turn")->text, "pi");
  EXPECT_EQ(root.find("clamps")->items[1].find("at")->text, "end");
}

TEST(ApplyOverride, TheLastOfTwoWins) {
  Value root = parse_document("a: 1\n", "f");
  apply_override(root, "a=2");
  apply_override(root, "a=3");
  EXPECT_EQ(root.find("a")->text, "3");
  EXPECT_EQ(root.names.size(), 1u);
}

TEST(ApplyOverride, SaysWhatIsWrong) {
  const auto refused = [](const std::string& assignment) -> std::string {
    Value root = parse_document("a: 1\nl: [1, 2]\n", "f");
    try {
      apply_override(root, assignment);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(refused("a").rfind("--set a: must be key=value", 0), 0u) << refused("a");
  EXPECT_NE(refused("=1").find("must be key=value"), std::string::npos);
  EXPECT_NE(refused("a..b=1").find("empty part"), std::string::npos);
  EXPECT_NE(refused("a=").find("has no value"), std::string::npos);
  EXPECT_NE(refused("a.b=1").find("neither a map nor a list"), std::string::npos);
  EXPECT_NE(refused("l.3=1").find("allowed: 0 to 2"), std::string::npos);
  EXPECT_NE(refused("l.x=1").find("no element"), std::string::npos);
  EXPECT_NE(refused("a=[1").find("--set a=[1: "), std::string::npos) << refused("a=[1");
  EXPECT_NE(refused("a.b.c.d.e.f.g.h.i.j.k.l.m.n.o.p.q.r.s.t.u.v=1").find("too many parts"), std::string::npos);
}

TEST(ApplyOverride, NullTakesAKeyOrAnElementAway) {
  const std::string text = "m: {a: 1, b: {c: 2, d: 3}}\nl: [4, 5, 6]\n";
  const auto without = [&](const std::string& assignment) {
    Value root = parse_document(text, "f");
    apply_override(root, assignment);
    return to_yaml(root);
  };
  const auto yaml = [](const std::string& tree) { return to_yaml(parse_document(tree, "g")); };
  EXPECT_EQ(without("m.b.c=null"), yaml("m: {a: 1, b: {d: 3}}\nl: [4, 5, 6]\n"));
  EXPECT_EQ(without("m.b=~"), yaml("m: {a: 1}\nl: [4, 5, 6]\n"));
  EXPECT_EQ(without("l.1=null"), yaml("m: {a: 1, b: {c: 2, d: 3}}\nl: [4, 6]\n"));
  for (const std::string absent : {"m.x=null", "l.3=null", "l.x=null", "m.a.b=null", "n=null"}) {
    EXPECT_THROW(without(absent), InputError) << absent;
  }
}

TEST(ToYaml, ReadsBackToTheSameTree) {
  const std::string text =
      "t: \"a, b: c # d\"\np: plain, with comma\nn: [1e-3, 2pi, \"2pi\"]\nm: {k: [{a: x}, {}], l: []}\n";
  const std::string once = to_yaml(parse_document(text, "f"));
  const Value again = parse_document(once, "g");
  EXPECT_EQ(to_yaml(again), once);
  EXPECT_EQ(again.find("t")->text, "a, b: c # d");
  EXPECT_EQ(again.find("p")->text, "plain, with comma");
  EXPECT_FALSE(again.find("n")->items[1].quoted);
  EXPECT_TRUE(again.find("n")->items[2].quoted);
  EXPECT_EQ(again.find("m")->find("k")->items[0].find("a")->text, "x");
}

}  // namespace
}  // namespace wunderlich::scene
