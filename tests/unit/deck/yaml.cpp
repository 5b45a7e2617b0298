#include "deck/source.hpp"

#include <gtest/gtest.h>

#include "options.hpp"

namespace tanktread::deck {
namespace {

TEST(Texts, KeepEveryCharacter) {
  for (const std::string text : {"caf\xc3\xa9", "# 3", "~", "~23", "a ~ b # c", "'", "[", "{a: b}", "x,y"})
    EXPECT_EQ(kinds("    note: \"" + text + "\"   # comment\n").note, text);
  EXPECT_EQ(kinds("    note: caf\xc3\xa9 ~7\n").note, "caf\xc3\xa9 ~7");
  EXPECT_EQ(kinds("    note: 'it''s # in'\n").note, "it's # in");
  EXPECT_EQ(kinds("    note: it's#one # comment\r\n").note, "it's#one");
  EXPECT_EQ(kinds("    note: >\n      folded\n      lines\n").note, "folded lines\n");
}

TEST(Texts, InDoubleQuotesKeepTheirEscapes) {
  EXPECT_EQ(kinds("    note: \"a\\tb\\\\c\\\"d\\x41\\u00e9\\n\"\n").note, "a\tb\\c\"dA\xc3\xa9\n");
  for (const std::string text : {"line\nline", "\ttab\\", "\x7f"}) {
    Sample first, second;
    first.kinds.note = text;
    Document written = read_text("Tanktread: {}\n");
    written.declare(first);
    Document read = read_text(written.effective());
    read.declare(second);
    EXPECT_EQ(second.kinds.note, text);
  }
}

TEST(Lines, ThatAreIndentedWronglyAreRejected) {
  EXPECT_EQ(refusal("    count: 1\n   law: soft\n"),
            "deck.yaml, line 4: this is not valid YAML (the indentation fits none of the lines above): `law: soft`.");
  EXPECT_EQ(refusal("\tcount: 1\n"), "deck.yaml, line 3: indent with spaces, not with tabs.");
}

TEST(Lists, HaveALimitedDepthAndSize) {
  std::string deep = "Tanktread: ", laughs = "Tanktread:\n  Kinds:\n    a: &a0 {x: 1}\n";
  for (int i = 0; i < 30; ++i) deep += "{a: ";
  EXPECT_EQ(refusal_of(deep + "1" + std::string(30, '}')),
            "deck.yaml, line 1: sections and sequences are nested more than 20 deep, or hold more than 100,000 values.");
  for (const char* open : {"{a: ", "[", "- "}) {
    std::string text = "Tanktread:\n  ";
    for (int i = 0; i < 20000; ++i) text += open;
    EXPECT_EQ(refusal_of(text), "deck.yaml: sections are nested more than 20 deep.") << open;
  }
  for (int i = 1; i < 10; ++i) {
    laughs += "    a" + std::to_string(i) + ": &a" + std::to_string(i) + " {";
    for (int k = 0; k < 10; ++k) laughs += "k" + std::to_string(k) + ": *a" + std::to_string(i - 1) + ", ";
    laughs += "}\n";
  }
  EXPECT_NE(refusal_of(laughs).find("hold more than 100,000 values"), std::string::npos);
  EXPECT_NE(refusal_of("Tanktread: &a {Kinds: *a}\n").find("nested more than"), std::string::npos);
  EXPECT_EQ(refusal("    " + std::string(1000, 'x') + ": 1\n"),
            "deck.yaml, line 3: a key is a word of at most 100 characters, followed by a colon.");
}

TEST(Sequences, HoldNumbersOrWords) {
  EXPECT_EQ(kinds("    center:\n      - 1\n      - 2.5\n      - 3\n").center, Vec3(1, 2.5, 3));
  EXPECT_EQ(refusal("    center: [[1, 2], [3]]\n"),
            "deck.yaml, line 3: Kinds/center is a sequence (brackets, or lines with dashes), but a deck has sequences of numbers or words "
            "only.");
  EXPECT_EQ(refusal_of("Tanktread:\n  Kinds:\n    - law: soft\n    - law: hard\n"),
            "deck.yaml, line 3: Kinds is a sequence (brackets, or lines with dashes), but a deck has sequences of numbers or words only: "
            "sections with keys have names, such as Particles/<name>.");
}

TEST(Keys, WithoutAValueAreNull) {
  EXPECT_EQ(refusal("    law:\n"), "Kinds/law must be soft, hard or very hard, but is nothing.");
  EXPECT_EQ(refusal("    count: ~\n"), "Kinds/count must be a whole number, between 1 and 9, but is nothing.");
  EXPECT_EQ(kinds("    Inner:\n      # depth: 1\n").inner.depth, 0.5) << "a list whose keys are all commented out";
}

TEST(DuplicateKeys, AreRejectedWithBothLines) {
  EXPECT_EQ(refusal("    count: 1\n    law: soft\n    count: 2\n"),
            "deck.yaml, line 5: Kinds/count is set twice; it was first set in line 3.");
  EXPECT_EQ(refusal_of("Tanktread:\n  Kinds:\n    count: 1\n  Kinds:\n    law: soft\n"),
            "deck.yaml, line 4: Kinds is set twice; it was first set in line 2.");
  EXPECT_EQ(refusal("    \"count\": 1\n    count: 2\n"),
            "deck.yaml, line 4: Kinds/count is set twice; it was first set in line 3.");
  EXPECT_EQ(refusal("    Inner: {depth: 0.1, depth: 0.2}\n"),
            "deck.yaml, line 3: Kinds/Inner/depth is set twice; it was first set in line 3.");
  EXPECT_EQ(refusal("    Inner:\n      depth: 0.1\n    Belos:\n      depth: 0.1\n"), "") << "the same name in two lists";
}

TEST(BrokenYaml, IsReportedWithItsLine) {
  EXPECT_EQ(refusal("    center: [1, 2\n    count: 1\n"),
            "deck.yaml, line 4: this is not valid YAML (end of sequence flow not found): `count: 1`.");
  EXPECT_EQ(refusal("    law: soft: hard\n"),
            "deck.yaml, line 3: this is not valid YAML (illegal map value): `law: soft: hard`.");
}

TEST(RootLists, AreUniqueAndNamedTanktread) {
  EXPECT_EQ(refusal_of("Tanktraed:\n  Kinds: {}\n"),
            "deck.yaml: the outermost section must be `Tanktread`, and the only one, but there is `Tanktraed`.");
  EXPECT_EQ(refusal_of("Tanktread:\n  Kinds: {}\nOther:\n  a: 1\n"),
            "deck.yaml: the outermost section must be `Tanktread`, and the only one, but there is `Other`.");
  EXPECT_EQ(refusal_of("Kinds: {count: 1}\n"),
            "deck.yaml: the outermost section must be `Tanktread`, and the only one, but there is `Kinds`.");
  EXPECT_EQ(refusal_of("Tanktread: [1, 2]\n"), "deck.yaml: `Tanktread` must be a section with keys.");
  EXPECT_EQ(refusal_of("Tanktread: 3\n"), "deck.yaml: `Tanktread` must be a section with keys.");
  EXPECT_EQ(refusal_of("Tanktread: {}\n---\nTanktread: {}\n"), "deck.yaml, line 2: a second document begins here, but a deck is a single YAML "
            "document.");
  EXPECT_EQ(refusal_of("%YAML 1.1\n---\nTanktread:\n  Kinds: {count: 1}\n...\n"), "");
}

}  // namespace
}  // namespace tanktread::deck
