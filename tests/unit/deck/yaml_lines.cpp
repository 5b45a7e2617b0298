#include "deck/yaml_lines.hpp"

#include <gtest/gtest.h>

#include "options.hpp"

namespace tanktread::deck {
namespace {

TEST(Comments, AreLeftOutAndLinesKeepTheirNumbers) {
  const auto lines =
      clean_lines("# Deck: \xce\xb3\xcc\x87t\nTanktread:   # root\r\n  a: \"x # y\" # z\n\n  b: it's#one\n  c: 'it''s # in'\n", "deck");
  ASSERT_EQ(lines.size(), 6u);
  EXPECT_EQ(lines[0], "");
  EXPECT_EQ(lines[1], "Tanktread:");
  EXPECT_EQ(lines[2], "  a: \"x ~23 y\"");
  EXPECT_EQ(lines[4], "  b: it's#one");
  EXPECT_EQ(lines[5], "  c: 'it''s ~23 in'");
}

TEST(Texts, KeepEveryCharacter) {
  for (const std::string text : {"caf\xc3\xa9", "# 3", "~", "~23", "a ~ b # c", "'", "[", "{a: b}", "x,y"})
    EXPECT_EQ(kinds("    note: \"" + text + "\"   # comment\n").note, text);
  EXPECT_EQ(kinds("    note: caf\xc3\xa9 ~7\n").note, "caf\xc3\xa9 ~7");
  EXPECT_EQ(kinds("    note: 'it''s'\n").note, "it's");
}

TEST(Lines, ThatTheReaderWouldDropAreRefused) {
  EXPECT_EQ(refusal("    count: 1\n   law: soft\n"), "deck.yaml, line 4: the indentation fits none of the lines above.");
  EXPECT_EQ(refusal("\tcount: 1\n"), "deck.yaml, line 3: indent with spaces, not with tabs.");
}

TEST(DuplicateKeys, AreRefusedWithBothLines) {
  EXPECT_EQ(refusal("    count: 1\n    law: soft\n    count: 2\n"),
            "deck.yaml, line 5: Kinds/count is given a second time; it already stands in line 3.");
  EXPECT_EQ(refusal_of("Tanktread:\n  Kinds:\n    count: 1\n  Kinds:\n    law: soft\n"),
            "deck.yaml, line 4: Kinds is given a second time; it already stands in line 2.");
  EXPECT_EQ(refusal("    \"count\": 1\n    count: 2\n"),
            "deck.yaml, line 4: Kinds/count is given a second time; it already stands in line 3.");
  EXPECT_EQ(refusal("    Inner: {depth: 0.1, depth: 0.2}\n"), "deck.yaml: depth is given twice.");
  EXPECT_EQ(refusal("    Inner:\n      depth: 0.1\n    Belos:\n      depth: 0.1\n"), "") << "the same name in two lists";
}

TEST(BrokenYaml, IsShownWithItsLine) {
  EXPECT_EQ(refusal("    center: [1, 2\n    count: 1\n"), "deck.yaml, line 3: this is not YAML that can be read: `center: [1, 2`.");
  EXPECT_EQ(refusal("    law: soft: hard\n"), "deck.yaml, line 3: this is not YAML that can be read: `law: soft: hard`.");
}

TEST(RootLists, AreNamedAndAlone) {
  EXPECT_EQ(refusal_of("Tanktraed:\n  Kinds: {}\n"),
            "deck.yaml: the outermost list must be `Tanktread`, and the only one, but there is `Tanktraed`.");
  EXPECT_EQ(refusal_of("Tanktread:\n  Kinds: {}\nOther:\n  a: 1\n"),
            "deck.yaml: the outermost list must be `Tanktread`, and the only one, but there is `Other`.");
  EXPECT_EQ(refusal_of("Kinds: {count: 1}\n"),
            "deck.yaml: the outermost list must be `Tanktread`, and the only one, but there is `Kinds`.");
  EXPECT_NE(refusal_of("Tanktread: 3\n"), "");
  EXPECT_EQ(refusal_of("%YAML 1.1\n---\nTanktread:\n  Kinds: {count: 1}\n...\n"), "");
}

}  // namespace
}  // namespace tanktread::deck
