#include "deck/section.hpp"

#include <gtest/gtest.h>

#include "options.hpp"

namespace tanktread::deck {
namespace {

TEST(Keys, ThatAreNotGivenKeepTheirDefaults) {
  const Kinds k = kinds("    count: 4\n");
  EXPECT_EQ(k.rate, 1.0);
  EXPECT_FALSE(k.modulus.has_value());
  EXPECT_EQ(k.count, 4);
  EXPECT_EQ(k.law, "soft");
  EXPECT_TRUE(k.gradient.isIdentity(0));
}

TEST(Keys, OfEveryTypeAreRead) {
  const Kinds k = kinds(
      "    shear rate: 2.5\n    modulus: 1e-3\n    count: 7\n    limit: 0\n    enabled: true\n    law: very hard\n    note: \"a: b # c\"\n"
      "    center: [1, 2, 3]\n    axes: [1., 2, 3.5]\n    sides: [2, 0.5]\n    gradient: [1, 2, 3, 4, 5, 6, 7, 8, 9]\n    stress: [[1., "
      "2., 3.], [4., 5., 6.], "
      "[7., 8., 9.]]\n"
      "    heights: [0, 2.5]\n    Inner: {depth: 0.25}\n");
  EXPECT_EQ(k.rate, 2.5);
  EXPECT_EQ(k.modulus, 1e-3);
  EXPECT_EQ(k.count, 7);
  EXPECT_EQ(k.limit, 0);
  EXPECT_TRUE(k.enabled);
  EXPECT_EQ(k.law, "very hard");
  EXPECT_EQ(k.note, "a: b # c");
  EXPECT_EQ(k.center, Vec3(1, 2, 3));
  EXPECT_EQ(k.axes.value(), Vec3(1, 2, 3.5));
  EXPECT_EQ(k.sides.value(), Eigen::Vector2d(2, 0.5));
  EXPECT_EQ(k.gradient(0, 2), 3.0) << "row by row";
  EXPECT_EQ(k.stress.value(), k.gradient) << "a table is a row of rows";
  EXPECT_EQ(k.heights.value(), (std::vector<double>{0, 2.5}));
  EXPECT_EQ(k.inner.depth, 0.25);
}

TEST(Keys, AcceptAWholeNumberAsANumberButNotText) {
  EXPECT_EQ(kinds("    shear rate: 2\n").rate, 2.0);
  EXPECT_EQ(refusal("    shear rate: \"2\"\n"), "Kinds/shear rate must be a number, positive (unit: 1/time), but is \"2\" (text).");
  EXPECT_EQ(kinds("    count: 4.0\n").count, 4);
  EXPECT_EQ(refusal("    count: 4.5\n"), "Kinds/count must be a whole number, between 1 and 9, but is 4.5.");
}

TEST(Keys, RejectAValueOutsideTheirRangeWithPathRangeUnitAndValue) {
  EXPECT_EQ(refusal("    shear rate: -1\n"), "Kinds/shear rate must be a number, positive (unit: 1/time), but is -1.");
  EXPECT_EQ(refusal("    count: 10\n"), "Kinds/count must be a whole number, between 1 and 9, but is 10.");
  EXPECT_EQ(refusal("    Inner:\n      depth: 2.5\n"), "Kinds/Inner/depth must be a number, between 0 and 1 (unit: length), but is 2.5.");
  EXPECT_EQ(refusal("    axes: [1, 0, 1]\n"),
            "Kinds/axes must be three numbers in brackets, each positive (unit: length), but is [1, 0, 1].");
  EXPECT_EQ(refusal("    heights: [1, -1]\n"),
            "Kinds/heights must be one number or more in brackets, each not negative (unit: length), but is [1, -1].");
  EXPECT_EQ(refusal("    sides: [1, 2, 3]\n"),
            "Kinds/sides must be two numbers in brackets, each positive (unit: length), but is [1, 2, 3]; if commas are meant as "
            "decimal points, write points: [0.5, 1.0, 1.5].");
}

TEST(Keys, RejectWrongTypes) {
  EXPECT_EQ(refusal("    enabled: 1\n"), "Kinds/enabled must be true or false, but is 1.");
  EXPECT_EQ(refusal("    note: 1\n"), "Kinds/note must be text (in quotes), but is 1.");
  EXPECT_EQ(refusal("    center: 1\n"), "Kinds/center must be three numbers in brackets (unit: length), but is 1.");
  EXPECT_EQ(refusal("    center: [1, 2]\n"), "Kinds/center must be three numbers in brackets (unit: length), but is [1, 2].");
  EXPECT_EQ(refusal("    gradient: [1, 2]\n"), "Kinds/gradient must be nine numbers in brackets (unit: 1/time), but is [1, 2].");
  EXPECT_EQ(refusal("    shear rate: {a: 1}\n"), "Kinds/shear rate must be a number, positive (unit: 1/time), but is a section of keys.");
  EXPECT_EQ(refusal("    Inner: 3\n"), "Kinds/Inner must be a section of keys, but is 3.");
  EXPECT_EQ(refusal("    count: 99999999999\n"), "Kinds/count must be a whole number, between 1 and 9, but is 99999999999.");
  EXPECT_NE(refusal("    shear rate: 1e999\n"), "") << "no infinity";
  EXPECT_NE(refusal("    shear rate: nan\n"), "");
}

TEST(Numbers, HaveAtMostOneSign) {
  EXPECT_EQ(kinds("    shear rate: +5\n").rate, 5.0);
  EXPECT_EQ(kinds("    center: [+1, -2, +.5]\n").center, Vec3(1, -2, 0.5));
  for (const std::string text : {"+-5", "++5", "-+5", "--5", "+", "+-5.0"}) {
    EXPECT_EQ(refusal("    limit: " + text + "\n"), "Kinds/limit must be a whole number, at least 0, but is \"" + text + "\" (text).");
    EXPECT_EQ(refusal("    shear rate: " + text + "\n"),
              "Kinds/shear rate must be a number, positive (unit: 1/time), but is \"" + text + "\" (text).");
    EXPECT_EQ(kinds("    note: " + text + "\n").note, text);
  }
}

TEST(Choices, RejectAnotherWordWithASuggestion) {
  EXPECT_EQ(refusal("    law: sotf\n"), "Kinds/law must be soft, hard or very hard, but is \"sotf\" (text); was `soft` meant?");
  EXPECT_EQ(refusal("    law: SOFT\n"), "Kinds/law must be soft, hard or very hard, but is \"SOFT\" (text); was `soft` meant?");
  EXPECT_EQ(refusal("    law: glass\n"), "Kinds/law must be soft, hard or very hard, but is \"glass\" (text).");
  EXPECT_EQ(refusal("    law: 2\n"), "Kinds/law must be soft, hard or very hard, but is 2.");
}

TEST(KeysWithoutEffect, AreListedIfTheDeckChangesThem) {
  struct Scheme {
    std::string scheme = "implicit";
    double tolerance = 1e-3;
    std::vector<std::string> idle;
    void declare(Section& root) {
      Inner inner{*this};
      root.section("Time", inner, "time steps");
      idle = root.idle_keys();
    }
    struct Inner {
      Scheme& of;
      void declare(Section& section) {
        section.key("scheme", of.scheme, Choice{"implicit", "explicit"}, "scheme");
        section.key("tolerance", of.tolerance, positive(), "1", "tolerance");
        if (of.scheme == "explicit") section.without_effect({"tolerance"}, "with Time/scheme `explicit`");
      }
    };
  };
  const auto idle = [](const std::string& keys) {
    Scheme scheme;
    read_text("Tanktread: {Time: {" + keys + "}}").declare(scheme);
    return scheme.idle;
  };
  EXPECT_TRUE(idle("scheme: implicit, tolerance: 1e-2").empty());
  EXPECT_TRUE(idle("scheme: explicit, tolerance: 1e-3").empty()) << "the default, as in a printed deck";
  EXPECT_EQ(idle("scheme: explicit, tolerance: 1e-2"),
            std::vector<std::string>{"Time/tolerance has no effect with Time/scheme `explicit`: remove the key."});
}

TEST(UnknownKeys, AreRejectedWithTheirPathAndASuggestion) {
  EXPECT_EQ(refusal("    shaer rate: 1\n"), "Kinds/shaer rate is not a key of the deck; was Kinds/shear rate meant?");
  EXPECT_EQ(refusal("    Inner: {detph: 1}\n"), "Kinds/Inner/detph is not a key of the deck; was Kinds/Inner/depth meant?");
  EXPECT_EQ(refusal("    depth: 1\n"), "Kinds/depth is not a key of the deck; was Kinds/Inner/depth meant?") << "the key of another list";
  EXPECT_EQ(refusal_of("Tanktread:\n  Kind: {count: 1}\n"), "Kind is not a key of the deck; was Kinds meant?");
  EXPECT_EQ(refusal_of("Tanktread:\n  Zebra: 1\n"), "Zebra is not a key of the deck; its sections are Kinds or Expect.");
  EXPECT_EQ(refusal("    Inner: {zebra: 1}\n"), "Kinds/Inner/zebra is not a key of the deck; Kinds/Inner has depth.");
}

TEST(GivenKeys, AreDistinguishedFromDefaults) {
  struct Probe {
    bool given = false, other = true;
    std::string path;
    double a = 1;
    void declare(Section& s) {
      given = s.given("a");
      other = s.given("b");
      path = s.path("a");
      s.key("a", a, any(), "1", "one");
    }
  };
  struct Root {
    Probe probe;
    void declare(Section& s) { s.section("Probe", probe, "a probe"); }
  } root;
  Document document = read_text("Tanktread:\n  Probe:\n    a: 1\n");
  document.declare(root);
  EXPECT_TRUE(root.probe.given);
  EXPECT_FALSE(root.probe.other);
  EXPECT_EQ(root.probe.path, "Probe/a");
}

}  // namespace
}  // namespace tanktread::deck
